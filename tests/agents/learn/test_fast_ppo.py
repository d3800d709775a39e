"""`FastPPO` against stable-baselines3: its rollout buffer, its loss and its learning."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from arkanoid.agents.adapter import GymnasiumVecEnv
from arkanoid.agents.learn.networks import LatticeExtractor, PlanesExtractor
from arkanoid.agents.learn.ppo import FastPPO
from arkanoid.agents.learn.ppo.observations import Lattices, Whole
from gymnasium.vector import AutoresetMode
from stable_baselines3 import PPO
from stable_baselines3.common.buffers import RolloutBuffer
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor, NatureCNN
from stable_baselines3.common.utils import obs_as_tensor
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize
from torch import nn

WORLDS, STEPS, BATCH = 6, 48, 96
LATTICE = {"channels": (4, 8), "embedding": 16, "activation": "tanh"}


@pytest.fixture(autouse=True)
def one_thread() -> Iterator[None]:
    """Networks this small wait for threads longer than they compute."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


class Recording(GymnasiumVecEnv):
    """Keeps copies of all that its steps took and gave."""

    def reset(self) -> Any:
        self.seen = [super().reset()]
        self.taken: list[Any] = []
        self.given: list[Any] = []
        return self.seen[0].copy()

    def step_batch(self, actions: Any) -> Any:
        observations, rewards, dones, ended = super().step_batch(actions)
        self.seen.append(np.array(observations))
        self.taken.append(np.array(actions))
        self.given.append((np.array(rewards, np.float32), dones.copy(), ended))
        return observations, rewards, dones, ended


class Sums(BaseFeaturesExtractor):
    """The observation, and two numbers that are made of it."""

    def __init__(self, observation_space: gym.spaces.Box) -> None:
        super().__init__(observation_space, observation_space.shape[0] + 2)

    def forward(self, observations: torch.Tensor) -> torch.Tensor:
        return torch.cat([observations, self.extra(observations)], 1)

    def extra(self, observations: torch.Tensor) -> torch.Tensor:
        return torch.stack([observations.sum(1) / 500, observations[:, :9].prod(1)], 1)


def arkanoid(**keywords: Any) -> Recording:
    # Episodes end by lost balls and by the limit.
    keywords = {"copy": False, "max_decisions": 13, "frame_skip": 6, "lives": 1, **keywords}
    name = keywords.pop("name", "Arkanoid-v0")
    worlds = gym.make_vec(f"arkanoid:{name}", WORLDS, autoreset_mode="SameStep", **keywords)
    return Recording(worlds, ["score"], ["hits"])


def classic(name: str) -> Recording:
    mode = {"autoreset_mode": AutoresetMode.SAME_STEP, "copy": False}
    worlds = gym.make_vec(
        name, WORLDS, vectorization_mode="sync", vector_kwargs=mode, max_episode_steps=20
    )
    return Recording(worlds)


RGB = {"observation": "rgb", "size": 48}
CASES: dict[str, tuple[Any, dict[str, Any], type]] = {
    "bricks": (arkanoid, {"net_arch": [32, 16], "activation_fn": nn.ReLU}, Lattices),
    "bricks, tanh": (arkanoid, {"net_arch": [32]}, Lattices),
    "bricks, no layers": (arkanoid, {"net_arch": []}, Lattices),
    "bricks, two shapes": (arkanoid, {"net_arch": {"pi": [8], "vf": [32, 8, 8]}}, Lattices),
    "bricks, lite": (lambda: arkanoid(name="ArkanoidLite-v0"), {"net_arch": [16]}, Lattices),
    "bricks, extra": (arkanoid, {"features_extractor_class": Sums}, Lattices),
    "bricks, reals": (lambda: arkanoid(actions="box"), {"net_arch": [16, 16]}, Lattices),
    "lattice": (
        arkanoid,
        {
            "features_extractor_class": LatticeExtractor,
            "features_extractor_kwargs": {"bricks": (28, 226), **LATTICE},
        },
        Whole,
    ),
    "two extractors": (
        arkanoid,
        {
            "features_extractor_class": LatticeExtractor,
            "features_extractor_kwargs": {"bricks": (28, 226), **LATTICE},
            "share_features_extractor": False,
        },
        Whole,
    ),
    "planes": (
        lambda: arkanoid(observation="grid"),
        {"features_extractor_class": PlanesExtractor, "features_extractor_kwargs": LATTICE},
        Whole,
    ),
    "pixels": (
        lambda: arkanoid(**RGB),
        {"features_extractor_class": NatureCNN, "features_extractor_kwargs": {"features_dim": 16}},
        Whole,
    ),
    "cart": (lambda: classic("CartPole-v1"), {"net_arch": [16]}, Whole),
    "pendulum": (lambda: classic("Pendulum-v1"), {"net_arch": [16], "log_std_init": -0.5}, Whole),
}


