"""Commands that are printed work as they are, whatever the shell knows."""

import shutil
import sys
import sysconfig
from pathlib import Path

import pytest
from arkanoid.agents.experiment.programs import activation, arkanoid, command, start_of
from helpers.processes import run

SCRIPTS = Path(sysconfig.get_path("scripts"))
INSTALLED = shutil.which("arkanoid", path=str(SCRIPTS)) is not None
ELSEWHERE = "/nowhere"


def test_a_name_stays_where_the_shell_finds_it(monkeypatch: pytest.MonkeyPatch) -> None:
    if not INSTALLED:
        pytest.skip("the command is not installed")
    monkeypatch.setenv("PATH", str(SCRIPTS))
    assert arkanoid("train", Path("a b"), "--seed 1") in (
        "arkanoid train 'a b' --seed 1",
        'arkanoid train "a b" --seed 1',
    )
    assert activation() is None


def test_elsewhere_it_is_a_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """After `make train` the commands that it printed were not found."""
    monkeypatch.setenv("PATH", ELSEWHERE)
    for line in (arkanoid("--version"), command("pip", "--version")):
        if sys.platform != "win32":
            run("/bin/sh", "-c", line)


@pytest.mark.skipif(sys.platform == "win32", reason="another shell")
def test_another_installation_of_that_name_is_not_meant(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = tmp_path / "arkanoid"
    other.write_text("#!/bin/sh\n")
    other.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert start_of("arkanoid") != "arkanoid"


@pytest.mark.skipif(sys.platform == "win32" or not INSTALLED, reason="no script")
def test_the_path_is_the_one_that_was_typed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", ELSEWHERE)
    monkeypatch.chdir(SCRIPTS.parent)
    monkeypatch.setattr(sys, "argv", [f"{SCRIPTS.name}/arkanoid", "train"])
    assert arkanoid("evaluate", Path("runs")) == f"{SCRIPTS.name}/arkanoid evaluate runs"
