"""Checks of users' values; each message names the value and says what is legal."""

from collections.abc import Sequence
from typing import Any

import numpy as np

MAX_GAME_SEED = 2**64 - 1  # the generator of a game tells these seeds apart


def counted(count: int, noun: str) -> str:
    """Return a number with its noun: ``1 game``, ``2 games``, ``1,000 games``."""
    return f"{count:,} {noun if count == 1 else f'{noun}s'}"


def check_choice(name: str, value: object, legal: tuple[str, ...]) -> None:
    """Raise a ValueError unless a value is one of some words."""
    if value not in legal:
        raise ValueError(f"{name} must be one of {', '.join(map(repr, legal))}; got {value!r}")


def check_boolean(name: str, value: object) -> None:
    """Raise a TypeError unless a value is a boolean."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{name} must be True or False; got {value!r}")


def check_integer(name: str, value: object, low: int, high: int) -> None:
    """Raise a TypeError unless a value is an integer, a ValueError unless it is in [low, high]."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(f"{name} must be an integer; got {value!r}")
    if not low <= value <= high:
        raise ValueError(f"{name} must be between {low} and {high}; got {value!r}")


def check_number(name: str, value: object, low: float, high: float) -> None:
    """Raise a TypeError unless a value is a number, a ValueError unless it is in [low, high]."""
    if isinstance(value, bool) or not isinstance(value, float | int | np.floating | np.integer):
        raise TypeError(f"{name} must be a number; got {value!r}")
    if not low <= value <= high:  # NaN is outside, too
        raise ValueError(f"{name} must be between {low:g} and {high:g}; got {value!r}")


def check_seed(seed: Any) -> int | None:
    """Return the seed of one game, or None.

    Raises:
        TypeError: it is no integer.
        ValueError: it is not in [0, 2^64).
    """
    if seed is None:
        return None
    check_integer("seed", seed, 0, MAX_GAME_SEED)
    return int(seed)


def check_seeds(seed: Any, count: int) -> list[int | None]:
    """Return the seed of each of some games; None where there is none.

    Args:
        seed: an integer (game ``i`` gets ``seed + i``), one seed or None per game, or None.
        count: the number of games.

    Raises:
        TypeError: a seed is no integer.
        ValueError: it is not in [0, 2^64), or the number of seeds is wrong.
    """
    if seed is None:
        return [None] * count
    if not _is_sequence(seed):
        check_integer("seed", seed, 0, MAX_GAME_SEED + 1 - count)
        return [int(seed) + index for index in range(count)]
    if len(seed) != count:
        raise ValueError(
            f"{counted(len(seed), 'seed')} for {counted(count, 'world')}; give one for each"
        )
    for index, each in enumerate(seed):
        if each is not None:
            check_integer(f"seed[{index}]", each, 0, MAX_GAME_SEED)
    return [None if each is None else int(each) for each in seed]


def _is_sequence(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.ndim == 1
    return isinstance(value, Sequence) and not isinstance(value, str | bytes)
