"""What the README says is true: its code runs, its commands and links exist.

So do the commands of the pages that one reads first.
"""

import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)
PYTHON = [code for language, code in BLOCKS if language == "python"]


def commands(page: str) -> list[str]:
    """Return the commands in a page's blocks, without what is said beside them."""
    return [
        line.partition("  #")[0].strip()
        for text in re.findall(r"^```sh\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL)
        for line in text.splitlines()
        if line.strip() and not line.startswith("#")
    ]


COMMANDS = commands(README)
FIRST_PAGES = [ROOT / "docs" / name for name in ("install.md", "tour.md")]
OTHERS = [line for page in FIRST_PAGES for line in commands(page.read_text(encoding="utf-8"))]
TARGETS = re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
EXTRAS = set(
    tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "optional-dependencies"
    ]
)


def test_readme_has_examples_and_commands() -> None:
    assert PYTHON
    assert {"make train", "make test"} <= set(COMMANDS)
    assert {language for language, _ in BLOCKS} <= {"python", "sh", "text"}


@pytest.mark.parametrize("code", PYTHON)
def test_example_runs(code: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("command", dict.fromkeys(COMMANDS + OTHERS))
def test_command_exists(command: str) -> None:
    """Each command is of a known kind, and what it names is there."""
    words = [word for word in shlex.split(command) if not re.fullmatch(r"[A-Z_]+=\S*", word)]
    program = Path(words[0]).name
    if program == "make":
        assert set(words[1:]) <= set(TARGETS)
    elif program == "arkanoid":
        assert_has_help([str(Path(sys.executable).parent / "arkanoid"), words[1]])
    elif program.startswith("python") and words[1] == "-m":
        assert_has_help([sys.executable, *words[1:3]])
        assert extras_named(command) <= EXTRAS
    elif program.startswith("python"):
        assert_has_help([sys.executable, str(ROOT / words[1])])
    else:
        pytest.fail(f"{program}: teach this test how to check it")


@pytest.mark.parametrize("target", re.findall(r"\]\(([^)#]+)[^)]*\)", README))
def test_link_leads_somewhere(target: str) -> None:
    assert target.startswith("https://") or (ROOT / target).exists()


def extras_named(command: str) -> set[str]:
    """Return the extras of ``pip install ".[train,play]"``."""
    return {name for group in re.findall(r"\[([\w,]+)\]", command) for name in group.split(",")}


def assert_has_help(command: list[str]) -> None:
    """Check that a program exists and knows its subcommand."""
    done = subprocess.run([*command, "--help"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
