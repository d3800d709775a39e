"""The whole state of a training run between two rollouts, so that a killed one goes on from there.

The weights after kill and resume are those of the run that was not killed, bit for bit.
"""

import copy
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from ..adapter import GymnasiumVecEnv
from ..experiment.files import replace_whole
from ..experiment.schema import SettingsError
from ..experiment.worlds import native

# What stable-baselines3 counts and remembers from one rollout to the next.
_MODEL_FIELDS = (
    "num_timesteps",
    "_n_updates",
    "_episode_num",
    "_current_progress_remaining",
    "_last_obs",
    "_last_episode_starts",
    "ep_info_buffer",
    "ep_success_buffer",
)
_FORMAT = 1


def capture(model: PPO, venv: GymnasiumVecEnv, extra: dict[str, Any]) -> dict[str, Any]:
    """Return the state of a training between two rollouts; ``extra`` is kept with it."""
    environment = native(venv.env)
    return {
        "format": _FORMAT,
        "policy": copy.deepcopy(model.policy.state_dict()),
        "optimizer": copy.deepcopy(model.policy.optimizer.state_dict()),
        "model": {name: copy.deepcopy(getattr(model, name)) for name in _MODEL_FIELDS},
        "environment": environment.snapshot(),
        "statistics": venv.get_statistics(),
        "random": {
            "python": random.getstate(),
            "numpy": np.random.get_state(),  # noqa: NPY002 (stable-baselines3 draws from it)
            "torch": torch.random.get_rng_state(),
        },
        "extra": copy.deepcopy(extra),
    }


def restore(state: dict[str, Any], model: PPO, venv: GymnasiumVecEnv) -> None:
    """Bring a model and its environment, made for the same experiment, into a captured state."""
    environment = native(venv.env)
    model.policy.load_state_dict(state["policy"])
    model.policy.optimizer.load_state_dict(state["optimizer"])
    for name, value in copy.deepcopy(state["model"]).items():
        setattr(model, name, value)
    # Before its first reset an environment has no state that could be replaced.
    venv.reset()
    environment.restore(state["environment"])
    venv.set_statistics(state["statistics"])
    # At last, for what came before may have drawn.
    random.setstate(state["random"]["python"])
    np.random.set_state(state["random"]["numpy"])  # noqa: NPY002
    torch.random.set_rng_state(state["random"]["torch"])


def write_checkpoint(state: dict[str, Any], path: Path) -> None:
    """Write a captured state to a file: all of it, or what was there before."""
    replace_whole(path, lambda unfinished: torch.save(state, unfinished))


def read_checkpoint(path: Path) -> dict[str, Any]:
    """Return the state in a file that `write_checkpoint` wrote.

    It is read with pickle, which runs what the file says: read only files of your own runs.
    Raises `SettingsError` if the file cannot be read.
    """
    try:
        state: dict[str, Any] = torch.load(path, map_location="cpu", weights_only=False)
    except FileNotFoundError:
        raise SettingsError(
            f"{path}: no checkpoint there; the run was stopped before its first one: start it anew"
        ) from None
    except Exception as error:  # whatever pickle meets in a damaged file
        raise SettingsError(f"{path}: the checkpoint cannot be read: {error}") from None
    if state.get("format") != _FORMAT:
        raise SettingsError(
            f"{path}: the checkpoint's format is {state.get('format')!r}, and this version reads "
            f"{_FORMAT}: resume with the version that wrote it (run.json tells)"
        )
    return state


class Checkpoints(BaseCallback):
    """Keeps the state before each rollout, and writes it now and then and at the end.

    Args:
        path: of the file.
        venv: the environment that is trained on.
        every: decisions between two writings.
        extra: what the other callbacks remember; it is kept in the state.
        written: told after each writing how many decisions the state has seen.
    """

    def __init__(
        self,
        path: Path,
        venv: GymnasiumVecEnv,
        every: int,
        extra: dict[str, Any],
        written: Callable[[int], None],
    ) -> None:
        super().__init__()
        self._path = path
        self._venv = venv
        self._every = every
        self._extra = extra
        self._tell_written = written
        self._state: dict[str, Any] | None = None
        # The first state is written at once: a run that is killed early can be resumed, too.
        self._written = -every

    def _on_rollout_start(self) -> None:
        self._capture()
        if self.model.num_timesteps >= self._written + self._every:
            self._write()

    def _on_step(self) -> bool:
        return True

    def finish(self, complete: bool) -> int:
        """Write the latest state, after the training or before the rollout that was broken off.

        Returns how many decisions it has seen.
        """
        if complete:
            self._capture()
        self._write()
        return self._written

    def _capture(self) -> None:
        model: Any = self.model
        self._state = capture(model, self._venv, self._extra)

    def _write(self) -> None:
        assert self._state is not None
        write_checkpoint(self._state, self._path)
        self._written = int(self._state["model"]["num_timesteps"])
        self._tell_written(self._written)
