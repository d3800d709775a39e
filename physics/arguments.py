"""Checks of the arguments that users pass. Each message says which value is wrong, and why."""

import math
from collections.abc import Iterable
from numbers import Real
from operator import index
from typing import Any

import numpy as np
import numpy.typing as npt

from .tolerances import FARTHEST

Vector = tuple[float, float]


def _number(name: str, value: Any) -> float:
    """Return a real number as a float."""
    # The quick test comes first: most numbers are floats, and NumPy's are, too.
    if not isinstance(value, float) and (not isinstance(value, Real) or isinstance(value, bool)):
        raise TypeError(f"{name} must be a number, but is {value!r}")
    try:
        return float(value)
    except OverflowError:  # of an integer: how many digits it has, nobody knows
        raise ValueError(f"{name} is too large for a float") from None


def integer(name: str, value: Any) -> int:
    """Return an integer; TypeError for anything else, such as a bool or 1.0."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"{name} must be an integer, but is {value!r}")
    return index(value)


def whole(name: str, value: Any, at_least: int) -> int:
    """Return an integer of 64 bits that is not less than ``at_least``."""
    number = integer(name, value)
    if number < at_least:
        raise ValueError(f"{name} must be at least {at_least}, but is {value!r}")
    if number >= 1 << 63:
        raise ValueError(f"{name} must fit into 64 bits")
    return number


def finite(name: str, value: Any) -> float:
    """Return a finite number as a float; ValueError or TypeError otherwise."""
    number = _number(name, value)
    if not math.isfinite(number):
        raise ValueError(f"{name} must be finite, but is {value!r}")
    return number


def positive(name: str, value: Any) -> float:
    """Return a finite number above 0 as a float."""
    number = finite(name, value)
    if number <= 0.0:
        raise ValueError(f"{name} must be greater than 0, but is {value!r}")
    return number


def not_negative(name: str, value: Any) -> float:
    """Return a finite number that is not below 0 as a float."""
    number = finite(name, value)
    if number < 0.0:
        raise ValueError(f"{name} must not be negative, but is {value!r}")
    return number


def inverse_mass(name: str, value: Any) -> float:
    """Return 1 / mass; 0 for None, a static body's mass."""
    if value is None:
        return 0.0
    inverse = 1.0 / positive(name, value)
    if not math.isfinite(inverse):
        raise ValueError(f"{name} is too small to divide by: {value!r}. Use larger units")
    return inverse


def vector(name: str, value: Any) -> Vector:
    """Return two numbers, of which the engine may take the squares, as a tuple of floats."""
    pair = value.tolist() if type(value) is np.ndarray and value.ndim == 1 else value
    if type(pair) in (tuple, list) and len(pair) == 2:  # the quick test, again
        x, y = pair
        if type(x) is type(y) is float and abs(x) <= FARTHEST and abs(y) <= FARTHEST:
            return x, y
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        raise TypeError(f"{name} must be two numbers (x, y), but is {value!r}")
    components = list(value)
    if len(components) != 2:
        raise ValueError(f"{name} must be two numbers (x, y), but has {len(components)}: {value!r}")
    x, y = finite(f"{name}[0]", components[0]), finite(f"{name}[1]", components[1])
    if max(abs(x), abs(y)) > FARTHEST:
        raise ValueError(f"{name} must be at most {FARTHEST:g} away from 0, but is {value!r}")
    return x, y


def near_all(name: str, values: Any) -> npt.NDArray[np.float64]:
    """Return points, of whose numbers the engine may take the squares, as float64 [n, 2]."""
    points = np.asarray(values, np.float64)
    if points.shape == (0,):  # an empty list does not say that its points would be pairs
        points = points.reshape(0, 2)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"{name} must have the shape [n, 2], but has {list(points.shape)}")
    if not (np.abs(points) <= FARTHEST).all():
        raise ValueError(f"{name} must be finite, and at most {FARTHEST:g} away from 0")
    return points


def near_each(name: str, values: Any, count: int) -> npt.NDArray[np.float64]:
    """Return such points, one for each of some bodies, or (x, y) for all of them, [n or 1, 2]."""
    given = np.asarray(values, np.float64)
    is_one = given.ndim == 1 and given.size > 0
    points = near_all(name, given[None] if is_one else given)
    if not is_one and len(points) != count:
        raise ValueError(f"{name} must have the shape [{count}, 2], but has {list(points.shape)}")
    return points


def duration(name: str, value: Any) -> float:
    """Return a length of time, perhaps infinite, as a float."""
    number = _number(name, value)
    if not number >= 0.0:
        raise ValueError(f"{name} must be 0 or more, perhaps infinite, but is {value!r}")
    return number
