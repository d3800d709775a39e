"""Networks for browsers say what torch says, about everything that they see in games."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import Experiment
from arkanoid.agents.learn.model import rebuild_network
from arkanoid.agents.learn.portable import portable_network
from arkanoid.agents.learn.training import train
from arkanoid.envs.browser.entries import ENTRIES
from arkanoid.envs.browser.manifest import browser_games, by_tick, make_manifest
from arkanoid.physics.kernels.portable.wasm import make_wasm
from helpers.node import run_jobs
from helpers.repository import ROOT
from helpers.runs import small

DECISIONS = 3000
NEAR = 1e-5
# Further networks: their activations, hidden layers and games.
TRAINED = {
    "tanh": {"network.hidden": "[8]"},
    "elu": {"network.hidden": "[]", "env.actions": "discrete4"},
    "silu": {"network.hidden": "[16, 4, 8]", "env.landing": "true"},
}
PACKAGED = ("lite", "full")
# By tick, an agent sees the same.
JOBS = {
    **{f"{name} {name}": DECISIONS for name in PACKAGED},
    **{f"{name} {name} by tick": 4 * DECISIONS for name in PACKAGED},
    **{f"{name} {name}": 300 for name in TRAINED},
}


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> dict[str, ModelFile]:
    """Return the packaged models and some of short trainings."""
    found = {name: ModelFile.find(name, False) for name in PACKAGED}
    for name, changes in TRAINED.items():
        settings = {"network.features": "flat", "network.activation": name, **changes}
        found[name] = trained(small(tmp_path_factory.mktemp(name), **settings))
    return found


def trained(experiment: Experiment) -> ModelFile:
    run = RunFolder.create(experiment)
    train(experiment, run, shows_progress=False)
    return ModelFile.find(str(run.path), False)


@pytest.fixture(scope="module")
def said(models: dict[str, ModelFile], tmp_path_factory: pytest.TempPathFactory) -> dict:
    """Return what each agent saw, what it said, and how its games stand."""
    folder = tmp_path_factory.mktemp("browser")
    games = browser_games()
    for name, model in models.items():
        experiment = model.experiment([])
        (folder / f"{name}.network").write_bytes(portable_network(model, experiment))
        if name in TRAINED:
            games[name] = experiment.config
    (folder / "module.wasm").write_bytes(make_wasm(ENTRIES))
    (folder / "manifest.json").write_text(json.dumps(make_manifest(games)), encoding="utf-8")
    jobs = []
    for key, decisions in JOBS.items():
        name, _, game = key.partition(" ")
        jobs.append({"name": name, "game": game, "decisions": decisions})
    files = folder / "module.wasm", folder / "manifest.json", folder
    script = Path(__file__).with_name("judge.mjs")
    found = run_jobs(script, folder, jobs, ROOT / "envs" / "browser", *files)
    for key in JOBS:
        found[key] = [
            found[key],
            np.fromfile(folder / f"{key}.seen", np.float32),
            np.fromfile(folder / f"{key}.said", np.float64),
        ]
    return found


@pytest.mark.parametrize("key", [key for key in JOBS if "tick" not in key])
def test_it_says_what_torch_says(said: dict, models: dict[str, ModelFile], key: str) -> None:
    _, seen, spoken = said[key]
    model = models[key.partition(" ")[0]]
    policy = rebuild_network(model, model.experiment([]))
    seen = seen.reshape(JOBS[key], -1)
    actions, values, probabilities = np.split(spoken.reshape(JOBS[key], -1), [1, 2], axis=1)
    with torch.no_grad():
        observations = torch.from_numpy(seen)
        expected = policy.get_distribution(observations).distribution.probs.numpy()
        assert np.abs(probabilities - expected).max() < NEAR
        expected = policy.predict_values(observations).numpy()
        assert np.abs(values - expected).max() < NEAR * max(1.0, np.abs(expected).max())
    expected, _ = policy.predict(seen, deterministic=True)
    assert (actions[:, 0] == expected).all()


@pytest.mark.parametrize("name", PACKAGED)
def test_an_agent_by_tick_sees_and_does_the_same(said: dict, name: str) -> None:
    (info, *one), (other_info, *other) = said[f"{name} {name}"], said[f"{name} {name} by tick"]
    assert [array.tobytes() for array in one] == [array.tobytes() for array in other]
    assert info["score"] == other_info["score"] > 0


def test_by_tick_is_the_same_game(models: dict[str, ModelFile]) -> None:
    config = models["lite"].experiment([]).config
    assert by_tick(config) == replace(config, frame_skip=1, max_decisions=4 * 27_000)


def test_an_agent_of_another_game_is_refused(said: dict) -> None:
    assert said["wrong"] == "lite was not trained in a game like full"


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"network.features": "lattice"}, r"'network.features' is 'lattice' and not 'flat'"),
        ({"env.observation": "grid", "env.landing": "false"}, "it sees 'grid' and not 'vector'"),
        ({"env.actions": "box"}, "its actions are 'box', and not discrete"),
        ({"network.hidden": "[4, 4, 4, 4, 4, 4, 4, 4]"}, "it has more than 7 hidden layers"),
    ],
    ids=lambda value: None if isinstance(value, str) else "".join(value),
)
def test_networks_that_no_browser_can_play(
    changes: dict[str, str], reason: str, tmp_path: Path
) -> None:
    features = {"network.features": "auto" if "env.observation" in changes else "flat"}
    model = trained(small(tmp_path, **{"training.timesteps": "512", **features, **changes}))
    with pytest.raises(SettingsError, match=f"no browser can play this network: {reason}"):
        portable_network(model, model.experiment([]))
