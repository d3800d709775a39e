"""The benchmarks run. In the scenes of the engine's benchmark nothing is lost, nor any energy."""

import re
import sys
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch
from helpers.processes import run_python
from helpers.repository import TESTS

FOLDER = TESTS / "benchmarks"
PARTS_OF_GPU = ("games", "speed", "training", "quick", "lite", "peers", "others")
SCRIPTS = sorted(FOLDER.glob("*.py"))


def run(script: Path, *arguments: str) -> str:
    """Run a benchmark as a user would; return its output."""
    return run_python(script, *arguments, warnings="default", timeout=900.0).stdout


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.name)
def test_benchmark_has_help(script: Path) -> None:
    assert "--help" in run(script, "--help")


def test_engine_loses_nothing_in_the_scenes_of_its_benchmark() -> None:
    """The rows' labels, or the lines below, say which values are right. Speeds are not checked."""
    table = run(FOLDER / "engine.py", "--quick", "--only-ours")
    rows = re.findall(r"^  +(\S.*?)  +([\d.,e+-]+)$", table, re.MULTILINE)
    checked = 0
    for label, text in rows:
        value = float(text.replace(",", ""))
        due = re.search(r"due: ([\d,]+)$", label)
        if due:
            assert value == int(due[1].replace(",", "")), label
        elif label.startswith(("balls that left", "discs that left", "got through")):
            assert value == 0, label
        elif label.startswith(("came back", "are where")):
            assert value == 200, label
        elif label.startswith("energy drift") or label.endswith("of the starts"):
            assert value < 1e-9, label
        elif label.startswith("contacts in"):
            assert value > 10, label
        else:
            continue
        checked += 1
    assert checked == 14, table


def test_throughput_measures_everything_and_judges_goals_by_the_printed_figures() -> None:
    """Whether the machine reaches a goal is not checked, only that the table says so truly."""
    table = run(FOLDER / "throughput.py", "--quick", "--only-ours")
    rows = re.findall(r"^  [a-z ]  (\S.*?)  +([\d,]+)(?:   (.*))?$", table, re.MULTILINE)
    assert len(rows) == 17 + 6, table
    judged = 0
    for label, text, said in rows:
        rate = float(text.replace(",", ""))
        assert rate > 0, label
        goal = re.search(r"goal ([\d.,]+): (met|MISSED)$", said)
        if goal:
            share = re.match(r"([\d.]+) x ", said)
            reached = float(share[1]) if share else rate
            wanted = float(goal[1].replace(",", ""))
            # Two decimals are printed: within their rounding either judgement is right.
            if abs(reached - wanted) > 0.006:
                assert (goal[2] == "met") == (reached > wanted), label
            judged += 1
    assert judged == 4 + 2 + 2 + 2 + 4, table


def test_gpu_does_every_part_with_the_same_entries_on_the_processor() -> None:
    """A card is rarely at hand, and no fault of the program may cost its minutes."""
    table = run(FOLDER / "gpu.py", "--device", "cpu", "--quick")
    assert len(re.findall(r"^  .* worlds +[\d,]+  equal$", table, re.MULTILINE)) == 7, table
    assert "DIFFERENT" not in table
    ratios = re.findall(r"^  .* worlds, cpu +[\d,]+ +[\d.]+ x$", table, re.MULTILINE)
    assert len(ratios) == 2 + 1 + 6, table  # of games, of a training, of other games
    cores = re.findall(r"^  (?!turbo).* worlds, all cores +[\d,]+$", table, re.MULTILINE)
    assert len(cores) == 2 + 6, table
    assert len(re.findall(r"^  (quick|lite), .* +[\d,]+  in [\d.]+ s$", table, re.MULTILINE)) == 2
    assert len(re.findall(r"^  .* plays .*(?: +-?[\d.]+){3}$", table, re.MULTILINE)) == 4, table
    assert len(re.findall(r"^    goal .*: not tried$", table, re.MULTILINE)) == 2 + 1 + 2, table
    assert len(re.findall(r"^  (?:gymnax|turbo|Puffer).*(?:[\d,]+|left out)$", table, re.M)) == 3
    assert re.findall(r"^  (\w+): \d+ s$", table, re.MULTILINE) == [*PARTS_OF_GPU], table
    assert max(map(len, table.splitlines())) <= 80, table


@pytest.fixture
def gpu(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return the module of the benchmark on a card."""
    monkeypatch.syspath_prepend(str(FOLDER))
    return import_module("gpu")


def test_gpu_goes_on_after_a_part_that_fails(
    gpu: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One error ended all, with most of a card's minutes left."""

    def fail(device: str, effort: object) -> None:
        raise RuntimeError("an illegal memory access")

    done: list[str] = []
    again: list[list[str]] = []
    parts = {"one": ("One:", fail), "two": ("Two:", lambda device, effort: done.append(device))}
    monkeypatch.setattr(gpu, "PARTS", parts)
    monkeypatch.setattr(gpu, "run_again", lambda parts: again.append(parts) or 0)
    assert gpu.show(["one", "two"], "cpu", None) == 1
    assert (done, again) == (["cpu"], [])
    assert "one FAILED: RuntimeError: an illegal memory access" in capsys.readouterr().out
    # After an error in a kernel, nothing works in this process.
    monkeypatch.setattr(gpu, "works", lambda device: False)
    assert gpu.show(["one", "two"], "cpu", None) == 1
    assert (done, again) == (["cpu"], [["two"]])


def test_gpu_goes_on_in_another_process_with_the_same_options(
    gpu: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    called: list[list[str]] = []
    options = ["--device", "cuda:1", "--quick"]
    monkeypatch.setattr(
        gpu.subprocess,
        "run",
        lambda command, check: called.append(command) or SimpleNamespace(returncode=0),
    )
    monkeypatch.setattr(sys, "argv", ["gpu.py", "--only", "games", "peers", *options])
    assert gpu.run_again(["peers"]) == 0
    assert called[0][2:] == [*options, "--only", "peers"]
    assert not gpu.works("meta")
    assert gpu.works("cpu")


def test_gpu_says_what_was_different_and_when(gpu: Any) -> None:
    """Zero and minus zero are different; a plain "no" would not help to find the fault."""
    judge = import_module("cards.comparing").Judge("cpu")
    zeros = np.zeros(3)
    for judge.decision in range(1, 9):
        judge.compare("rewards", torch.from_numpy(zeros), -zeros if judge.decision == 5 else zeros)
        judge.compare("infos", {"lives": torch.ones(2)}, {"lives": np.ones(2, np.float32)})
        assert (judge.verdict() == "equal") == (judge.decision < 5)
    assert judge.verdict() == "DIFFERENT: rewards in decision 5"
    with pytest.raises(AssertionError, match="infos"):
        judge.compare("infos", torch.ones(2), np.ones(3, np.float32))


@pytest.mark.parametrize("device", ["tpu", "cuda"])
def test_gpu_refuses_what_is_not_there_in_a_sentence(
    gpu: Any, device: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(torch.version, "cuda", None)
    monkeypatch.setattr(sys, "argv", ["gpu.py", "--device", device])
    with pytest.raises(SystemExit, match="2"):
        gpu.main()
    assert re.search("must be 'cuda'|built without CUDA", capsys.readouterr().err)
