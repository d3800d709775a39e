"""Checks of what users pass to the environment: messages say which value, and what is legal."""

import math

import numpy as np


def check_choice(name: str, value: object, legal: tuple[str, ...]) -> None:
    """Refuse what is none of some words, with a ValueError."""
    if value not in legal:
        raise ValueError(f"{name} must be one of {', '.join(map(repr, legal))}; got {value!r}")


def check_integer(name: str, value: object, low: int, high: int) -> None:
    """Refuse what is no integer (TypeError) or not within bounds (ValueError)."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(f"{name} must be an integer; got {value!r}")
    if not low <= value <= high:
        raise ValueError(f"{name} must be between {low} and {high}; got {value!r}")


def check_number(name: str, value: object, low: float, high: float) -> None:
    """Refuse what is no number (TypeError) or not finite and within bounds (ValueError)."""
    if isinstance(value, bool) or not isinstance(value, float | int | np.floating | np.integer):
        raise TypeError(f"{name} must be a number; got {value!r}")
    if not (math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} must be between {low:g} and {high:g}; got {value!r}")
