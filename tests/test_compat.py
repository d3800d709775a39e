"""The list of peers is whole, and the documentation says how the latest runs ended.

The runs themselves are `make compat`: they install gigabytes.
"""

import re
import shlex
import shutil
from pathlib import Path

import pytest
from compat import page as compat_page
from compat.peers import RUNS_ON, Peer, package, read_peers
from compat.run import PLACES, run
from helpers.repository import EXAMPLES, PROJECT
from packaging.requirements import Requirement

PEERS = list(read_peers().values())
TRIED_ELSEWHERE = {"rllib_ppo.py"}  # by `make ray`


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_requirements_are_pinned_and_contradict_no_constraint(peer: Peer) -> None:
    pins = [*peer.requirements, *peer.alone]
    assert [pin for pin in pins if not re.fullmatch(r"[\w-]+==[\d.]+", pin)] == []
    assert [clone for clone in peer.clones if not re.fullmatch(r"https://\S+@\w{40}", clone)] == []
    names = [package(pin) for pin in [*pins, *peer.constraints()]]
    assert len(names) == len(set(names))
    assert {*RUNS_ON} <= set(names)


def test_the_oldest_peer_has_the_lower_bounds_of_all_dependencies() -> None:
    """What pyproject.toml promises to work with is tried."""
    pins = dict(pin.split("==") for pin in read_peers()["gymnasium-0.29"].requirements)
    for requirement in map(Requirement, PROJECT["dependencies"]):
        (low,) = (part.version for part in requirement.specifier if part.operator == ">=")
        assert re.fullmatch(rf"{re.escape(low)}(\.0)*", pins[requirement.name])


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
    untried = {name for name in examples if f"peers/{name}" not in commands}
    assert untried == TRIED_ELSEWHERE


def test_every_peer_was_tried_in_the_version_that_is_pinned_and_works() -> None:
    """If not: make compat, or make compat PEER=name."""
    results = compat_page.read_results()
    assert list(results) == [peer.name for peer in PEERS]
    for peer in PEERS:
        assert results[peer.name]["passed"], peer.name
        for pin in (*peer.requirements, *peer.alone):
            name, _, version = pin.partition("==")
            # A build of torch for processors only has a longer version: 2.13.0+cpu.
            assert results[peer.name]["versions"][package(name)].partition("+")[0] == version


def test_the_page_is_what_the_results_say(tmp_path: Path) -> None:
    """If not: python -m compat.page, in tests/."""
    page, printed = tmp_path / "page.md", tmp_path / "printed.txt"
    shutil.copy(compat_page.PAGE, page)
    compat_page.write_page(page, printed)
    for written, committed in ((page, compat_page.PAGE), (printed, compat_page.PRINTED)):
        assert written.read_text(encoding="utf-8") == committed.read_text(encoding="utf-8")


def test_a_command_that_fails_is_noticed(tmp_path: Path) -> None:
    passed, lines = run("python -c 'print(2); raise SystemExit(\"no\")'", tmp_path)
    assert not passed
    assert lines == ["2", "no"]
    assert run("python -c 'print(1); print(); print(2)'", tmp_path) == (True, ["1", "2"])


@pytest.mark.parametrize(
    ("bounds", "supported"),
    [(("3.9", "3.13"), True), (("3.9", "3.10"), False), (("3.14", "3.14"), False)],
)
def test_versions_of_python_are_compared_as_numbers(
    bounds: tuple[str, str], supported: bool
) -> None:
    assert Peer("a", "A", ("a==1",), bounds, "nothing", ()).supports((3, 13)) is supported
