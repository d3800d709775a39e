"""The table of peers is whole, and the page on compatibility says what came of the latest tries.

The tries themselves are `make compat`: they install gigabytes.
"""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
COMPAT = ROOT / "tests" / "compat"
EXAMPLES = ROOT / "docs" / "examples"
sys.path.insert(0, str(COMPAT))

import page as compat_page  # noqa: E402
from peers import RUNS_ON, Peer, package, read_peers  # noqa: E402
from run import PLACES, run, supports_this_python  # noqa: E402

PEERS = list(read_peers().values())
# `make ray` tries it.
ELSEWHERE = {"rllib_ppo.py"}


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_requirements_are_pinned_and_contradict_no_constraint(peer: Peer) -> None:
    unpinned = [pin for pin in peer.requirements if not re.fullmatch(r"[\w-]+==[\d.]+", pin)]
    assert unpinned == []
    names = [package(pin) for pin in [*peer.requirements, *peer.constraints()]]
    assert len(names) == len(set(names))
    assert {*RUNS_ON} <= set(names)


def test_the_oldest_peer_has_the_lower_bounds_of_all_dependencies() -> None:
    """What pyproject.toml promises to work with is what is tried."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    block = text.partition("\ndependencies = [")[2].partition("]")[0]
    bounds = dict(re.findall(r'"([\w-]+)>=([\d.]+)', block))
    pins = dict(pin.split("==") for pin in read_peers()["gymnasium-1.1"].requirements)
    assert {"gymnasium", "numba", "numpy"} <= bounds.keys()
    for name, low in bounds.items():
        assert f"{pins[name]}.".startswith(f"{low}.")
        assert set(pins[name].removeprefix(low)) <= {".", "0"}


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_commands_name_files_that_exist(peer: Peer) -> None:
    for command in peer.commands:
        for word in shlex.split(command):
            for place, path in PLACES.items():
                word = word.replace(place, str(path))
            assert "{" not in word
            assert Path(word).exists() or not word.endswith((".py", ".yml")), word


def test_every_example_for_a_peer_is_tried() -> None:
    commands = " ".join(command for peer in PEERS for command in peer.commands)
    examples = {path.name for path in (EXAMPLES / "peers").iterdir() if path.is_file()}
    assert {name for name in examples - ELSEWHERE if f"peers/{name}" not in commands} == set()


def test_every_peer_was_tried_in_the_version_that_is_pinned_and_works() -> None:
    """If not: make compat, or make compat PEER=name."""
    results = compat_page.read_results()
    assert list(results) == [peer.name for peer in PEERS]
    for peer in PEERS:
        assert results[peer.name]["passed"], peer.name
        for pin in peer.requirements:
            name, _, version = pin.partition("==")
            # A build of torch for the processor alone says so: 2.13.0+cpu.
            assert results[peer.name]["versions"][package(name)].partition("+")[0] == version


def test_the_page_is_what_the_results_say(tmp_path: Path) -> None:
    """If not: python tests/compat/page.py."""
    written = tmp_path / "page.md"
    shutil.copy(compat_page.PAGE, written)
    compat_page.write_page(written)
    assert written.read_text(encoding="utf-8") == compat_page.PAGE.read_text(encoding="utf-8")


def test_a_page_without_its_marks_is_refused(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# Compatibility\n", encoding="utf-8")
    with pytest.raises(ValueError, match="is missing"):
        compat_page.write_page(page)


def test_a_command_that_fails_is_noticed(tmp_path: Path) -> None:
    python = Path(sys.executable)
    passed, lines = run("python -c 'print(2); raise SystemExit(\"no\")'", python, tmp_path)
    assert not passed
    assert lines == ["2", "no"]
    assert run("python -c 'print(1); print(); print(2)'", python, tmp_path) == (True, ["1", "2"])


@pytest.mark.parametrize(
    ("bounds", "supported"),
    [(("3.11", "3.99"), True), (("3.9", "3.10"), False), (("3.98", "3.99"), False)],
)
def test_versions_of_python_are_compared_as_numbers(bounds: tuple, supported: bool) -> None:
    peer = Peer("a", "A", ("a==1",), bounds, "nothing", ())
    assert supports_this_python(peer) is supported


def test_an_unknown_peer_is_named() -> None:
    done = subprocess.run(
        [sys.executable, COMPAT / "run.py", "torchlr"], capture_output=True, text=True
    )
    assert done.returncode == 2
    assert "no peer 'torchlr'; there are gymnasium-1.1" in done.stderr
