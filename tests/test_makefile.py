"""What ``make`` does and says on machines that lack something.

Its Makefile runs in a folder of its own, with a PATH that holds nothing but a few tools and fake
interpreters: shell scripts that answer as a Python of some age, with or without ``venv``, would.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MAKE = shutil.which("gmake") or shutil.which("make")
TOOLS = ("awk", "chmod", "cp", "echo", "mkdir", "rm", "sh", "touch")
# Tells of each call in "calls"; with `-m venv`, makes a folder that holds itself.
INTERPRETER = """#!/bin/sh
echo "${0##*/} $*" >> "$CALLS"
case "$*" in
*version_info*) exit %(too_old)d ;;
*"import ensurepip, venv"*) exit %(no_venv)d ;;
*"import pip"*) exit %(no_pip)d ;;
"-m venv "*) mkdir -p "$3/bin" &&
    for tool in python mypy basedpyright; do cp "$0" "$3/bin/$tool"; done && exit %(venv_fails)d ;;
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

    def has(self, name: str, **lacks: bool) -> "Machine":
        """Put an interpreter on the PATH."""
        answers = dict.fromkeys(("too_old", "no_venv", "no_pip", "venv_fails"), False) | lacks
        script = self.bin / name
        script.write_text(INTERPRETER % answers, encoding="utf-8")
        script.chmod(0o755)
        return self

    def make(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run make, and return how it ended and what it said."""
        assert MAKE is not None
        return subprocess.run(
            [MAKE, *arguments],
            cwd=self.clone,
            env={"PATH": str(self.bin), "CALLS": str(self.calls)},
            capture_output=True,
            text=True,
            timeout=60,
        )

    def refusal(self, *arguments: str) -> str:
        """Return what make says when it refuses, before make's own last line."""
        done = self.make(*arguments)
        assert done.returncode != 0
        *lines, last = done.stderr.splitlines()
        assert "***" in last
        return " ".join(lines or [last])

    def called(self) -> list[str]:
        """Return the calls of interpreters, but for what they were asked about themselves."""
        calls = self.calls.read_text(encoding="utf-8").splitlines()
        return [call for call in calls if " -c " not in call]


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


def test_no_python(machine: Machine) -> None:
    said = machine.refusal("train")
    assert "needs Python 3.11 or newer, and none was found" in said
    assert "make PYTHON=/path/to/python3.12 train" in said


def test_every_python_is_too_old(machine: Machine) -> None:
    """Also what pyenv puts on the PATH for a version that is not switched on: it only fails."""
    machine.has("python3", too_old=True).has("python3.12", too_old=True)
    assert "none was found" in machine.refusal("test")
    assert not (machine.clone / ".venv").exists()


def test_named_python_is_too_old_or_missing(machine: Machine) -> None:
    machine.has("python3").has("old", too_old=True)
    for name in ("old", "missing"):
        said = machine.refusal(f"PYTHON={name}", "train")
        assert f"needs Python 3.11 or newer; {name} is older or missing" in said


def test_newest_python_need_not_be_python3(machine: Machine) -> None:
    machine.has("python3", too_old=True).has("python3.12")
    assert machine.make(".venv/train").returncode == 0
    assert "python3.12 -m venv .venv" in machine.called()


def test_python_without_venv(machine: Machine) -> None:
    """As Debian's without the package python3-venv."""
    machine.has("python3", no_venv=True)
    said = machine.refusal("test")
    assert "python3 lacks the venv module" in said
    assert "python3-venv" in said
    assert machine.called() == []


def test_installs_once(machine: Machine) -> None:
    machine.has("python3")
    assert machine.make(".venv/dev").returncode == 0
    expected = "python -m pip install --constraint constraints.txt --editable .[dev]"
    assert machine.called() == ["python3 -m venv .venv", expected]
    assert machine.make(".venv/dev", ".venv/train").returncode == 0  # dev holds train
    assert machine.called() == ["python3 -m venv .venv", expected]


def test_environment_that_was_interrupted(machine: Machine) -> None:
    """It was taken for a whole one ever after: "No module named pip"."""
    machine.has("python3", venv_fails=True, no_pip=True)
    assert machine.make(".venv/train").returncode != 0
    assert machine.make(".venv/train").returncode == 0
    installed = [call for call in machine.called() if call.startswith("python -m")]
    assert [call.split()[2] for call in installed] == ["ensurepip", "pip"]


@pytest.mark.parametrize("name", ["with spaces", "with'quote", "with$dollar", "with:colon", "ü"])
def test_folder_of_any_name(tmp_path: Path, name: str) -> None:
    """A virtual environment can have no colon in its path: there it must lie elsewhere."""
    machine = Machine(tmp_path, name).has("python3")
    elsewhere = [f"VENV={tmp_path}/venv"] if ":" in name else []
    target = f"{tmp_path}/venv/train" if elsewhere else ".venv/train"
    done = machine.make(*elsewhere, target)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("place", ["two words", "a:b", ""])
def test_environment_in_a_place_that_make_cannot_name(machine: Machine, place: str) -> None:
    """It made a folder of the first word and complained of circles."""
    said = machine.has("python3").refusal(f"VENV={place}", "train")
    assert f"VENV must be a path without spaces and colons, but is '{place}'" in said


@pytest.mark.parametrize("name", ["clone", "with spaces", "with$dollar", "with'quote"])
@pytest.mark.parametrize("links", [True, False])
def test_types_are_checked_under_the_name_of_the_package(
    tmp_path: Path, name: str, links: bool
) -> None:
    """Where there are no links (Windows, some file systems), copies do."""
    machine = Machine(tmp_path, name).has("python3")
    (machine.bin / "ln").symlink_to(shutil.which("ln" if links else "false") or "")
    for file in ("py.typed", "__init__.py", "physics/__init__.py", "tests/no_package.py"):
        (machine.clone / file).parent.mkdir(exist_ok=True)
        (machine.clone / file).touch()
    for _ in range(2):  # what is left from the time before is no hindrance
        done = machine.make("types")
        assert done.returncode == 0, done.stderr
    made = machine.clone / "build" / "types" / "arkanoid"
    assert sorted(path.name for path in made.iterdir()) == [
        "__init__.py",
        "physics",
        "py.typed",
        "version.py",
    ]
    assert (made / "physics" / "__init__.py").is_file()
    assert (made / "physics").is_symlink() == links


def test_another_make(machine: Machine) -> None:
    """BSD's said "don't know how to make |" and nothing more.

    To it the sign before order-only prerequisites is the name of a file, for which there is a rule.
    """
    assert "needs GNU make" in machine.refusal("|")


def test_help_names_every_target(machine: Machine) -> None:
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = re.findall(r"^([a-z]+):", text, flags=re.MULTILINE)
    said = machine.make().stdout
    assert [line.split()[1] for line in said.splitlines()] == targets
    (phony,) = re.findall(r"^\.PHONY: (.+)$", text, flags=re.MULTILINE)
    assert set(phony.split()) == set(targets)
