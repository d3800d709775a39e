"""Small runs of trainings, copies of packaged ones, and commands that fail."""

import shutil
from pathlib import Path

import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.packaged import find_agent
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.settings import Experiment, load_experiment

# The settings of a training that takes a second.
SMALL = {
    "training.timesteps": "2048",
    "training.worlds": "8",
    "training.checkpoint_every": "512",
    "ppo.n_steps": "32",
    "ppo.batch_size": "128",
    "network.hidden": "[8]",
    "env.max_decisions": "40",
    "evaluation.episodes": "1",
    "evaluation.baselines": "[]",
    "evaluation.film_seconds": "0.2",
}


def small(output: Path, **changes: str) -> Experiment:
    """Return an experiment that trains for a second, with other settings changed by `changes`."""
    settings = {**SMALL, "output": str(output), **changes}
    return load_experiment("quick", list(settings.items()))


def packaged_copy(path: Path) -> RunFolder:
    """Return a copy of the packaged agent's run, in a new folder; its model is the last one."""
    shutil.copytree(find_agent(None), path)
    run = RunFolder(path)
    run.best.rename(run.model)
    return run


def sentence(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """Run a command that fails by a mistake; return its one sentence."""
    capsys.readouterr()
    assert cli.main(arguments) == 2
    *_, error = capsys.readouterr().err.splitlines()
    assert error.startswith("arkanoid: error: ")
    return error
