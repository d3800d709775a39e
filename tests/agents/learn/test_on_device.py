"""Rollouts and updates on a device, here this processor, against stable-baselines3's own."""

import json
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from arkanoid.agents import cli
from arkanoid.agents.adapter import GymnasiumVecEnv
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn import playing, training
from arkanoid.agents.learn.curves import read_curve
from arkanoid.agents.learn.model import make_model
from arkanoid.agents.learn.playing import device_beside, find_device, worlds_device
from arkanoid.agents.learn.ppo import FastPPO
from arkanoid.agents.learn.search import speed
from arkanoid.agents.tensor_adapter import TensorVecEnv
from arkanoid.envs import tensor_vector_env
from helpers.runs import SMALL, small
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

WORLDS, STEPS = 6, 40
KEYWORDS = (["score"], ["hits"])
# Episodes end by lost balls and by the limit, some of them in each rollout.
GAME: dict[str, Any] = {"copy": False, "max_decisions": 13, "frame_skip": 6, "lives": 1}
KINDS: dict[str, dict[str, Any]] = {
    "vector": {"landing": True},
    "grid": {"observation": "grid"},
    "pixels": {"observation": "rgb", "size": 48, "stack": 2},
    "reals": {"actions": "box"},
}


def worlds(kind: str, **more: Any) -> Any:
    keywords = {**GAME, **KINDS[kind], **more}
    return gym.make_vec("arkanoid:Arkanoid-v0", WORLDS, autoreset_mode="SameStep", **keywords)


def trainer(kind: str, env: Any, **settings: Any) -> FastPPO:
    policy = "CnnPolicy" if kind == "pixels" else "MlpPolicy"
    layers = {"net_arch": [16, 8]}
    fixed = {"n_steps": STEPS, "batch_size": 60, "seed": 5, "device": "cpu"}
    settings = {**fixed, "policy_kwargs": layers, **settings}
    return FastPPO(policy, env, **settings)


class Stop(BaseCallback):
    """Asks for the end in the first rollout, and counts calls."""

    def __init__(self) -> None:
        super().__init__()
        self.shapes: list[tuple[int, ...]] = []

    def _on_step(self) -> bool:
        self.shapes.append(tuple(self.locals["actions"].shape))
        return False


def fill(model: PPO, env: GymnasiumVecEnv, actions: Any) -> tuple[Any, list[Any]]:
    """Play given actions as stable-baselines3 does; return its buffer, and what ended."""
    buffer = model.rollout_buffer
    buffer.reset()
    seen: Any = env.reset()
    starts, ended = np.ones(WORLDS, np.bool_), []
    for chosen in actions:
        observations = torch.as_tensor(np.array(seen))
        with torch.no_grad():
            values, log_prob, _ = model.policy.evaluate_actions(observations, chosen)
        limits: Any = model.action_space
        taken = chosen.numpy()
        if isinstance(limits, gym.spaces.Box):
            taken = np.clip(taken, limits.low, limits.high)
        before = np.array(seen)
        seen, rewards, dones, infos = env.step(taken)
        for world in np.flatnonzero(dones):
            ended.append(infos[world]["episode"])
            if infos[world]["TimeLimit.truncated"]:
                last = torch.as_tensor(infos[world]["terminal_observation"]).unsqueeze(0)
                with torch.no_grad():
                    rewards[world] += model.gamma * model.policy.predict_values(last).item()
        kept = taken.reshape(WORLDS, -1) if not isinstance(limits, gym.spaces.Box) else chosen
        buffer.add(before, np.asarray(kept), rewards, starts, values, log_prob)
        starts = dones
    with torch.no_grad():
        last_values = model.policy.predict_values(torch.as_tensor(np.array(seen)))
    buffer.compute_returns_and_advantage(last_values, starts)
    return buffer, ended


@pytest.mark.parametrize("kind", KINDS)
def test_a_rollout_and_its_update_are_those_of_stable_baselines3(kind: str) -> None:
    """Returns, episodes and, after one gradient step, all weights."""
    settings: dict[str, Any] = {"batch_size": STEPS * WORLDS, "n_epochs": 1, "ent_coef": 0.01}
    model = trainer(kind, TensorVecEnv(worlds(kind, device="cpu"), *KEYWORDS), **settings)
    weights = deepcopy(model.policy.state_dict())
    model.learn(STEPS * WORLDS)
    loop = model._loop
    assert loop is not None
    policy = "CnnPolicy" if kind == "pixels" else "MlpPolicy"
    env = GymnasiumVecEnv(worlds(kind), *KEYWORDS)
    layers = {"net_arch": [16, 8]}
    plain = PPO(policy, env, n_steps=STEPS, seed=5, device="cpu", policy_kwargs=layers, **settings)
    plain.policy.load_state_dict(weights)
    env.seed(5)
    buffer, ended = fill(plain, env, loop.actions)
    assert np.allclose(loop.returns.numpy(), buffer.returns, atol=1e-4)
    assert np.allclose(loop.values.numpy(), buffer.values, atol=1e-4)
    told: Any = model.ep_info_buffer
    assert len(ended) > WORLDS
    for key in ("r", "l", "score", "hits"):
        assert np.allclose([e[key] for e in told], [e[key] for e in ended][-len(told) :]), key
    plain._logger = model.logger
    plain.train()
    for name, weight in plain.policy.state_dict().items():
        assert torch.allclose(model.policy.state_dict()[name], weight, atol=2e-5), name


