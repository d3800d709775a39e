"""What `docs/extending.md` tells to change, done to a copy of the sources, works as it says."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
PACKAGES = ("configs", "envs", "physics")
PROGRAMS = sorted((ROOT / "tests" / "extending").glob("*.py"))


def changes(page: str) -> list[tuple[str, str, str]]:
    """Return (file, the lines as they are, the lines as they are to be) of each block."""
    found = []
    for file, block in re.findall(r"^```diff\ndiff (\S+)\n(.*?)^```$", page, re.M | re.S):
        lines = block.splitlines(keepends=True)
        old = "".join(line[1:] for line in lines if line[0] != "+")
        new = "".join(line[1:] for line in lines if line[0] != "-")
        found.append((file, old, new))
    return found


def change(file: Path, old: str, new: str) -> None:
    """Put lines in the place of others, which must be there once; make a file for new ones."""
    text = file.read_text(encoding="utf-8") if old else ""
    assert file.exists() == bool(old)
    assert not old or text.count(old) == 1, f"{file.name} does not have once:\n{old}"
    file.write_text(text.replace(old, new) if old else new, encoding="utf-8")


@pytest.fixture(scope="module")
def changed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder in which `arkanoid` is a copy with all changes of the page."""
    folder = tmp_path_factory.mktemp("changed")
    copy = folder / "arkanoid"
    for package in PACKAGES:
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / package, copy / package, ignore=ignored)
    for file in ROOT.glob("*.py"):
        shutil.copy(file, copy)
    for name, old, new in changes(PAGE):
        change(copy / name, old, new)
    return folder


def test_a_block_is_what_was_and_what_is_to_be(tmp_path: Path) -> None:
    page = "Text\n```diff\ndiff a.py\n one\n-two\n+three\n+four\n five\n```\n"
    ((name, old, new),) = changes(page)
    assert (name, old, new) == ("a.py", "one\ntwo\nfive\n", "one\nthree\nfour\nfive\n")
    file = tmp_path / name
    file.write_text("zero\none\ntwo\nfive\nsix\n", encoding="utf-8")
    change(file, old, new)
    assert file.read_text(encoding="utf-8") == "zero\none\nthree\nfour\nfive\nsix\n"
    with pytest.raises(AssertionError, match="does not have once"):
        change(file, old, new)


def test_the_page_has_all_of_its_changes() -> None:
    assert len(changes(PAGE)) == PAGE.count("```diff")


def test_what_was_added_works(changed: Path) -> None:
    """All in one test, so that the copy's kernels are compiled once, whoever runs it."""
    assert [program.stem for program in PROGRAMS] == ["capsule", "reward", "shape"]
    environment = {
        **os.environ,
        "PYTHONPATH": str(changed),
        "ARKANOID_CACHE_DIR": str(changed / "cache"),
    }
    for program in PROGRAMS:
        done = subprocess.run(
            [sys.executable, "-W", "error", program],
            cwd=changed,
            env=environment,
            capture_output=True,
            text=True,
            timeout=300,
        )
        assert done.returncode == 0, done.stderr


def test_what_was_changed_is_in_format(changed: Path) -> None:
    """A recipe that leaves a line too long would be refused by `make check`."""
    files = sorted({str(changed / "arkanoid" / file) for file, *_ in changes(PAGE)})
    settings = ["--config", str(ROOT / "pyproject.toml")]
    for command in (["check"], ["format", "--check"]):
        done = subprocess.run(
            [sys.executable, "-m", "ruff", *command, *settings, *files],
            cwd=ROOT,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stdout
