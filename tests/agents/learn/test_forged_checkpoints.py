"""Checkpoints that somebody forged: whole files with absurd contents."""

import math
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import torch
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.checkpoints import read_checkpoint, restore
from arkanoid.agents.learn.model import make_model
from arkanoid.agents.learn.tensors import read_tensors, write_tensors
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.episodes import adapt
from helpers.runs import sentence, small
from stable_baselines3.common.logger import Logger


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """A run that could go on."""
    measured = {"validation.every": "512", "validation.episodes": "1"}
    experiment = small(tmp_path_factory.mktemp("trained"), **measured)
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


def put(path: str, value: Any) -> Callable[[dict[str, Any]], None]:
    """Return what puts a value at a dotted path; into a tensor, at its first place."""

    def forge(state: dict[str, Any]) -> None:
        *names, last = [int(name) if name.isdecimal() else name for name in path.split(".")]
        table: Any = state
        for name in names:
            table = table[name]
        if isinstance(table[last], torch.Tensor):
            table[last].view(-1)[0] = value
        elif isinstance(table, tuple):
            raise AssertionError(f"{path} is in a tuple")
        else:
            table[last] = value

    return forge


# Of each kind of number, one place or more, and a value that it cannot have.
FORGED: dict[str, Any] = {
    "counters.num_timesteps": -1,
    "counters._n_updates": -1,
    "counters._episode_num": -1,
    "counters._current_progress_remaining": math.nan,
    "last._last_obs": math.nan,
    "last._last_obs.0": 1e30,
    "statistics.returns": math.nan,
    "statistics.lengths": -1,
    "statistics.sums.hits": math.nan,
    "statistics.sums.rounds_cleared": -1.0,
    "recent.ep_info_buffer.0.r": math.nan,
    "recent.ep_info_buffer.0.l": 0.5,
    "recent.ep_info_buffer.0.t": math.inf,
    "recent.ep_info_buffer.0.score": -1,
    "random.numpy.0": -1,
    "random.numpy.1": 625,
    "random.numpy.2": 2,
    "random.numpy.3": math.nan,
    "log.values": {"timesteps": 1.0},
    "log.counts": {"a\x1b[31m": 1},
    "callbacks.stage": 0.5,
    "callbacks.stop": "a\x1b[31m",
    "callbacks.validation.due": -1,
    "callbacks.validation.best": math.nan,
    "callbacks.validation.worse": 1.5,
    "callbacks.validation.latest": -2,
    "optimizer.state.0.step": math.nan,
    "optimizer.state.0.exp_avg_sq": -1.0,
}


@pytest.mark.parametrize("path", FORGED)
def test_a_number_out_of_its_range_is_named(path: str, trained: RunFolder) -> None:
    """NaN in an observation was told as a training that has diverged, and in a sum not at all."""
    state = read_checkpoint(trained.checkpoint)
    put(path, FORGED[path])(state)
    experiment = trained.experiment()
    venv = adapt(make_worlds(experiment, experiment.training.worlds))
    model = make_model(experiment, venv)
    model.set_logger(Logger(None, []))
    with pytest.raises(ValueError, match=path.partition(".")[0]):
        restore(state, model, venv)
    venv.close()


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such pipes")
@pytest.mark.parametrize("name", ["checkpoint.pt", "log", "curve.jsonl", "run.json"])
@pytest.mark.parametrize("make", [os.mkfifo, Path.touch, Path.mkdir])
def test_another_kind_of_file_ends_the_resuming_with_a_sentence(
    name: str,
    make: Callable[[Path], None],
    trained: RunFolder,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A pipe in the place of the checkpoint kept the command waiting for ever."""
    right = {"log": Path.mkdir, "curve.jsonl": Path.touch}  # an empty one is no damage
    if right.get(name) == make:
        return
    shutil.copytree(trained.path, tmp_path / "run")
    path = tmp_path / "run" / name
    shutil.rmtree(path) if path.is_dir() else path.unlink()
    make(path)
    assert str(path) in sentence(["train", "--resume", str(tmp_path / "run")], capsys)


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
