"""The benchmarks run. In the scenes of the engine's benchmark nothing is lost, nor any energy."""

import re
from pathlib import Path

import pytest
from helpers.processes import run_python
from helpers.repository import TESTS

FOLDER = TESTS / "benchmarks"
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


def test_gpu_compares_the_device_with_the_processor_and_measures_every_kind() -> None:
    """With the same entries on the processor, since a card is rarely at hand."""
    parts = ("games", "speed", "training")
    table = run(FOLDER / "gpu.py", "--device", "cpu", "--quick", "--only", *parts)
    assert len(re.findall(r"^  .* worlds +[\d,]+  equal$", table, re.MULTILINE)) == 7, table
    assert "DIFFERENT" not in table
    ratios = re.findall(r"^  .* worlds, cpu +[\d,]+ +[\d.]+ x$", table, re.MULTILINE)
    assert len(ratios) == 6 + 1, table  # of games, and of a training
    assert len(re.findall(r"^  .* worlds, all cores +[\d,]+$", table, re.MULTILINE)) == 6, table
    assert len(re.findall(r"^  (quick|lite), .* +[\d,]+  in [\d.]+ s$", table, re.MULTILINE)) == 2
    assert len(re.findall(r"^  .* plays .*(?: +-?[\d.]+){3}$", table, re.MULTILINE)) == 5, table
    assert max(map(len, table.splitlines())) <= 80, table
