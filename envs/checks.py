"""Checks of users' values; each message names the value and says what is legal."""

import math

import numpy as np


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
    if not (math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} must be between {low:g} and {high:g}; got {value!r}")
