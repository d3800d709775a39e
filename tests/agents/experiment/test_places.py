"""The command line where something usual is missing: letters, a home directory."""

import os
import re
import sys
from pathlib import Path

import platformdirs
import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.files import check_folder
from arkanoid.envs.play.gallery import list_levels
from helpers.processes import run_arkanoid


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "cp437", "utf-8"])
def test_letters_that_the_output_cannot_show_become_question_marks(
    encoding: str, tmp_path: Path
) -> None:
    """A training ended in a UnicodeEncodeError, because its tables have a plus-minus sign.

    Windows writes files and pipes in the country's code page, other systems follow the locale.
    """
    level = tmp_path / "level.txt"
    level.write_text("name: 1 \N{PLUS-MINUS SIGN} 2 \N{SNOWMAN}\n\n..w........\n", "utf-8")
    done = run_arkanoid("levels", level, encoding=encoding)
    expected = "1 \N{PLUS-MINUS SIGN} 2 \N{SNOWMAN}".encode(encoding, "replace").decode(encoding)
    assert expected in done.stdout


def test_commands_work_for_a_user_without_a_home(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """No command worked, because the help of one of them names a folder in the user's home."""

    def user_data_dir(*_: object) -> str:
        raise RuntimeError("could not determine the home directory")

    monkeypatch.setattr(platformdirs, "user_data_dir", user_data_dir)
    assert cli.main(["levels"]) == 0
    with pytest.raises(SystemExit):
        cli.main(["play", "--help"])
    assert "replays" in capsys.readouterr().out


@pytest.mark.parametrize("columns", [40, 80, 200])
def test_levels_fit_the_terminal(
    columns: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The list's lines had up to 123 letters, and a level needs 44 columns."""
    for name, value in {"COLUMNS": str(columns), "TERM": "xterm", "NO_COLOR": ""}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    assert cli.main(["levels"]) == 0
    shown = capsys.readouterr().out.partition("\n\n")[0]
    assert max(map(len, shown.splitlines())) <= columns
    assert shown.split() == list_levels().split()
    assert cli.main(["levels", "spiral"]) == 0
    assert ("▀" in capsys.readouterr().out) == (columns >= 44)


def test_the_folder_that_one_is_in_has_a_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The sentence began with a full stop: ".: you may not write into this folder"."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(SettingsError, match=f"^{re.escape(str(tmp_path))}: you may not write"):
        check_folder(Path("game.gif"))
