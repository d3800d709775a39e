"""`FastPPO` on what few train: what it leaves to stable-baselines3, and frozen weights."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from arkanoid.agents.learn.ppo import FastPPO
from stable_baselines3 import PPO


class Counting(gym.Env[Any, Any]):
    """Has spaces that the fast loops do not know."""

    observation_space = gym.spaces.Box(0, 1, (2,), np.float32)

    def __init__(self, kind: str) -> None:
        self.action_space = gym.spaces.Discrete(2) if kind == "dict" else gym.spaces.MultiBinary(2)
        if kind == "dict":
            self.observation_space = gym.spaces.Dict({"a": Counting.observation_space})  # type: ignore[assignment]

    def _observation(self) -> Any:
        zeros = np.zeros(2, np.float32)
        return {"a": zeros} if isinstance(self.observation_space, gym.spaces.Dict) else zeros

    def reset(self, *, seed: int | None = None, options: Any = None) -> Any:
        return self._observation(), {}

    def step(self, action: Any) -> Any:
        return self._observation(), 0.0, True, False, {}


@pytest.mark.parametrize(
    ("kind", "word"), [("dict", "several parts"), ("multi", "MultiBinary"), ("sde", "exploration")]
)
def test_what_it_does_not_know_takes_the_other_way_and_it_says_so(kind: str, word: str) -> None:
    policy = "MultiInputPolicy" if kind == "dict" else "MlpPolicy"
    models = []
    for trainer in (FastPPO, PPO):
        env = gym.make("Pendulum-v1") if kind == "sde" else Counting(kind)
        model = trainer(
            policy, env, n_steps=16, batch_size=16, n_epochs=1, use_sde=kind == "sde", seed=0,
            device="cpu", policy_kwargs={"optimizer_kwargs": {"eps": 1e-5}},
        )  # fmt: skip
        models.append(model)
    models[0].set_random_seed(0)
    with pytest.warns(UserWarning, match=word) as warned:
        models[0].learn(32)
    assert len(warned) == 1
    models[1].set_random_seed(0)
    models[1].learn(32)
    for mine, other in zip(*(model.policy.parameters() for model in models), strict=True):
        torch.testing.assert_close(mine, other, rtol=0, atol=0)


def test_weights_that_are_frozen_between_trainings_stay() -> None:
    """They went on: their gradients of the last update were left, and the optimiser took them.

    Freezing all but the last layers after a first training is how a model is fine-tuned.
    """
    model = FastPPO("MlpPolicy", "CartPole-v1", n_steps=32, batch_size=32, seed=0, device="cpu")
    model.learn(32)
    frozen = list(model.policy.mlp_extractor.parameters())
    for parameter in frozen:
        parameter.requires_grad_(False)
    before = [parameter.clone() for parameter in model.policy.parameters()]
    model.learn(32)
    for parameter, old in zip(model.policy.parameters(), before, strict=True):
        assert torch.equal(parameter, old) != parameter.requires_grad
