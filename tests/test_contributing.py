"""What CONTRIBUTING.md says is true: its links, targets, programs and files exist."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
TARGETS = set(re.findall(r"^([a-z]+):", MAKEFILE, flags=re.MULTILINE))
COMMANDS = [
    line.partition("  #")[0].strip()
    for block in re.findall(r"^```sh\n(.*?)^```$", PAGE, flags=re.MULTILINE | re.DOTALL)
    for line in block.splitlines()
]
MADE = ("build", "dist", ".venv")  # folders that a reader makes


def test_every_link_leads_somewhere() -> None:
    headings = re.findall(r"^#+ (.+)$", PAGE, flags=re.MULTILINE)
    anchors = {heading.lower().replace(" ", "-") for heading in headings}
    for path, anchor in re.findall(r"\]\(([^)#]*)#?([^)]*)\)", PAGE):
        assert (ROOT / path).exists() if path else anchor in anchors, (path, anchor)


def test_every_file_that_is_named_exists() -> None:
    names = re.findall(r"[\w.-]+(?:/[\w.-]*)+|\b[\w-]+\.(?:py|toml|txt|md)\b", PAGE)
    assert names
    missing = {name for name in names if not (ROOT / name).exists()}
    assert {name for name in missing if not name.startswith(MADE)} == set()


def test_targets_of_make() -> None:
    """Those that are named are there, and a contributor's are all named."""
    named = set(re.findall(r"`make (?:[A-Z]+=\S+ )*([a-z]+)", PAGE))
    assert named <= TARGETS
    assert {"test", "lint", "types", "format", "check", "bench", "distcheck", "clean"} <= named


@pytest.mark.parametrize("command", COMMANDS)
def test_command_exists(command: str) -> None:
    program, *words = shlex.split(command)
    if program == "make":
        assert words[0] in TARGETS
    elif Path(program).name == "pre-commit":
        assert_runs("pre_commit", words[0])
    else:
        assert Path(program).name in ("python", "python3")
        assert words[0] == "-m"
        assert_runs(words[1])


def test_hooks_call_targets_that_exist() -> None:
    hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    calls = re.findall(r"entry: make (\w+)$", hooks, flags=re.MULTILINE)
    assert len(calls) == hooks.count("- id:")
    assert set(calls) <= TARGETS


def test_what_makes_results_what_they_are_is_where_the_page_says() -> None:
    for name, file in re.findall(r"`(GOLDEN|golden|RULES_VERSION)` in `([\w/.]+)`", PAGE):
        assert re.search(rf"\b{name} = ", (ROOT / file).read_text(encoding="utf-8")), name


def assert_runs(module: str, *words: str) -> None:
    """Check that a module can be run as a program, and knows the subcommand."""
    done = subprocess.run(
        [sys.executable, "-m", module, *words, "--help"], capture_output=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