def model_of(case: str, **keywords: Any) -> tuple[FastPPO, Recording]:
    """Return a model that has collected a rollout, and its environment."""
    make, policy_kwargs, kind = CASES[case]
    venv = make()
    policy = "CnnPolicy" if case == "pixels" else "MlpPolicy"
    arguments = {"n_steps": STEPS, "batch_size": BATCH, "n_epochs": 1, "seed": 3, "device": "cpu"}
    model = FastPPO(policy, venv, policy_kwargs=policy_kwargs, **{**arguments, **keywords})
    _, callback = model._setup_learn(10**6)
    assert model.collect_rollouts(model.env, callback, model.rollout_buffer, STEPS)
    assert type(model.rollout._observations) is kind  # type: ignore[union-attr]
    return model, venv


def in_order(model: FastPPO, name: str) -> torch.Tensor:
    """Return one of the minibatches' attributes as [steps, worlds, ...]."""
    assert model.rollout is not None
    with torch.no_grad():
        batches = list(model.rollout.minibatches())
    values = torch.cat([getattr(batch, name) for batch in batches])
    places = torch.cat([batch.decisions for batch in batches])
    assert sorted(places.tolist()) == list(range(STEPS * WORLDS))
    assert {len(batch.decisions) for batch in batches} == {BATCH}
    return values[places.argsort()].view(STEPS, WORLDS, *values.shape[1:])


@pytest.mark.parametrize("case", CASES)
def test_a_rollout_is_what_the_buffer_of_stable_baselines3_would_hold(case: str) -> None:
    model, venv = model_of(case, gamma=0.9, gae_lambda=0.8)
    policy = model.policy
    buffer = RolloutBuffer(
        STEPS, venv.observation_space, venv.action_space, "cpu", 0.8, 0.9, WORLDS
    )
    actions = in_order(model, "actions")
    starts, cut = np.ones(WORLDS, bool), 0
    for step in range(STEPS):
        rewards, dones, infos = venv.given[step]
        observations = obs_as_tensor(venv.seen[step], "cpu")
        with torch.no_grad():
            values, log_prob, _ = policy.evaluate_actions(observations, actions[step])
            for world, info in infos.items():
                if info["TimeLimit.truncated"]:
                    cut += 1
                    last = torch.as_tensor(info["terminal_observation"])[None]
                    rewards[world] += 0.9 * policy.predict_values(last).item()
        shaped = actions[step].numpy().reshape(WORLDS, -1)
        buffer.add(venv.seen[step], shaped, rewards, starts, values, log_prob)
        starts = dones
    with torch.no_grad():
        last = policy.predict_values(obs_as_tensor(venv.seen[STEPS], "cpu"))
    buffer.compute_returns_and_advantage(last, starts)
    assert cut
    for name, expected in (
        ("old_log_prob", buffer.log_probs),
        ("old_values", buffer.values),
        ("advantages", buffer.advantages),
        ("returns", buffer.returns),
    ):
        np.testing.assert_allclose(in_order(model, name), expected, rtol=2e-4, atol=2e-5)
    # What the environment got: the very actions, within bounds.
    taken = actions.numpy()
    if isinstance(venv.action_space, gym.spaces.Box):
        taken = np.clip(taken, venv.action_space.low, venv.action_space.high)
    np.testing.assert_array_equal(taken, np.stack(venv.taken))


