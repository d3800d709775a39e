"""The whole state of a training run between two rollouts, from which a killed run resumes.

The weights after a kill and a resumption are, bit for bit, those of an undisturbed run.
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
from ..experiment.errors import SettingsError
from ..experiment.files import replace_atomically
from ..experiment.worlds import native

# What stable-baselines3 counts and keeps from one rollout to the next.
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
_FORMAT = 2


def capture(model: PPO, venv: GymnasiumVecEnv, callback_state: dict[str, Any]) -> dict[str, Any]:
    """Return the state of a training between two rollouts, that of its callbacks included."""
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
        "callbacks": copy.deepcopy(callback_state),
    }


def restore(state: dict[str, Any], model: PPO, venv: GymnasiumVecEnv) -> None:
    """Bring a model and its environment, made for the same experiment, into a captured state."""
    environment = native(venv.env)
    model.policy.load_state_dict(state["policy"])
    model.policy.optimizer.load_state_dict(state["optimizer"])
    for name, value in copy.deepcopy(state["model"]).items():
        setattr(model, name, value)
    # Only an environment that was reset has a state to replace.
    venv.reset()
    environment.restore(state["environment"])
    venv.set_statistics(state["statistics"])
    # Last, because the steps above may have drawn random numbers.
    random.setstate(state["random"]["python"])
    np.random.set_state(state["random"]["numpy"])  # noqa: NPY002
    torch.random.set_rng_state(state["random"]["torch"])


def write_checkpoint(state: dict[str, Any], path: Path) -> None:
    """Write a captured state to a file, atomically."""
    replace_atomically(path, lambda unfinished: torch.save(state, unfinished))


def read_checkpoint(path: Path) -> dict[str, Any]:
    """Return the state in a file that `write_checkpoint` wrote.

    Pickle reads it and runs whatever code the file holds: read only files of runs that you trust.
    Raises `SettingsError` if the file cannot be read.
    """
    try:
        state: dict[str, Any] = torch.load(path, map_location="cpu", weights_only=False)
    except FileNotFoundError:
        raise SettingsError(
            f"{path}: no checkpoint there; the run stopped before its first one: start it again"
        ) from None
    except Exception as error:  # a damaged file can make pickle raise anything
        raise SettingsError(f"{path}: the checkpoint cannot be read: {error}") from None
    if state.get("format") != _FORMAT:
        raise SettingsError(
            f"{path}: the checkpoint's format is {state.get('format')!r}, and this version reads "
            f"{_FORMAT}: resume with the version that wrote it (see run.json)"
        )
    return state


class Checkpoints(BaseCallback):
    """Captures the state before each rollout, and writes it regularly and at the end.

    Args:
        path: of the file.
        venv: the environment that is trained on.
        every: decisions between two checkpoints.
        callback_state: the other callbacks' state, a part of the checkpoint.
        tell_written: after each checkpoint it gets the number of decisions until then.
    """

    def __init__(
        self,
        path: Path,
        venv: GymnasiumVecEnv,
        every: int,
        callback_state: dict[str, Any],
        tell_written: Callable[[int], None],
    ) -> None:
        super().__init__()
        self._path = path
        self._venv = venv
        self._every = every
        self._callback_state = callback_state
        self._tell_written = tell_written
        self._state: dict[str, Any] | None = None
        # The first one is written at once, so that a run that is killed early can resume.
        self._written = -every

    def _on_rollout_start(self) -> None:
        self._capture()
        if self.model.num_timesteps >= self._written + self._every:
            self._write()

    def _on_step(self) -> bool:
        return True

    def finish(self, complete: bool) -> int:
        """Write the last checkpoint and return the number of decisions until then.

        ``complete`` says whether the last rollout came to its end; otherwise the checkpoint is the
        state before that rollout.
        """
        if complete:
            self._capture()
        self._write()
        return self._written

    def _capture(self) -> None:
        model: Any = self.model
        self._state = capture(model, self._venv, self._callback_state)

    def _write(self) -> None:
        assert self._state is not None
        write_checkpoint(self._state, self._path)
        self._written = int(self._state["model"]["num_timesteps"])
        self._tell_written(self._written)
