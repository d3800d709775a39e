"""Worlds that are stepped by one call of a kernel, and the memory that this takes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import not_negative, whole
from ..tolerances import FARTHEST
from .living.site import NO_HITS, Site
from .records import END, Hit
from .stepping import INVALID, call_of, step_worlds

FIRST_ROOM = 64  # hits; it grows as needed


class Stepper:
    """Steps some worlds, one after the other.

    Args:
        sites: the worlds.

    Attributes:
        has_pending: whether edits of a world have caused events.
    """

    def __init__(self, sites: Sequence[Site]) -> None:
        self._sites = sites
        self._hits: npt.NDArray[Any] = np.zeros(FIRST_ROOM, Hit)
        self._call: npt.NDArray[np.int64] | None = None
        self._last: npt.NDArray[np.int64] | None = None
        self.has_pending = self._has_sensors = False
        for site in sites:
            site.steppers.append(self)

    def halt(self) -> None:
        """Ask for the addresses of all blocks before the next step: some may be elsewhere then."""
        if self._call is not None:
            self._last, self._call = self._call, None

    def _ready(self) -> npt.NDArray[np.int64]:
        """Return the call of the kernel with the addresses of all blocks.

        Raises:
            InseparableError: two bodies have to bounce that no finite translation separates.
        """
        if self._call is None:
            for site in self._sites:
                site.check()
                self.has_pending |= len(site.pending) > 0
            self._has_sensors = any(site.setup.header.sensors for site in self._sites)
            blocks = [(site.state, site.inside, site.setup.workspace) for site in self._sites]
            self._call = call_of(blocks, self._hits, self._last)
        return self._call

    def step(self, dt: float, steps: int) -> npt.NDArray[Any]:
        """Step all worlds; return their hits, sorted by world and time.

        Raises:
            InseparableError: two bodies have to bounce that no finite translation separates.
            ValueError: if a position or velocity is too large, or has become so.
        """
        call = self._call
        if call is None:
            call = self._ready()
        count = step_worlds(call, 0, dt, steps)
        while count < 0:
            if count == INVALID:
                raise ValueError(
                    f"a position or velocity is not finite, or beyond {FARTHEST:g}: it was set so, "
                    "or has become too large; or the time has"
                )
            self._make_room(int(call[1]))
            call = self._ready()
            count = step_worlds(call, -1 - count, dt, steps)
        if count == 0 and not self.has_pending:
            return NO_HITS  # a slice would take a tenth of the time of a short step
        hits = self._hits[:count].copy()
        if self.has_pending:
            hits = self._with_pending(hits)
        if self._has_sensors and (hits["kind"] == END).any():
            # That a body left a sensor is known later than it happened.
            hits = hits[np.lexsort((hits["time"], hits["world"]))]
        return hits

    def _make_room(self, number: int) -> None:
        """Make room for more that is inside the sensors of a world, or for more hits."""
        if self._sites[number].make_room_inside():
            return
        hits = np.zeros(2 * len(self._hits), Hit)
        hits[: len(self._hits)] = self._hits
        self.halt()
        self._hits = hits

    def _with_pending(self, hits: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return hits after the events that edits have caused before."""
        parts = []
        for number, site in enumerate(self._sites):
            site.pending["world"] = number
            parts.append(site.pending)
            site.pending = NO_HITS
        self.has_pending = False
        return np.concatenate([*parts, hits])


def checked_step(dt: Any, steps: Any) -> tuple[float, int]:
    """Check the length of a step and the number of steps, and return them."""
    return not_negative("dt", dt), whole("steps", steps, at_least=1)