def sb3_loss(model: PPO, observations: Any, batch: Any) -> torch.Tensor:
    """The loss of `PPO.train`, line by line."""
    clip = model.clip_range(1.0)
    values, log_prob, entropy = model.policy.evaluate_actions(observations, batch.actions)
    values = values.flatten()
    advantages = batch.advantages
    if model.normalize_advantage:
        advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
    ratio = torch.exp(log_prob - batch.old_log_prob)
    policy_loss_1 = advantages * ratio
    policy_loss_2 = advantages * torch.clamp(ratio, 1 - clip, 1 + clip)
    policy_loss = -torch.min(policy_loss_1, policy_loss_2).mean()
    if model.clip_range_vf is not None:
        most = model.clip_range_vf(1.0)
        values = batch.old_values + torch.clamp(values - batch.old_values, -most, most)
    value_loss = torch.nn.functional.mse_loss(batch.returns, values)
    assert entropy is not None
    return policy_loss - model.ent_coef * entropy.mean() + model.vf_coef * value_loss


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(
    "options",
    [
        {"ent_coef": 0.01, "clip_range": 0.05},
        {"clip_range_vf": 0.3, "vf_coef": 0.7, "clip_range": 0.1, "normalize_advantage": False},
    ],
)
def test_gradients_are_those_of_the_loss_of_stable_baselines3(
    case: str, options: dict[str, Any]
) -> None:
    model, venv = model_of(case, **options)
    assert model.rollout is not None
    policy = model.policy
    torch.manual_seed(1)
    with torch.no_grad():
        # Otherwise all ratios would be one, and nothing would be clipped.
        for weight in policy.parameters():
            weight += 0.1 * torch.randn_like(weight)
    seen = torch.as_tensor(np.stack(venv.seen[:STEPS])).flatten(0, 1)
    count, clipped = 0, 0.0
    for batch in model.rollout.minibatches():
        policy.optimizer.zero_grad()
        loss, parts, _ = model.loss(batch)
        loss.backward()
        got = [weight.grad.clone() for weight in policy.parameters()]  # type: ignore[union-attr]
        policy.optimizer.zero_grad()
        expected = sb3_loss(model, seen[batch.decisions], batch)
        expected.backward()
        torch.testing.assert_close(loss, expected, rtol=1e-4, atol=1e-6)
        for mine, weight in zip(got, policy.parameters(), strict=True):
            assert weight.grad is not None
            scale = max(float(weight.grad.abs().max()), 1e-3)
            assert float((mine - weight.grad).abs().max()) < 1e-4 * scale
        clipped += float(parts[3])
        count += 1
    assert count == STEPS * WORLDS // BATCH
    assert 0 < clipped < count


def test_an_update_is_that_of_stable_baselines3_with_the_same_minibatch() -> None:
    """One minibatch has everything in it, so its order does not matter."""
    model, venv = model_of("bricks", batch_size=STEPS * WORLDS, n_epochs=3, max_grad_norm=0.1)
    seen = np.stack(venv.seen[:STEPS])
    twin = PPO(
        "MlpPolicy", venv, n_steps=STEPS, batch_size=STEPS * WORLDS, n_epochs=3, device="cpu",
        max_grad_norm=0.1, policy_kwargs=CASES["bricks"][1],
    )  # fmt: skip
    twin.policy.load_state_dict(model.policy.state_dict())
    twin._setup_learn(10**6)
    buffer = twin.rollout_buffer
    batch = next(iter(model.rollout.minibatches()))  # type: ignore[union-attr]
    order = batch.decisions.argsort()

    def fill(values: torch.Tensor) -> np.ndarray[Any, Any]:
        return values.detach()[order].view(STEPS, WORLDS).numpy()

    buffer.observations[:] = seen
    buffer.actions[:] = fill(batch.actions)[..., None]
    buffer.log_probs[:], buffer.values[:] = fill(batch.old_log_prob), fill(batch.old_values)
    buffer.advantages[:], buffer.returns[:] = fill(batch.advantages), fill(batch.returns)
    buffer.full = True
    model.train()
    twin.train()
    for mine, other in zip(model.policy.parameters(), twin.policy.parameters(), strict=True):
        torch.testing.assert_close(mine, other, rtol=1e-3, atol=1e-5)
    ours, theirs = model.logger.name_to_value, twin.logger.name_to_value
    assert ours.keys() == theirs.keys()
    for name in theirs:
        assert ours[name] == pytest.approx(theirs[name], rel=2e-3, abs=1e-5), name


