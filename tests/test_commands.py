"""The commands of the pages that one reads first, and the Makefile's targets, exist."""

import re
import shlex
import sys
from pathlib import Path

import pytest
from helpers.pages import commands
from helpers.processes import run, run_arkanoid
from helpers.repository import DOCS, EXTRAS, ROOT

PAGES = [
    *(ROOT / "README.md", ROOT / "CONTRIBUTING.md"),
    *(DOCS / "install.md", DOCS / "tour.md"),
]
TARGETS = re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)


@pytest.mark.parametrize("command", sorted({line for page in PAGES for line in commands(page)}))
def test_command_exists(command: str) -> None:
    """Each command is of a known kind, and what it names is there."""
    words = [word for word in shlex.split(command) if not re.match(r"[A-Z_]+=", word)]
    program = Path(words[0]).name
    if words[0] == ".":
        assert words[1] == ".venv/bin/activate"
    elif program == "make":
        assert words[1] in TARGETS
    elif program == "arkanoid":
        run_arkanoid(words[1], "--help")
    elif program == "git":
        assert words[1] in ("clone", "tag")
    elif program == "pre-commit":
        run(sys.executable, "-m", "pre_commit", words[1], "--help")
    elif program.startswith("python") and words[1] == "-m":
        run(sys.executable, *words[1:3], "--help")
        assert extras(command) <= EXTRAS.keys()
    elif program.startswith("python"):
        run(sys.executable, ROOT / words[1], "--help")
    else:
        pytest.fail(f"{program}: teach this test how to check it")


def extras(command: str) -> set[str]:
    """Return the extras that a command such as ``pip install ".[train,play]"`` names."""
    return {name for group in re.findall(r"\[([\w,]+)\]", command) for name in group.split(",")}
