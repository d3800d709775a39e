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
from ..adapter import GymnasiumVecEnv
from ..experiment.errors import SettingsError
from ..experiment.files import cause, quoted
from ..experiment.worlds import native
from ..measure.episodes import FINAL_KEYWORDS, SUMMED_KEYWORDS
from .curves import is_number
from .tensors import is_like, read_tensors, write_tensors

# What stable-baselines3 counts and keeps from one rollout to the next.
_COUNTERS = ("num_timesteps", "_n_updates", "_episode_num", "_current_progress_remaining")
_LAST = ("_last_obs", "_last_episode_starts")
_RECENT = ("ep_info_buffer", "ep_success_buffer")
_FORMAT = 3

State = dict[str, Any]


def capture(model: PPO, venv: GymnasiumVecEnv, callback_state: dict[str, Any]) -> State:
    """Return the state of a training between two rollouts, that of its callbacks included.

    It consists of tensors, numbers, texts, and lists and tables of them, all copied.
    """
    _, keys, *place = np.random.get_state()  # noqa: NPY002 (stable-baselines3 draws from it)
    state = {
        "format": _FORMAT,
        "policy": model.policy.state_dict(),
        "optimizer": model.policy.optimizer.state_dict(),
        "counters": {name: getattr(model, name) for name in _COUNTERS},
        "last": {name: getattr(model, name) for name in _LAST},
        "recent": {name: getattr(model, name) for name in _RECENT},
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
        return value.detach().clone()
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
    _check(state, capture(model, venv, {}), list(model.policy.parameters()))
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


def _check(state: State, fresh: State, weights: list[torch.Tensor]) -> None:
    """Raise ValueError unless a state has the same form as that of a new training."""
    _check_keys(state, fresh, "it")
    for name in ("policy", "counters", "last", "statistics", "random"):
        _check_form(state[name], fresh[name], name)
    _check_optimizer(state["optimizer"], fresh["optimizer"], weights)
    counters = state["counters"]
    if not all(0 <= counters[name] < 2**62 for name in ("num_timesteps", "_n_updates")):
        raise ValueError("counters are out of their range")
    if not 0 <= state["random"]["numpy"][1] <= len(state["random"]["numpy"][0]):
        raise ValueError("random.numpy is out of its range")
    _check_recent(state["recent"], fresh["recent"])
    _check_log(state["log"], fresh["log"])
    _check_callbacks(state["callbacks"])
    snapshot = state["environment"]
    if not isinstance(snapshot, torch.Tensor) or snapshot.dtype != torch.uint8:
        raise ValueError("environment must hold bytes")
    # Otherwise a single byte could look like billions.
    if snapshot.dim() != 1 or not snapshot.is_contiguous():
        raise ValueError("environment must hold one row of bytes")


def _check_recent(state: Any, fresh: State) -> None:
    """Raise ValueError unless these are the results of episodes of this game."""
    _check_keys(state, fresh, "recent")
    episodes, successes = (state[name] for name in _RECENT)
    if type(episodes) is not list or type(successes) is not list:
        raise ValueError("recent must hold lists")
    for episode in episodes:
        _check_numbers(episode, "recent")
        if not {"r", "l", *FINAL_KEYWORDS, *SUMMED_KEYWORDS} <= episode.keys():
            raise ValueError("recent has episodes of another game")
    if not all(type(success) in (bool, int, float) for success in successes):
        raise ValueError("recent must hold numbers")


def _check_log(state: Any, fresh: State) -> None:
    """Raise ValueError unless these are logged numbers, and who does not get them."""
    _check_keys(state, fresh, "log")
    _check_numbers(state["values"], "log.values")
    _check_numbers(state["counts"], "log.counts")
    _check_keys(state["excluded"], state["values"], "log.excluded")
    for outputs in state["excluded"].values():
        if type(outputs) is not list or not all(type(output) is str for output in outputs):
            raise ValueError("log.excluded must hold lists of texts")


def _check_callbacks(state: Any) -> None:
    """Raise ValueError unless callbacks have left numbers, and no best one where there is none."""
    own = dict(state) if isinstance(state, dict) else None
    validation = own.pop("validation", {}) if own is not None else None
    if isinstance(validation, dict) and validation.get("best", 0.0) is None:
        validation = {**validation, "best": 0.0}
    _check_numbers(own, "callbacks")
    _check_numbers(validation, "callbacks.validation")


def _check_optimizer(state: Any, fresh: Any, weights: list[torch.Tensor]) -> None:
    """Raise ValueError unless Adam's moments, where there are any, have the weights' shapes."""
    _check_keys(state, fresh, "optimizer")
    _check_form(state["param_groups"], fresh["param_groups"], "optimizer")
    for group, other in zip(state["param_groups"], fresh["param_groups"], strict=True):
        # Only the learning rate changes, and each update sets it.
        if {**group, "lr": 0.0} != {**other, "lr": 0.0}:
            raise ValueError("optimizer has other options")
    moments = state["state"]
    if not isinstance(moments, dict) or not set(moments) <= set(range(len(weights))):
        raise ValueError("optimizer is that of another network")
    for index, of_weight in moments.items():
        weight = weights[index]
        like = {"step": torch.tensor(0.0), "exp_avg": weight, "exp_avg_sq": weight}
        _check_form(of_weight, like, f"optimizer.{index}")
        if of_weight["step"] < 0 or (of_weight["exp_avg_sq"] < 0).any():
            raise ValueError("optimizer has a negative number where none can be")


def _check_keys(value: Any, fresh: State, where: str) -> None:
    if not isinstance(value, dict) or value.keys() != fresh.keys():
        raise ValueError(f"{where} has other entries than a checkpoint of this run")


def _check_numbers(table: Any, where: str) -> None:
    if not isinstance(table, dict) or not all(
        isinstance(name, str) and is_number(value) for name, value in table.items()
    ):
        raise ValueError(f"{where} must hold numbers")


def _check_form(value: Any, fresh: Any, where: str) -> None:
    """Raise ValueError unless a value has the types, keys, lengths and shapes of another."""
    if isinstance(fresh, torch.Tensor):
        alike = is_like(value, fresh)
    elif isinstance(fresh, dict):
        alike = isinstance(value, dict) and value.keys() == fresh.keys()
    elif isinstance(fresh, list | tuple):
        alike = type(value) is type(fresh) and len(value) == len(fresh)
    else:
        alike = type(value) is type(fresh)
    if not alike:
        raise ValueError(f"{where} is not that of this run")
    if isinstance(fresh, dict):
        for key in fresh:
            _check_form(value[key], fresh[key], f"{where}.{key}")
    elif isinstance(fresh, list | tuple):
        for index, (item, other) in enumerate(zip(value, fresh, strict=True)):
            _check_form(item, other, f"{where}.{index}")


def write_checkpoint(state: State, path: Path) -> None:
    """Write a captured state to a file, atomically."""
    write_atomically(path, write_tensors(state))


def read_checkpoint(path: Path) -> State:
    """Return the state in a file that `write_checkpoint` wrote; no code in it is run.

    Raises `SettingsError` if the file cannot be read.
    """
    try:
        state = read_tensors(path.read_bytes())
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


def resume(path: Path, model: PPO, venv: GymnasiumVecEnv) -> dict[str, Any]:
    """Bring a model and its environment into the state in a file; return its callbacks' state.

    Raises `SettingsError` if the file cannot be read, or its state does not fit them.
    """
    state = read_checkpoint(path)
    try:
        restore(state, model, venv)
    except Exception as error:  # a forged state can raise anything
        raise _damaged(path, str(error)) from error
    callback_state: dict[str, Any] = state["callbacks"]
    return callback_state


def _damaged(path: Path, reason: str) -> SettingsError:
    """Return the error for a checkpoint that does not belong to its run."""
    config = quoted(path.parent / "config.toml")
    return SettingsError(
        f"{path}: the checkpoint cannot be read ({reason}): replace it with a copy, or start a new "
        f"run: arkanoid train {config}"
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
        self._state: State | None = None
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
        self._written = int(self._state["counters"]["num_timesteps"])
        self._tell_written(self._written)
