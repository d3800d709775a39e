"""What ``make`` does and says on a machine where little is installed.

The Makefile runs in a folder of its own, with a PATH that holds only a few tools and fake
interpreters: shell scripts that answer as a Python of some age would.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from helpers.processes import PATIENCE
from helpers.repository import ROOT

MAKE = shutil.which("gmake") or shutil.which("make")
TOOLS = ("awk", "chmod", "cp", "echo", "mkdir", "rm", "sh", "touch")
# Writes each call into the file CALLS. `-m venv` makes a folder that holds a copy of the script.
INTERPRETER = """#!/bin/sh
echo "${0##*/} $*" >> "$CALLS"
case "$*" in
*version_info*) exit %(too_old)d ;;
"-m venv "*) mkdir -p "$3/bin" && for tool in python mypy basedpyright; do
    cp "$0" "$3/bin/$tool"; done && exit %(venv_fails)d ;;
esac
"""

pytestmark = pytest.mark.skipif(
    MAKE is None and os.name == "nt",
    reason="Windows has no make: CONTRIBUTING.md names the commands",
)


class Machine:
    """A folder with the Makefile, and a PATH."""

    def __init__(self, folder: Path, name: str = "clone") -> None:
        self.bin = folder / "bin"
        self.clone = folder / name
        self.calls = folder / "calls"
        self.bin.mkdir()
        self.clone.mkdir()
        self.calls.touch()
        for tool in TOOLS:
            (self.bin / tool).symlink_to(shutil.which(tool) or f"/bin/{tool}")
        for file in ("Makefile", "pyproject.toml", "constraints.txt", "version.py"):
            shutil.copy(ROOT / file, self.clone)

    def has(self, name: str, *, too_old: bool = False, venv_fails: bool = False) -> "Machine":
        """Put an interpreter on the PATH."""
        script = self.bin / name
        answers = {"too_old": too_old, "venv_fails": venv_fails}
        script.write_text(INTERPRETER % answers, encoding="utf-8")
        script.chmod(0o755)
        return self

    def make(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run make with nothing else in its environment, and return what it said."""
        assert MAKE is not None
        return subprocess.run(
            [MAKE, *arguments],
            cwd=self.clone,
            env={"PATH": str(self.bin), "CALLS": str(self.calls)},
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )

    def called(self) -> list[str]:
        """Return the calls of interpreters, except questions about their version."""
        calls = self.calls.read_text(encoding="utf-8").splitlines()
        return [call for call in calls if " -c " not in call]


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


@pytest.mark.parametrize("named", ["", "PYTHON=python3", "PYTHON=missing"])
def test_no_python_is_new_enough(machine: Machine, named: str) -> None:
    done = machine.has("python3", too_old=True).make(*named.split(), "train")
    assert done.returncode != 0
    assert "arkanoid needs Python 3.11 or newer" in done.stderr
    assert "make PYTHON=/path/to/python3.12 train" in done.stderr
    assert not (machine.clone / ".venv").exists()


def test_newest_python_need_not_be_python3(machine: Machine) -> None:
    machine.has("python3", too_old=True).has("python3.12")
    assert machine.make(".venv/train").returncode == 0
    assert "python3.12 -m venv .venv" in machine.called()


@pytest.mark.parametrize("name", ["clone", "with spaces", "with'quote", "with$dollar"])
def test_installs_once_in_a_folder_of_any_name(tmp_path: Path, name: str) -> None:
    machine = Machine(tmp_path, name).has("python3")
    for _ in range(2):
        done = machine.make(".venv/dev", ".venv/train")  # dev holds train
        assert done.returncode == 0, done.stderr
    install = "python -m pip install --constraint constraints.txt --editable .[dev]"
    assert machine.called() == ["python3 -m venv .venv", install]


def test_environment_that_was_interrupted_is_made_again(machine: Machine) -> None:
    """It lacked pip, and make took it for a whole one ever after."""
    assert machine.has("python3", venv_fails=True).make(".venv/train").returncode != 0
    assert machine.has("python3").make(".venv/train").returncode == 0
    assert machine.called()[:2] == ["python3 -m venv .venv"] * 2


@pytest.mark.parametrize("links", [True, False])
def test_types_are_checked_under_the_name_of_the_package(machine: Machine, links: bool) -> None:
    """Where there are no links (Windows, some file systems), copies do."""
    (machine.bin / "ln").symlink_to(shutil.which("ln" if links else "false") or "")
    for file in ("py.typed", "__init__.py", "physics/__init__.py", "tests/no_package.py"):
        (machine.clone / file).parent.mkdir(exist_ok=True)
        (machine.clone / file).touch()
    for _ in range(2):  # the second time finds what the first has left
        done = machine.has("python3").make("types")
        assert done.returncode == 0, done.stderr
    made = machine.clone / "build" / "types" / "arkanoid"
    held = sorted(path.name for path in made.iterdir())
    assert held == ["__init__.py", "physics", "py.typed", "version.py"]
    assert (made / "physics" / "__init__.py").is_file()
    assert (made / "physics").is_symlink() == links


def test_help_names_every_target(machine: Machine) -> None:
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = re.findall(r"^([a-z]+):", text, flags=re.MULTILINE)
    said = machine.make().stdout
    assert [line.split()[1] for line in said.splitlines()] == targets