def test_a_callback_sees_a_rollout_as_one_step_and_may_end_the_training() -> None:
    """The update that follows is still made, so that nothing played is lost."""
    model = trainer("vector", TensorVecEnv(worlds("vector", device="cpu"), *KEYWORDS))
    before = deepcopy(model.policy.state_dict())
    stop = Stop()
    model.learn(10 * STEPS * WORLDS, callback=stop)
    assert stop.shapes == [(STEPS, WORLDS)]
    assert model.num_timesteps == STEPS * WORLDS
    assert any((before[name] != now).any() for name, now in model.policy.state_dict().items())


def test_a_training_that_was_stopped_at_its_end_may_go_on() -> None:
    """The next one ended at once: it took the stop for its own."""
    model = trainer("vector", TensorVecEnv(worlds("vector", device="cpu"), *KEYWORDS))
    model.learn(STEPS * WORLDS, callback=Stop())
    model.learn(STEPS * WORLDS)
    assert model.num_timesteps == STEPS * WORLDS
    assert model._n_updates == 2 * model.n_epochs


def test_an_update_follows_the_rollout_that_was_played_last() -> None:
    """After games on a device, a training with arrays learned from the device's last rollout."""
    model = trainer("vector", TensorVecEnv(worlds("vector", device="cpu"), *KEYWORDS))
    model.learn(STEPS * WORLDS)
    other = trainer("vector", GymnasiumVecEnv(worlds("vector"), *KEYWORDS))
    other.policy.load_state_dict(model.policy.state_dict())
    other.policy.optimizer.load_state_dict(deepcopy(model.policy.optimizer.state_dict()))
    for each in (model, other):
        each.set_env(GymnasiumVecEnv(worlds("vector"), *KEYWORDS))
        each.set_random_seed(7)
        each.learn(STEPS * WORLDS)
    for weight, wanted in zip(model.policy.parameters(), other.policy.parameters(), strict=True):
        assert torch.equal(weight, wanted)


def test_the_length_of_rollouts_may_change_between_trainings() -> None:
    """The loop went on with the old one, and counted with the new."""
    model = trainer("vector", TensorVecEnv(worlds("vector", device="cpu"), *KEYWORDS))
    model.learn(STEPS * WORLDS)
    model.n_steps = 10
    model.learn(10 * WORLDS)
    assert model._loop is not None
    assert model._loop.actions.shape == (10, WORLDS)


def test_a_divergence_beyond_the_target_ends_an_update() -> None:
    settings: dict[str, Any] = {"learning_rate": 0.1, "target_kl": 1e-3, "n_epochs": 20}
    model = trainer("vector", TensorVecEnv(worlds("vector", device="cpu"), *KEYWORDS), **settings)
    model.learn(STEPS * WORLDS)
    assert model._n_updates < 20


def test_weights_that_are_frozen_between_trainings_stay() -> None:
    """The second training ended in an error of torch: it asked for gradients of all weights."""
    model = trainer("vector", TensorVecEnv(worlds("vector", device="cpu"), *KEYWORDS))
    model.learn(STEPS * WORLDS)
    layers = list(model.policy.mlp_extractor.parameters())
    for frozen in (True, False):
        for parameter in layers:
            parameter.requires_grad_(not frozen)
        before = [parameter.clone() for parameter in model.policy.parameters()]
        model.learn(STEPS * WORLDS)
        for parameter, old in zip(model.policy.parameters(), before, strict=True):
            assert torch.equal(parameter, old) != parameter.requires_grad


def test_what_the_loops_do_not_know_is_refused() -> None:
    env = TensorVecEnv(worlds("vector", observation="dict", landing=False, device="cpu"))
    model = FastPPO("MultiInputPolicy", env, n_steps=STEPS, batch_size=60, device="cpu")
    with pytest.raises(ValueError, match="can't train on a device: it knows no observations of"):
        model.learn(STEPS * WORLDS)
    with pytest.raises(NotImplementedError, match="without device"):
        env.step(np.zeros(WORLDS, np.int64))


