"""States in memory and the means to step them: what a single world and a batch share."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ..validation import not_negative, whole
from .records import END, Hit
from .setup import Bytes, Setup
from .stepping import INVALID, step_worlds

FIRST_ROOM = 64  # hits; it grows as needed


class Stepper:
    """Steps the worlds of a matrix of states, and keeps the memory that this takes.

    Args:
        setup: what the worlds share.
        states: uint8 [worlds, bytes], changed in place.
    """

    def __init__(self, setup: Setup, states: Bytes) -> None:
        self.desk = setup.desk.copy()
        self._states = states
        self._has_sensors = len(setup.sensing) > 0
        self._hits: npt.NDArray[Any] = np.zeros(0, Hit)
        self._grow(FIRST_ROOM + 2 * len(setup.sensing))

    def step(self, dt: float, steps: int) -> npt.NDArray[Any]:
        """Make steps; return their hits, by world and time.

        Raises:
            ValueError: if a position or velocity is not finite, or has become so.
        """
        count = step_worlds(self._states, self.desk, self._buffer, 0, dt, steps)
        while count < 0:
            if count == INVALID:
                raise ValueError(
                    "a position or velocity is not finite: it was set so, or has outgrown the "
                    "range of numbers"
                )
            self._grow(2 * len(self._hits))
            count = step_worlds(self._states, self.desk, self._buffer, -1 - count, dt, steps)
        if count == 0:
            return self._hits[:0]
        hits = self._hits[:count].copy()
        if self._has_sensors and (hits["kind"] == END).any():
            # That a body left a sensor is known later than it happened.
            hits = hits[np.lexsort((hits["time"], hits["world"]))]
        return hits

    def _grow(self, room: int) -> None:
        """Make room for so many hits."""
        hits = np.zeros(room, Hit)
        hits[: len(self._hits)] = self._hits
        self._hits, self._buffer = hits, hits.view(np.uint8)


def checked_step(dt: Any, steps: Any) -> tuple[float, int]:
    """Return a step's length and the number of steps, having checked them."""
    if type(dt) is float and 0.0 <= dt < math.inf and type(steps) is int and steps > 0:
        return dt, steps
    return not_negative("dt", dt), whole("steps", steps, at_least=1)
