"""The command line where something usual is missing: letters, a home."""

import os
import subprocess
import sys
from pathlib import Path

import platformdirs
import pytest
from arkanoid.agents import cli

PROGRAM = "import sys; from arkanoid.agents.cli import main; sys.exit(main(sys.argv[1:]))"


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "cp437", "utf-8"])
def test_letters_that_the_output_does_not_know(encoding: str, tmp_path: Path) -> None:
    """The tables of a training ended in a UnicodeEncodeError: for their sign of plus and minus.

    Windows writes files and pipes in a code page of the country, others as the locale says.
    """
    level = tmp_path / "level.txt"
    level.write_text("name: 1 \N{PLUS-MINUS SIGN} 2 \N{SNOWMAN}\n\n..w........\n", "utf-8")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, "levels", str(level)],
        env=os.environ | {"PYTHONIOENCODING": encoding},
        capture_output=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr.decode()
    expected = "1 \N{PLUS-MINUS SIGN} 2 \N{SNOWMAN}".encode(encoding, "replace")
    assert expected in done.stdout


def test_a_user_without_a_home(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """No command worked, for the help of one of them names a folder in the user's home."""

    def user_data_dir(*_: object) -> str:
        raise RuntimeError("could not determine the home directory")

    monkeypatch.setattr(platformdirs, "user_data_dir", user_data_dir)
    assert cli.main(["levels"]) == 0
    with pytest.raises(SystemExit):
        cli.main(["play", "--help"])
    assert "replays" in capsys.readouterr().out
