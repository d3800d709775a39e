"""What a checkpoint must hold, so that a training can go on from it.

Files may come from anyone: the types, the shapes and the ranges of all values are checked.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import torch
from gymnasium.spaces import Space

from ..measure.episodes import FINAL_KEYWORDS, SUMMED_KEYWORDS
from .curves import STEP, is_number
from .levels.sampling import LEVELS
from .tensors import is_like

State = dict[str, Any]

# What stable-baselines3 keeps of the latest episodes.
RECENT = ("ep_info_buffer", "ep_success_buffer")
# The key of the callbacks' state that has the reason why the run has ended; "" if it has not.
STOP = "stop"
_LONGEST_NAME = 200  # of something that is logged, and of a reason


@dataclass(frozen=True)
class Range:
    """Finite numbers, both ends included; ``whole``: integers only."""

    low: float
    high: float
    whole: bool = False

    def has(self, value: Any) -> bool:
        """Tell whether a number is one of these, or all numbers of a tensor are."""
        if isinstance(value, torch.Tensor):
            inside: Any = (value >= self.low) & (value <= self.high)  # not NaN
            return bool(inside.all()) and not (self.whole and value.is_floating_point())
        if type(value) is not int and (type(value) is not float or self.whole):
            return False
        return self.low <= value <= self.high


_COUNT = Range(0, 2**62, whole=True)
_SUM = Range(-1e15, 1e15)
_AMOUNT = Range(0.0, 1e15)
# The path of a value, in which ``*`` stands for any name, and its range. The first path that fits
# counts. Weights may have any numbers: where they are not finite, the training has diverged.
_RANGES = {
    "counters._current_progress_remaining": Range(-1e15, 1.0),
    "counters.*": _COUNT,
    "statistics.returns": _SUM,
    "statistics.lengths": _COUNT,
    "statistics.sums.*": _AMOUNT,
    "recent.ep_info_buffer.*.r": _SUM,
    "recent.ep_info_buffer.*.l": _COUNT,
    "recent.ep_info_buffer.*": _AMOUNT,
    "recent.ep_success_buffer.*": Range(0, 1),
    "random.numpy.0": Range(0, 2**32 - 1, whole=True),
    "random.numpy.1": Range(0, 624, whole=True),  # the place in the words of numpy.0
    "random.numpy.2": Range(0, 1, whole=True),
    "random.numpy.3": _SUM,
    "log.counts.*": _COUNT,
    "callbacks.stage": _COUNT,
    "callbacks.validation.best": _SUM,
    "callbacks.validation.latest": Range(-1, 2**62, whole=True),
    "callbacks.validation.*": _COUNT,
    "optimizer.state.*.step": Range(0.0, 2.0**62),
}


def check_state(
    state: State, fresh: State, weights: Sequence[torch.Tensor], observations: "Space[Any]"
) -> None:
    """Raise ValueError unless a training can go on from a state.

    Args:
        state: what a file holds.
        fresh: the state of a new training of the same experiment.
        weights: of the policy.
        observations: the space of one world's observations.
    """
    _check_keys(state, fresh, "it")
    for name in ("policy", "counters", "last", "statistics", "random"):
        _check_form(state[name], fresh[name], name)
    _check_optimizer(state["optimizer"], fresh["optimizer"], weights)
    _check_recent(state["recent"], fresh["recent"])
    _check_log(state["log"], fresh["log"])
    _check_callbacks(state["callbacks"])
    for path, value in _leaves({name: state[name] for name in state if name != "policy"}):
        allowed = next((_RANGES[way] for way in _RANGES if fnmatchcase(path, way)), None)
        if allowed is not None and not allowed.has(value):
            raise ValueError(f"{path} is out of its range")
    if not all(row.numpy() in observations for row in state["last"]["_last_obs"]):
        raise ValueError("last._last_obs is no observation")
    _check_snapshot(state["environment"])


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the dotted paths of all numbers and tensors in tables and lists, and what they are."""
    if isinstance(value, dict | list | tuple):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for name, item in items:
            yield from _leaves(item, f"{path}.{name}" if path else str(name))
    elif value is not None and not isinstance(value, str | bool):
        yield path, value


def _check_snapshot(snapshot: Any) -> None:
    """Raise ValueError unless this is a row of bytes; the environment checks them."""
    if not isinstance(snapshot, torch.Tensor) or snapshot.dtype != torch.uint8:
        raise ValueError("environment must hold bytes")
    # Otherwise a single byte could look like billions.
    if snapshot.dim() != 1 or not snapshot.is_contiguous():
        raise ValueError("environment must hold one row of bytes")


def _check_recent(state: Any, fresh: State) -> None:
    """Raise ValueError unless these are the results of episodes of this game."""
    _check_keys(state, fresh, "recent")
    episodes, successes = (state[name] for name in RECENT)
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
    # A line of the curves begins with its step.
    if STEP in state["values"]:
        raise ValueError(f"log.values has {STEP!r}")
    for outputs in state["excluded"].values():
        if type(outputs) is not list or not all(type(output) is str for output in outputs):
            raise ValueError("log.excluded must hold lists of texts")


def _check_callbacks(state: Any) -> None:
    """Raise ValueError unless callbacks have left numbers and the reason of the run's end.

    There need be no best number.
    """
    if not isinstance(state, dict):
        raise ValueError("callbacks must hold numbers")
    own = dict(state)
    reason = own.pop(STOP, "")
    if type(reason) is not str or not reason.isprintable() or len(reason) > _LONGEST_NAME:
        raise ValueError(f"callbacks.{STOP} must hold a line of text")
    validation = own.pop("validation", {})
    own.pop(LEVELS, None)  # `check_levels` looks at it
    if isinstance(validation, dict) and validation.get("best", 0.0) is None:
        validation = {**validation, "best": 0.0}
    _check_numbers(own, "callbacks")
    _check_numbers(validation, "callbacks.validation")


def _check_optimizer(state: Any, fresh: Any, weights: Sequence[torch.Tensor]) -> None:
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
        if (of_weight["exp_avg_sq"] < 0).any():
            raise ValueError("optimizer has a negative number where none can be")


def _check_keys(value: Any, fresh: State, where: str) -> None:
    if not isinstance(value, dict) or value.keys() != fresh.keys():
        raise ValueError(f"{where} has other entries than a checkpoint of this run")


def _check_numbers(table: Any, where: str) -> None:
    """Raise ValueError unless this is a table of numbers whose names can be shown."""
    if not isinstance(table, dict) or not all(
        isinstance(name, str)
        and name.isprintable()
        and len(name) <= _LONGEST_NAME
        and is_number(value)
        for name, value in table.items()
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
