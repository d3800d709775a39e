"""PPO: building the model, training it, keeping it, and using it as a policy."""

import math
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import configure
from stable_baselines3.common.vec_env import VecEnv
from torch import nn
from tqdm import tqdm  # type: ignore[import-untyped]

from .baselines import Policy
from .episodes import FINAL_KEYWORDS, SUMMED_KEYWORDS
from .settings import Experiment, Ppo

_ACTIVATIONS = {"tanh": nn.Tanh, "relu": nn.ReLU, "elu": nn.ELU, "silu": nn.SiLU}


def make_model(experiment: Experiment, venv: VecEnv) -> PPO:
    """Return an untrained PPO; all random numbers come from the experiment's seed."""
    torch.set_num_threads(experiment.training.torch_threads)
    ppo = experiment.ppo
    return PPO(
        "MlpPolicy",
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
            "net_arch": list(experiment.network.hidden),
            "activation_fn": _ACTIVATIONS[experiment.network.activation],
        },
        seed=experiment.seed,
        device="cpu",
    )


def train(model: PPO, experiment: Experiment, log: Path) -> bool:
    """Train until the experiment's budget is spent, or Ctrl-C; tell whether it was spent.

    Learning curves go to the folder ``log``. Ctrl-C is obeyed between two decisions, so that the
    model is whole; a second one is Python's own.
    """
    model.set_logger(configure(str(log), ["tensorboard", "csv"]))
    stop = StopRequest()
    try:
        with _on_interrupt(stop.request):
            callbacks = [GameStatistics(), ProgressBar(), stop]
            model.learn(experiment.training.timesteps, callback=callbacks)
    finally:
        model.logger.close()
    return not stop.requested


def save_model(model: PPO, path: Path) -> None:
    """Write the model to ``path``: all of it, or what was there before."""
    unfinished = path.with_name(f"unfinished-{path.name}")
    model.save(unfinished)
    os.replace(unfinished, path)


def load_policy(path: Path, experiment: Experiment) -> Policy:
    """Return the saved model as a policy that plays as the experiment's evaluation says."""
    torch.set_num_threads(experiment.training.torch_threads)
    return as_policy(PPO.load(path, device="cpu"), experiment.evaluation.deterministic)


def as_policy(model: PPO, deterministic: bool) -> Policy:
    """Return a model as a policy: observations [worlds, ...] to actions [worlds, ...]."""

    def policy(observations: NDArray[Any]) -> NDArray[Any]:
        return model.predict(observations, deterministic=deterministic)[0]

    return policy


class GameStatistics(BaseCallback):
    """Logs the means of the game's own statistics over the latest episodes."""

    def _on_step(self) -> bool:
        return True

    def _on_rollout_end(self) -> None:
        for key in FINAL_KEYWORDS + SUMMED_KEYWORDS:
            mean = _recent_mean(self.model, key)
            if mean is not None:
                self.logger.record(f"rollout/ep_{key}_mean", mean)


class ProgressBar(BaseCallback):
    """Shows decisions a second, and the latest episodes' mean return and brick hits."""

    def _on_training_start(self) -> None:
        # Whole rollouts are played, so that the last one may go beyond what was asked for.
        rollout = self.model.n_steps * self.training_env.num_envs  # type: ignore[attr-defined]
        self._bar = tqdm(
            total=math.ceil(self.locals["total_timesteps"] / rollout) * rollout,
            unit=" decisions",
            unit_scale=True,
            # A terminal is redrawn; a file gets few lines.
            mininterval=0.2 if os.isatty(2) else 10.0,
        )

    def _on_step(self) -> bool:
        self._bar.update(self.training_env.num_envs)
        return True

    def _on_rollout_end(self) -> None:
        means = {"return": _recent_mean(self.model, "r")}
        means["brick hits"] = _recent_mean(self.model, "hits")
        shown = {name: f"{mean:.2f}" for name, mean in means.items() if mean is not None}
        self._bar.set_postfix(shown, refresh=False)

    def _on_training_end(self) -> None:
        self._bar.close()


class StopRequest(BaseCallback):
    """Ends the training after the decision in which it is asked to."""

    def __init__(self) -> None:
        super().__init__()
        self.requested = False

    def request(self) -> None:
        """Ask for the end."""
        self.requested = True

    def _on_step(self) -> bool:
        return not self.requested


def _scheduled(ppo: Ppo, start: float) -> float | Callable[[float], float]:
    """Return what stable-baselines3 takes: a number, or a function of the share still to come."""
    if ppo.schedule == "constant":
        return start
    return lambda remaining: start * remaining


def _recent_mean(model: Any, key: str) -> float | None:
    """Return the mean of an episode statistic, or None before the first episode has ended."""
    episodes = model.ep_info_buffer
    return float(np.mean([episode[key] for episode in episodes])) if episodes else None


@contextmanager
def _on_interrupt(request: Callable[[], None]) -> Iterator[None]:
    """Call ``request`` on the first Ctrl-C within."""
    previous = signal.getsignal(signal.SIGINT)

    def handle(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, previous)
        request()

    try:
        signal.signal(signal.SIGINT, handle)
    except ValueError:
        # Only the main thread may handle signals; elsewhere Ctrl-C is not ours to handle.
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)
