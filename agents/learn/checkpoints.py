"""The whole state of a training run between two rollouts, from which a killed run resumes.

After kill and resume, weights and curves are those of the run that was not killed, bit for bit. A
checkpoint only holds numbers, so that reading one runs no code that its author put into it.
"""

import random
from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import Logger

from ...envs.atomic import write_atomically
from ...envs.reading import read_limited
from ..adapter import GymnasiumVecEnv
from ..experiment.errors import SettingsError
from ..experiment.files import cause
from ..experiment.programs import arkanoid
from ..experiment.provenance import memory_gib
from ..experiment.settings import Experiment
from ..experiment.worlds import native
from ..tensor_adapter import TensorVecEnv
from .checkpoint_form import RECENT, State, check_state
from .levels.sampling import check_levels
from .ppo import FastPPO
from .tensors import read_tensors, write_tensors

# What stable-baselines3 counts and keeps from one rollout to the next.
_COUNTERS = ("num_timesteps", "_n_updates", "_episode_num", "_current_progress_remaining")
_LAST = ("_last_obs", "_last_episode_starts")
_FORMAT = 4


def capture(model: PPO, venv: GymnasiumVecEnv, callback_state: dict[str, Any]) -> State:
    """Return the state of a training between two rollouts, that of its callbacks included.

    It consists of tensors, numbers, texts, and lists and tables of them, all copied.
    """
    if isinstance(model, FastPPO):
        model.settle()
    _, keys, *place = np.random.get_state()  # noqa: NPY002 (stable-baselines3 draws from it)
    state = {
        "format": _FORMAT,
        "policy": model.policy.state_dict(),
        "optimizer": model.policy.optimizer.state_dict(),
        "counters": {name: getattr(model, name) for name in _COUNTERS},
        "last": {name: getattr(model, name) for name in _LAST},
        "recent": {name: getattr(model, name) for name in RECENT},
        "log": _pending(model.logger),
        "environment": np.frombuffer(native(venv.env).snapshot(), np.uint8),
        "statistics": venv.get_statistics(),
        "random": {
            "python": random.getstate(),
            "numpy": [np.asarray(keys, np.int64), *place],
            "torch": torch.random.get_rng_state(),
        },
        "callbacks": callback_state,
    }
    plain: State = _plain(state)
    return plain


def _pending(logger: Logger) -> dict[str, Any]:
    """Return what the next line of the curves will say, as far as it is known."""
    numbers = {
        name: float(value)
        for name, value in logger.name_to_value.items()
        if isinstance(value, int | float | np.number)
    }
    return {
        "values": numbers,
        "counts": logger.name_to_count,
        "excluded": {name: list(logger.name_to_excluded[name]) for name in numbers},
    }


def _plain(value: Any) -> Any:
    """Return a copy of a value, with tensors for arrays and lists for queues."""
    if isinstance(value, torch.Tensor):
        return value.detach().to("cpu", copy=True)
    if isinstance(value, np.ndarray):
        return torch.from_numpy(value.copy())
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | deque):
        return [_plain(item) for item in value]
    if isinstance(value, tuple):
        return tuple(map(_plain, value))
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise TypeError(f"a checkpoint cannot hold {value!r}")


def restore(state: State, model: PPO, venv: GymnasiumVecEnv) -> None:
    """Bring a model and its environment, made for the same experiment, into a captured state.

    Raises an exception, usually ValueError, if the state does not fit them; do not use them then.
    """
    # Only an environment that was reset has a state to replace.
    model._last_obs = venv.reset()  # type: ignore[assignment]
    model._last_episode_starts = np.ones(venv.num_envs, np.bool_)
    model.ep_info_buffer, model.ep_success_buffer = (_queue(model), _queue(model))
    fresh, weights = capture(model, venv, {}), list(model.policy.parameters())
    check_state(state, fresh, weights, venv.observation_space)
    model.policy.load_state_dict(state["policy"])
    model.policy.optimizer.load_state_dict(state["optimizer"])
    for name, value in state["counters"].items():
        setattr(model, name, value)
    for name, value in state["last"].items():
        setattr(model, name, _arrays(value))
    for name, values in state["recent"].items():
        getattr(model, name).extend(values)
    logger = model.logger
    logger.name_to_value.update(state["log"]["values"])
    logger.name_to_count.update(state["log"]["counts"])
    logger.name_to_excluded.update(
        {name: tuple(outputs) for name, outputs in state["log"]["excluded"].items()}
    )
    native(venv.env).restore(state["environment"].numpy().tobytes())
    venv.set_statistics(_arrays(state["statistics"]))
    # Last, because the steps above may have drawn random numbers.
    drawn = state["random"]
    random.setstate(drawn["python"])
    keys, *place = drawn["numpy"]
    np.random.set_state(("MT19937", keys.numpy().astype(np.uint32), *place))  # noqa: NPY002
    torch.random.set_rng_state(drawn["torch"])


