"""PPO: making a model, saving and loading it, and using it as a policy."""

from pathlib import Path
from typing import Any

import torch
from numpy.typing import NDArray
from stable_baselines3 import PPO
from stable_baselines3.common.utils import LinearSchedule
from stable_baselines3.common.vec_env import VecEnv

from ..experiment.files import replace_atomically
from ..experiment.settings import Experiment, Ppo
from ..measure.policy import Policy
from .networks import ACTIVATIONS, extractor_arguments

# What stable-baselines3 would save, and only a training needs.
_OF_THE_TRAINING = ("_last_obs", "_last_episode_starts", "ep_info_buffer", "ep_success_buffer")


def make_model(experiment: Experiment, venv: VecEnv) -> PPO:
    """Return an untrained PPO; all random numbers come from the experiment's seed."""
    torch.set_num_threads(experiment.training.torch_threads)
    ppo, network = experiment.ppo, experiment.network
    observation = experiment.config.observation
    features = extractor_arguments(network, observation, venv.get_attr("layout", 0)[0])
    return PPO(
        "CnnPolicy" if observation == "rgb" else "MlpPolicy",
        venv,
        learning_rate=_scheduled(ppo, ppo.learning_rate),
        n_steps=ppo.n_steps,
        batch_size=ppo.batch_size,
        n_epochs=ppo.n_epochs,
        gamma=ppo.gamma,
        gae_lambda=ppo.gae_lambda,
        clip_range=_scheduled(ppo, ppo.clip_range),
        ent_coef=ppo.ent_coef,
        vf_coef=ppo.vf_coef,
        max_grad_norm=ppo.max_grad_norm,
        policy_kwargs={
            "net_arch": list(network.hidden),
            "activation_fn": ACTIVATIONS[network.activation],
            **features,
        },
        seed=experiment.seed,
        device="cpu",
    )


def save_model(model: PPO, path: Path) -> None:
    """Write the model to ``path``, atomically; `PPO.load` reads it.

    The optimiser's state, twice as large as the weights, is left out: playing does not need it.
    """
    policy: Any = model.policy
    used = policy.optimizer
    policy.optimizer = policy.optimizer_class(
        policy.parameters(), lr=model.lr_schedule(1.0), **policy.optimizer_kwargs
    )
    try:
        replace_atomically(
            path, lambda unfinished: model.save(unfinished, exclude=_OF_THE_TRAINING)
        )
    finally:
        policy.optimizer = used


def load_policy(path: Path, experiment: Experiment) -> Policy:
    """Return a saved model as a policy that plays as the experiment's evaluation says."""
    torch.set_num_threads(experiment.training.torch_threads)
    model = PPO.load(path, device="cpu")
    return ModelPolicy(model, experiment.evaluation.deterministic, experiment.evaluation.seed)


class ModelPolicy:
    """A model as a policy.

    Args:
        model: may change between two calls.
        deterministic: whether to take the likeliest action or to draw one.
        seed: of the draws, which leave torch's own random numbers alone.
    """

    def __init__(self, model: PPO, deterministic: bool, seed: int) -> None:
        self._model = model
        self._deterministic = deterministic
        self._random = torch.Generator().manual_seed(seed).get_state()

    def __call__(self, observations: NDArray[Any], worlds: NDArray[Any]) -> NDArray[Any]:
        """Return the actions for observations [n, ...]."""
        if self._deterministic:
            return self._model.predict(observations, deterministic=True)[0]
        with torch.random.fork_rng(devices=[]):
            torch.random.set_rng_state(self._random)
            actions = self._model.predict(observations, deterministic=False)[0]
            self._random = torch.random.get_rng_state()
        return actions


def _scheduled(ppo: Ppo, start: float) -> float | LinearSchedule:
    """Return a constant, or a schedule that falls to 0 at the end, for stable-baselines3."""
    return start if ppo.schedule == "constant" else LinearSchedule(start, 0.0, 1.0)
