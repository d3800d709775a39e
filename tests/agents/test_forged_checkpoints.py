"""Checkpoints that somebody forged: whole files with absurd contents."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import torch
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.learn.tensors import read_tensors, write_tensors
from arkanoid.agents.learn.training import train
from helpers.runs import sentence, small


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """A run that could go on."""
    experiment = small(tmp_path_factory.mktemp("trained"))
    run = RunFolder.create(experiment)
    train(experiment, run)
    run.add_notes(outcome="interrupted")
    return run


def endless(state: dict[str, Any]) -> None:
    value: Any = ["a" * 50] * 8
    for _ in range(8):
        value = [value] * 8
    state["format"] = value


def wide(state: dict[str, Any]) -> None:
    state["environment"] = torch.zeros(1, dtype=torch.uint8).expand(2 * 10**9)


def negative(state: dict[str, Any]) -> None:
    for moments in state["optimizer"]["state"].values():
        moments["step"] = torch.tensor(-1.0)


def huge(state: dict[str, Any]) -> None:
    state["counters"]["_n_updates"] = 10**400


@pytest.mark.parametrize("forge", [endless, wide, negative, huge])
def test_a_checkpoint_of_absurd_numbers_is_named_at_once(
    forge: Callable[[dict[str, Any]], None],
    trained: RunFolder,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The first hung on its format, the second took gigabytes, the others had tracebacks."""
    shutil.copytree(trained.path, tmp_path / "run")
    run = RunFolder(tmp_path / "run")
    state = read_tensors(run.checkpoint.read_bytes())
    forge(state)
    run.checkpoint.write_bytes(write_tensors(state))
    assert str(run.checkpoint) in sentence(["train", "--resume", str(run.path)], capsys)
