"""Evaluation and validation on a device, here this processor: the numbers are those of arrays."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn import model, periodic_validation
from arkanoid.agents.learn.curves import read_curve
from arkanoid.agents.learn.model import make_model
from arkanoid.agents.learn.playing import ModelPolicy
from arkanoid.agents.learn.ppo import FastPPO
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.episodes import adapt, play_episodes
from arkanoid.agents.measure.suites import find_starts
from helpers.runs import small

KINDS = {
    "vector": [("env.landing", "true")],
    "grid": [("env.observation", "grid")],
    "picture": [("env.observation", "rgb"), ("env.size", "40"), ("env.stack", "2")],
    "reals": [("env.actions", "box")],
}


@pytest.fixture
def beside(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let agents that are measured play as if this processor were a card."""
    for module in (model, periodic_validation):
        monkeypatch.setattr(module, "device_beside", lambda network: "cpu")


def game(*settings: tuple[str, str]) -> Experiment:
    rules = [("env.lives", "2"), ("env.max_decisions", "300"), ("network.hidden", "[8]")]
    rules += [("ppo.batch_size", "64"), ("env.landing", "false")]
    return load_experiment("quick", [*rules, *settings])


def untrained(experiment: Experiment) -> Any:
    """Return a model of an experiment that does more than to stand still."""
    venv = adapt(make_worlds(experiment, 2))
    made = make_model(experiment, venv)
    with torch.no_grad():
        for parameter in made.policy.parameters():
            parameter.mul_(3.0)
    venv.close()
    return made


@pytest.mark.parametrize("deterministic", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_episodes_on_a_device_are_those_of_arrays(kind: str, deterministic: bool) -> None:
    experiment = game(*KINDS[kind])
    network = untrained(experiment)
    starts = find_starts(experiment, ["comb", "seeds:3-3"])
    seen = []
    played = []
    for device in (None, "cpu"):
        worlds = make_worlds(experiment, 6, device=device)
        policy = ModelPolicy(network, deterministic, seed=4, device=device)

        def told(observations: Any, indices: Any, policy: ModelPolicy = policy) -> Any:
            seen.append(type(observations))
            return policy(observations, indices)

        played.append(play_episodes(worlds, told, range(3), starts, whole_games=False))
        worlds.close()
    assert {*seen} == {np.ndarray, torch.Tensor}
    for name, values in played[0].items():
        assert values.tobytes() == played[1][name].tobytes(), name
    assert played[0]["hits"].any()


def test_a_model_for_other_observations_is_refused() -> None:
    policy = ModelPolicy(untrained(game()), True, 0, "cpu")
    with pytest.raises(SettingsError, match=r"cannot play: it takes observations of shape"):
        policy(torch.zeros(2, 3), np.arange(2))


def test_where_games_are_played_is_no_matter_of_the_environment() -> None:
    """Baselines were given tensors, and failed."""
    with pytest.raises(SettingsError, match=r"'env\.device': 'training\.device' says where"):
        game(("env.device", "cpu"))


def run_out(*arguments: Any, **keywords: Any) -> Any:
    raise torch.OutOfMemoryError("CUDA out of memory. Tried to allocate 2.00 GiB.")


def test_too_little_memory_for_a_training_or_for_its_games_gets_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It ended in torch's error, which names no setting."""
    worlds = make_worlds(game(), 3, device="cpu")
    with pytest.raises(SettingsError, match=r"too little memory for 3 games at once: take fewer"):
        play_episodes(worlds, run_out, range(3))
    monkeypatch.setattr(FastPPO, "train", run_out)
    experiment = small(tmp_path)
    with pytest.raises(SettingsError, match=r"too little memory: take fewer 'training\.worlds'"):
        train(experiment, RunFolder.create(experiment))


def measured(capsys: pytest.CaptureFixture[str]) -> Any:
    """Return what `evaluate` tells of the agent in the package, in a few short games."""
    settings = {
        "evaluation.suites": '["games", "named"]',
        "evaluation.episodes": "3",
        "evaluation.level_episodes": "1",
        "evaluation.baselines": '["ball-follower", "planner"]',
        "evaluation.planner_episodes": "1",
        "env.max_decisions": "60",
    }
    assert cli.main(["evaluate", "--json", *(f"--{k}={text}" for k, text in settings.items())]) == 0
    return json.loads(capsys.readouterr().out)


def test_evaluate_finds_the_same(
    capsys: pytest.CaptureFixture[str], request: pytest.FixtureRequest
) -> None:
    """Agents play on the device; baselines, which are programs for arrays, do not."""
    expected = measured(capsys)
    request.getfixturevalue("beside")
    assert measured(capsys) == expected


def test_validation_finds_the_same(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """Also what it tells of certain policies, for warnings."""
    settings = {"validation.every": "1024", "validation.episodes": "3"}
    settings |= {"validation.levels": '["comb", "ripple"]'}

    def rows(output: Path) -> list[dict[str, float]]:
        experiment = small(output, **settings)
        folder = RunFolder.create(experiment)
        train(experiment, folder)
        kept = [
            {k: v for k, v in row.items() if k[:4] != "time"} for row in read_curve(folder.curve)
        ]
        assert sum("validation/return" in row for row in kept) == 2
        return kept

    expected = rows(tmp_path / "arrays")
    request.getfixturevalue("beside")
    assert rows(tmp_path / "device") == expected