@pytest.fixture
def on_device(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(training, "worlds_device", lambda experiment: "cpu")


def settle(output: Path, timesteps: int) -> RunFolder:
    settings = {
        **SMALL,
        "training.timesteps": str(timesteps),
        "ppo.schedule": "constant",
        "output": str(output),
    }
    assert cli.main(["train", "quick", *(f"--{key}={text}" for key, text in settings.items())]) == 0
    (path,) = output.iterdir()
    return RunFolder(path)


@pytest.mark.usefixtures("on_device")
def test_a_training_on_a_device_resumes_bit_for_bit(tmp_path: Path) -> None:
    """Its random numbers come from those of the processor, which a checkpoint keeps."""
    whole = settle(tmp_path / "whole", 2048)
    part = settle(tmp_path / "part", 1024)
    # As if it had been stopped there.
    text = part.config.read_text().replace("timesteps = 1024", "timesteps = 2048")
    part.config.write_text(text)
    notes = part.read_notes()
    (part.path / "run.json").write_text(json.dumps({**notes, "outcome": "interrupted"}))
    assert cli.main(["train", "--resume", str(part.path)]) == 0
    assert part.read_notes()["weights"] == whole.read_notes()["weights"]
    clock = ("time/fps", "time/time_elapsed", "time/iterations")
    curves = [
        [{key: value for key, value in row.items() if key not in clock} for row in read_curve(each)]
        for each in (whole.curve, part.curve)
    ]
    assert curves[0] == curves[1]


def test_a_search_measures_the_speed_of_games_where_they_will_be_played(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """It measured a training with games on the processor."""
    envs: list[Any] = []

    def make(experiment: Experiment, env: Any) -> PPO:
        envs.append(env)
        return make_model(experiment, env)

    monkeypatch.setattr(speed, "worlds_device", lambda experiment: "cpu")
    monkeypatch.setattr(speed, "make_model", make)
    assert speed.measure_speed(small(tmp_path), 0.01) > 0
    assert isinstance(envs[0], TensorVecEnv)


@pytest.fixture
def card(monkeypatch: pytest.MonkeyPatch) -> Callable[[int, int], None]:
    """Pretend that there is a card with all that games need; return what sets its capability."""

    def has_capability(*capability: int) -> None:
        monkeypatch.setattr(torch.cuda, "get_device_capability", lambda device: capability)

    monkeypatch.setattr(torch.version, "cuda", "13.0")
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 1)
    monkeypatch.setattr(torch.cuda, "get_device_name", lambda device: "Tesla T4")
    monkeypatch.setattr(tensor_vector_env, "cuda_core", lambda: None)
    playing._tell.cache_clear()
    has_capability(9, 0)
    return has_capability


@pytest.mark.usefixtures("card")
def test_worlds_are_on_a_card_where_the_trainer_can_use_them(tmp_path: Path) -> None:
    assert worlds_device(small(tmp_path)) is None
    assert worlds_device(small(tmp_path, **{"training.device": "auto"})) == "cuda"
    for key, value in (("training.trainer", "sb3"), ("curriculum.sampling", "value_loss")):
        there = {"training.device": "cuda", key: value}
        experiment = small(tmp_path, **there)
        assert worlds_device(experiment) is None, key
        assert device_beside(find_device("cuda")) == "cuda", key
    assert load_experiment("quick", []).training.device == "cpu"


def test_a_card_that_can_only_compute_leaves_the_games_to_the_processor(
    card: Callable[[int, int], None],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A training whose network could be on such a card was refused."""
    experiment = small(tmp_path, **{"training.device": "cuda"})
    card(7, 5)
    assert [worlds_device(experiment) for _ in range(3)] == [None] * 3
    assert capsys.readouterr().err.splitlines() == [
        "arkanoid: the games are played by the processor: Tesla T4 is too old: the game's kernels "
        "need compute capability 8.0 (Ampere, 2020)"
    ]
    card(8, 0)

    def missing() -> None:
        raise ImportError('pip install "arkanoid[gpu]" brings it')

    monkeypatch.setattr(tensor_vector_env, "cuda_core", missing)
    assert worlds_device(experiment) is None
    assert 'pip install "arkanoid[gpu]"' in capsys.readouterr().err


def test_a_driver_that_refuses_is_no_mistake_in_the_table_of_the_environment(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The message was that the environment refuses the [env] table."""

    def refuse(*arguments: Any, **keywords: Any) -> None:
        raise RuntimeError("the graphics card 0 refuses the game's kernels")

    monkeypatch.setattr(tensor_vector_env.ArkanoidTensorVectorEnv, "__init__", refuse)
    with pytest.raises(SettingsError, match=r"^no games on cpu: the graphics card 0 refuses"):
        make_worlds(small(tmp_path), 2, device="cpu")