def _queue(model: PPO) -> "deque[Any]":
    return deque(maxlen=model._stats_window_size)


def _arrays(value: Any) -> Any:
    """Return a value with arrays for its tensors."""
    if isinstance(value, Mapping):
        return {key: _arrays(item) for key, item in value.items()}
    return value.numpy().copy() if isinstance(value, torch.Tensor) else value


def write_checkpoint(state: State, path: Path) -> None:
    """Write a captured state to a file, atomically."""
    write_atomically(path, write_tensors(state))


def _largest() -> int:
    """Return how many bytes a checkpoint may have: reading takes a few times their memory."""
    return int((memory_gib() or 16.0) * 2**30 / 4)


def read_checkpoint(path: Path) -> State:
    """Return the state in a file that `write_checkpoint` wrote; no code in it is run.

    Raises `SettingsError` if the file cannot be read.
    """
    try:
        state = read_tensors(read_limited(path, _largest()))
        if not isinstance(state, dict):
            raise ValueError("it holds something else")
    except FileNotFoundError:
        raise SettingsError(
            f"{path}: no checkpoint there; the run was stopped before its first: start a new run"
        ) from None
    except OSError as error:
        raise SettingsError(f"{path}: the checkpoint cannot be read: {cause(error)}") from None
    except ValueError as error:
        raise _damaged(path, str(error)) from None
    version = state.get("format")
    if type(version) is not int or version != _FORMAT:
        # Anything else than a number may be endless in words.
        named = version if type(version) is int and 0 <= version < 1000 else "unknown"
        raise SettingsError(
            f"{path}: the checkpoint's format is {named}, and this version "
            f"reads {_FORMAT}: resume with the version that wrote it (run.json tells)"
        )
    return state


def resume(path: Path, model: PPO, venv: GymnasiumVecEnv, experiment: Experiment) -> dict[str, Any]:
    """Bring a model and its environment into the state in a file; return its callbacks' state.

    Raises `SettingsError` if the file cannot be read, or its state does not fit them.
    """
    state = read_checkpoint(path)
    try:
        check_levels(state["callbacks"], experiment)
        restore(state, model, venv)
    except Exception as error:  # a forged state can raise anything
        raise _damaged(path, str(error)) from error
    callback_state: dict[str, Any] = state["callbacks"]
    return callback_state


def _damaged(path: Path, reason: str) -> SettingsError:
    """Return the error for a checkpoint that does not belong to its run."""
    anew = arkanoid("train", path.parent / "config.toml")
    return SettingsError(
        f"{path}: the checkpoint cannot be read ({reason}): replace it with a copy, or start a new "
        f"run: {anew}"
    )


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
        # On a device a training ends between an update and the next rollout only, and what lies
        # there is brought here only if it is written.
        self._is_seldom = isinstance(venv, TensorVecEnv)
        self._state: State | None = None
        # The first one is written at once, so that a run that is killed early can resume.
        self._written = -every

    def _on_rollout_start(self) -> None:
        is_due = self.model.num_timesteps >= self._written + self._every
        if is_due or not self._is_seldom:
            self._capture()
        if is_due:
            self._write()
        if self._is_seldom:
            self._state = None

    def _on_step(self) -> bool:
        return True

    def finish(self, complete: bool) -> int:
        """Write the last checkpoint and return the number of decisions until then.

        ``complete`` says whether the last rollout, if there was one, came to its end; otherwise the
        checkpoint is the state before that rollout.
        """
        if complete or self._state is None:
            self._capture()
        self._write()
        return self._written

    def _capture(self) -> None:
        model: Any = self.model
        self._state = capture(model, self._venv, self._callback_state)

    def _write(self) -> None:
        assert self._state is not None
        write_checkpoint(self._state, self._path)
        self._written = int(self._state["counters"]["num_timesteps"])
        self._tell_written(self._written)