class Steps(BaseCallback):
    """Notes what it is told, and stops after ``most`` steps."""

    def __init__(self, most: int) -> None:
        super().__init__()
        self.most, self.told = most, []  # type: ignore[var-annotated]

    def _on_rollout_start(self) -> None:
        self.told.append("start")

    def _on_rollout_end(self) -> None:
        self.told.append("end")

    def _on_step(self) -> bool:
        assert {"infos", "dones", "rewards", "actions", "new_obs"} <= self.locals.keys()
        assert len(self.locals["infos"]) == WORLDS
        self.told.append(self.num_timesteps)
        return self.n_calls < self.most


def test_callbacks_are_told_and_stop_it_as_in_stable_baselines3() -> None:
    told = []
    for trainer in (FastPPO, PPO):
        callback = Steps(5)
        model = trainer("MlpPolicy", classic("CartPole-v1"), 4, n_steps=4, batch_size=8, seed=0)
        model.learn(1000, callback)
        told.append((callback.told, model.num_timesteps, model._n_updates))
    assert told[0] == told[1]


@pytest.mark.parametrize("worlds", ["native", "wrapped", "dummy"])
def test_it_trains_on_every_vector_environment(worlds: str) -> None:
    venv: Any = classic("CartPole-v1")
    if worlds == "wrapped":
        venv = VecNormalize(venv)
    if worlds == "dummy":
        venv = DummyVecEnv([lambda: gym.make("arkanoid:ArkanoidLite-v0", max_decisions=20)] * 2)
    model = FastPPO("MlpPolicy", venv, n_steps=32, batch_size=32, device="cpu", seed=0)
    model.learn(400)
    assert model.rollout is not None
    assert model.ep_info_buffer or worlds == "dummy"


def test_it_learns_to_balance_a_pole() -> None:
    mode = {"autoreset_mode": AutoresetMode.SAME_STEP}
    worlds = gym.make_vec("CartPole-v1", 8, vectorization_mode="sync", vector_kwargs=mode)
    model = FastPPO(
        "MlpPolicy", GymnasiumVecEnv(worlds), 1e-3, n_steps=64, batch_size=128, n_epochs=10,
        gamma=0.98, gae_lambda=0.9, seed=1, device="cpu",
    )  # fmt: skip
    model.learn(20_000)
    assert model.ep_info_buffer
    # A random policy holds it for 22 steps.
    assert np.mean([episode["l"] for episode in list(model.ep_info_buffer)[-20:]]) > 100


def test_a_large_divergence_ends_the_update_early() -> None:
    model, _ = model_of("cart", target_kl=1e-9, n_epochs=5, learning_rate=0.01)
    model.train()
    assert model._n_updates == 1
    patient, _ = model_of("cart", target_kl=1e9, n_epochs=5)
    patient.train()
    assert patient._n_updates == 5


@pytest.mark.parametrize("case", ["bricks", "pendulum"])
def test_stable_baselines3_loads_what_it_saves(case: str, tmp_path: Path) -> None:
    model, venv = model_of(case)
    model.train()
    model.save(tmp_path / "model")
    for trainer in (PPO, FastPPO):
        loaded = trainer.load(tmp_path / "model", device="cpu")
        for deterministic in (True, False):
            expected, got = [], []
            for each, actions in ((model, expected), (loaded, got)):
                torch.manual_seed(0)
                actions.append(each.predict(venv.seen[7], deterministic=deterministic)[0])
            np.testing.assert_array_equal(got, expected)
        loaded.set_env(venv)
        loaded.learn(STEPS * WORLDS, reset_num_timesteps=False)
