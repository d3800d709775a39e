"""Networks for browsers say what torch says, about everything that they see in games."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import Experiment
from arkanoid.agents.learn.model import rebuild_network
from arkanoid.agents.learn.portable import file as portable_file
from arkanoid.agents.learn.portable import portable_network
from arkanoid.agents.learn.portable.file import network_file
from arkanoid.agents.learn.portable.recording import Numbers, UnknownOperationError
from arkanoid.agents.learn.training import train
from arkanoid.envs.browser.entries import ENTRIES
from arkanoid.envs.browser.manifest import browser_games, by_tick, make_manifest
from arkanoid.physics.kernels.portable.wasm import make_wasm
from helpers.networks import NativeNetwork
from helpers.node import run_jobs
from helpers.repository import ROOT
from helpers.rounding import LAYERS, Bounded, judge_exactly, within_layer
from helpers.runs import small

DECISIONS = 3000
PLANES = {"env.observation": "grid", "env.landing": "false"}
PICTURES = {"env.observation": "rgb", "env.landing": "false"}
# Networks of all kinds of features, activations and actions.
TRAINED = {
    "tanh": {"network.features": "flat", "network.hidden": "[8]"},
    "elu": {
        "network.features": "flat",
        "network.activation": "elu",
        "network.hidden": "[]",
        "env.actions": "discrete4",
    },
    "silu": {
        "network.features": "flat",
        "network.activation": "silu",
        "network.hidden": "[16, 4, 8]",
    },
    "deep": {"network.features": "flat", "network.hidden": str(9 * [2])},
    "box": {"network.features": "flat", "env.actions": "box", "env.landing": "false"},
    "landing": {"network.features": "landing", "network.activation": "relu", "env.speed": "1.5"},
    "lattice": {"network.features": "lattice", "network.activation": "silu", "env.actions": "box"},
    "planes": {**PLANES, "network.features": "planes", "network.activation": "elu"},
    "flat planes": {**PLANES, "network.features": "flat"},
    "pictures": {
        **PICTURES,
        "network.features": "planes",
        "env.size": "[30, 41]",
        "env.stack": "3",
        "env.actions": "box",
    },
    "nature": {
        **PICTURES,
        "network.features": "nature",
        "env.grey": "true",
        "env.stack": "2",
    },
    "flat pictures": {**PICTURES, "network.features": "flat", "env.size": "12"},
}
PACKAGED = ("lite", "full")
BY_TICK = (*PACKAGED, "pictures")
LENGTHS = {**dict.fromkeys(TRAINED, 300), **dict.fromkeys(PACKAGED, DECISIONS), "nature": 100}
# By tick, an agent sees the same.
JOBS = {
    **{f"{name}: {name}": length for name, length in LENGTHS.items()},
    **{f"{name}: {name} by tick": 4 * LENGTHS[name] for name in BY_TICK},
}


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> dict[str, ModelFile]:
    """Return the packaged models and some of short trainings."""
    found = {name: ModelFile.find(name, False) for name in PACKAGED}
    for name, changes in TRAINED.items():
        settings = {"training.timesteps": "512", **changes}
        found[name] = trained(small(tmp_path_factory.mktemp("run"), **settings))
    return found


def trained(experiment: Experiment) -> ModelFile:
    run = RunFolder.create(experiment)
    train(experiment, run, shows_progress=False)
    return ModelFile.find(str(run.path), False)


@pytest.fixture(scope="module")
def files(models: dict[str, ModelFile]) -> dict[str, bytes]:
    return {name: portable_network(model, model.experiment([])) for name, model in models.items()}


@pytest.fixture(scope="module")
def said(
    models: dict[str, ModelFile], files: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    """Return what each agent saw, what it said, and how its games stand."""
    folder = tmp_path_factory.mktemp("browser")
    games = browser_games()
    for name, model in models.items():
        (folder / f"{name}.network").write_bytes(files[name])
        games[name] = model.experiment([]).config
        if name in BY_TICK:
            games[f"{name} by tick"] = by_tick(games[name])
    (folder / "module.wasm").write_bytes(make_wasm(ENTRIES))
    (folder / "manifest.json").write_text(json.dumps(make_manifest(games)), encoding="utf-8")
    jobs = []
    for key, decisions in JOBS.items():
        name, game = key.split(": ")
        jobs.append({"name": name, "game": game, "decisions": decisions})
    places = folder / "module.wasm", folder / "manifest.json", folder
    script = Path(__file__).with_name("judge.mjs")
    found = run_jobs(script, folder, jobs, ROOT / "envs" / "browser", *places)
    for key in JOBS:
        name, game = key.split(": ")
        seen, spoken = ((folder / f"{name} {game}.{end}").read_bytes() for end in ("seen", "said"))
        header = NativeNetwork.of_file(files[name]).header
        found[key] = found.pop(f"{name} {game}"), *tabulated(header, seen, spoken)
    return found


def tabulated(header: dict[str, Any], seen: bytes, spoken: bytes) -> tuple[Any, Any]:
    """Return what was seen in each decision, and the numbers that were said."""
    sees = header["sees"]
    if sees["kind"] == "rgb":
        shape = sees["pictures"], *sees["size"], sees["channels"]
        shown = np.frombuffer(seen, np.uint8).reshape(-1, *shape)
    else:
        shown = np.frombuffer(seen, "<f4").reshape(-1, sees["inputs"])
    return shown, np.frombuffer(spoken, "<f8").reshape(len(shown), -1)


def as_torch_sees(model: ModelFile, seen: np.ndarray) -> np.ndarray:
    """Return observations [n, ...] of a game, of what was seen there."""
    if seen.ndim == 5:
        count, pictures, height, width, channels = seen.shape
        moved = seen.transpose(0, 1, 4, 2, 3)
        return moved.reshape(count, pictures * channels, height, width)
    return seen.reshape(len(seen), *policy_of(model).observation_space.shape)


def policy_of(model: ModelFile) -> Any:
    return rebuild_network(model, model.experiment([]))


@pytest.mark.parametrize("name", LENGTHS)
def test_it_says_what_this_processors_kernel_says(
    said: dict[str, Any], files: dict[str, bytes], name: str
) -> None:
    """In every bit."""
    _, seen, spoken = said[f"{name}: {name}"]
    network = NativeNetwork.of_file(files[name])
    _, count = network.header["outputs"]
    discrete = network.header["discrete"]
    for shown, numbers in zip(seen, spoken, strict=True):
        judged = network.judge(shown)
        outputs, value, probabilities = np.split(judged, [count, count + 1])
        action = [outputs.argmax()] if discrete else outputs
        expected = [*action, *value, *(probabilities if discrete else ())]
        assert numbers.tolist() == expected


@pytest.mark.parametrize("name", LENGTHS)
def test_it_says_what_torch_says(
    said: dict[str, Any], models: dict[str, ModelFile], files: dict[str, bytes], name: str
) -> None:
    """Both are as near to the exact numbers as rounding allows."""
    _, seen, _ = said[f"{name}: {name}"]
    network, policy = NativeNetwork.of_file(files[name]), policy_of(models[name])
    seen = seen[:300]
    judged = np.array([network.judge(shown) for shown in seen])
    _, count = network.header["outputs"]
    outputs, values, probabilities = np.split(judged, [count, count + 1], axis=1)
    observations = as_torch_sees(models[name], seen).copy()
    with torch.no_grad():
        tensor = torch.from_numpy(observations)
        exact, exact_values = judge_exactly(policy, tensor)
        for found, bounded in ((outputs, exact), (values, exact_values)):
            assert_near(torch.from_numpy(found), bounded)
        latent, critic = policy.mlp_extractor(policy.extract_features(tensor))
        assert_near(policy.action_net(latent), exact)
        assert_near(policy.value_net(critic), exact_values)
    if network.header["discrete"]:
        assert np.abs(probabilities - exact.exact.softmax(1).numpy()).max() < exact.error.max()
        best = exact.exact.topk(2).values
        clear = (best[:, 0] - best[:, 1] > 2.0 * exact.error.amax(1)).numpy()
        expected, _ = policy.predict(observations, deterministic=True)
        assert (outputs.argmax(1) == expected)[clear].all()


def assert_near(found: torch.Tensor, bounded: Bounded) -> None:
    assert ((found - bounded.exact).abs() <= bounded.error).all()


@pytest.mark.parametrize("name", LENGTHS)
def test_each_layer_is_as_exact_as_torchs(
    said: dict[str, Any], models: dict[str, ModelFile], name: str
) -> None:
    """Bounds of whole networks are wide: they add up the worst of each layer."""
    _, seen, _ = said[f"{name}: {name}"]
    policy = policy_of(models[name])
    calls: list[tuple[torch.nn.Module, Numbers, Numbers]] = []
    for module in policy.modules():
        if isinstance(module, LAYERS):
            module.register_forward_hook(
                lambda module, given, result: calls.append((module, *given, result))
            )
    experiment = models[name].experiment([])
    network = NativeNetwork.of_file(network_file(policy, experiment))
    layers = [(module.double(), *numbers) for module, *numbers in calls]
    assert len(layers) == sum(isinstance(module, LAYERS) for module in policy.modules())
    for shown in seen[:20]:
        network.judge(shown)
        for layer, given, result in layers:
            read, written = network.numbers(given), network.numbers(result)
            bounded = within_layer(layer, torch.from_numpy(read[np.newaxis]))
            assert_near(torch.from_numpy(written), bounded)
            assert (bounded.error < 1e-3 * (1.0 + bounded.exact.abs().max())).all()


@pytest.mark.parametrize("name", TRAINED)
def test_it_sees_what_it_saw_in_its_training(
    said: dict[str, Any], models: dict[str, ModelFile], name: str
) -> None:
    """Numbers, planes and stacks of pictures, also those of the next games."""
    _, seen, spoken = said[f"{name}: {name}"]
    experiment = models[name].experiment([])
    game = gym.make(experiment.env_id, **experiment.env)
    discrete = experiment.config.actions != "box"
    observation, _ = game.reset(seed=5)
    for shown, numbers in zip(as_torch_sees(models[name], seen), spoken, strict=True):
        assert shown.tobytes() == observation.tobytes()
        action = int(numbers[0]) if discrete else numbers[:2].astype(np.float32)
        observation, _, terminated, truncated, _ = game.step(action)
        if terminated or truncated:
            observation, _ = game.reset()


@pytest.mark.parametrize("name", BY_TICK)
def test_an_agent_by_tick_sees_and_does_the_same(said: dict[str, Any], name: str) -> None:
    (info, *one), (other_info, *other) = said[f"{name}: {name}"], said[f"{name}: {name} by tick"]
    # Games can end within a decision, so that there are more of them by tick.
    for array, longer in zip(one, other, strict=True):
        assert array.tobytes() == longer[: len(array)].tobytes()
    if name in PACKAGED:
        assert info["score"] == other_info["score"] > 0


def test_by_tick_is_the_same_game(models: dict[str, ModelFile]) -> None:
    config = models["lite"].experiment([]).config
    assert by_tick(config) == replace(config, frame_skip=1, max_decisions=4 * 27_000)


@pytest.mark.parametrize(("name", "game"), [("lite", "full"), ("box", "lite"), ("planes", "full")])
def test_an_agent_of_another_game_is_refused(said: dict[str, Any], name: str, game: str) -> None:
    title = "lite" if name == "lite" else "quick"
    assert said[f"wrong {name}"] == f"{title} was not trained in a game like {game}"


@pytest.mark.parametrize("limit", ["products", "weights"])
def test_networks_that_are_too_large(
    limit: str, models: dict[str, ModelFile], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(portable_file, f"MOST_{limit.upper()}", 5000)
    model = models["lite"]
    message = rf"no browser can play this network: [0-9,]+ {limit} are more than a page"
    with pytest.raises(SettingsError, match=message):
        portable_network(model, model.experiment([]))


def test_an_operation_that_no_browser_knows(models: dict[str, ModelFile]) -> None:
    """It is named, so that one knows what to change."""
    policy = policy_of(models["elu"])
    policy.features_extractor = torch.nn.Softplus()
    with pytest.raises(UnknownOperationError, match="softplus"):
        network_file(policy, models["elu"].experiment([]))
