"""The changes that `docs/extending.md` describes work, made to a copy of the sources."""

import re
import shutil
import sys
from pathlib import Path

import pytest
from helpers.processes import run, run_python
from helpers.repository import DOCS, ROOT, TESTS

PAGE = (DOCS / "extending.md").read_text(encoding="utf-8")
PACKAGES = ("configs", "envs", "physics")
PROGRAMS = sorted((TESTS / "extending").glob("*.py"))


def changes(page: str) -> list[tuple[str, str, str]]:
    """Return (file, old lines, new lines) of each block."""
    found = []
    for file, block in re.findall(r"^```diff\ndiff (\S+)\n(.*?)^```$", page, re.M | re.S):
        lines = block.splitlines(keepends=True)
        old = "".join(line[1:] for line in lines if line[0] != "+")
        new = "".join(line[1:] for line in lines if line[0] != "-")
        found.append((file, old, new))
    return found


def change(file: Path, old: str, new: str) -> None:
    """Replace lines, which the file must have exactly once; if there are none, create the file."""
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


def test_a_block_gives_old_and_new_lines(tmp_path: Path) -> None:
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
    """All in one test, so that one process compiles the copy's kernels, also under xdist.

    Their machine code is kept where that of all kernels is: it is found by the sources' contents.
    """
    assert [program.stem for program in PROGRAMS] == ["capsule", "reward", "shape"]
    for program in PROGRAMS:
        run_python(program, cwd=changed, changes={"PYTHONPATH": str(changed)})


def test_what_was_changed_is_formatted(changed: Path) -> None:
    """`make check` would refuse a recipe that leaves a line too long."""
    files = sorted({str(changed / "arkanoid" / file) for file, *_ in changes(PAGE)})
    for command in (["check"], ["format", "--check"]):
        settings = ["--config", ROOT / "pyproject.toml"]
        run(sys.executable, "-m", "ruff", *command, *settings, *files, cwd=ROOT)
