"""Worlds that are stepped by one call of a kernel, and the memory that this takes."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from ...arguments import not_negative, whole
from ...kernels import entry_of
from ...tolerances import FARTHEST
from ..state.records import END, Hit
from ..stepping.step import INVALID, call_of, step_worlds, use_hits
from .site import NO_HITS, Site

FIRST_ROOM = 64  # hits; it grows as needed


@cache
def compiled_step() -> Callable[[int, int, float, int], int]:
    """Return `step_worlds` as it is called fastest."""
    return entry_of(step_worlds, "int64", "int64", "float64", "int64")


class Stepper:
    """Steps some worlds, one after the other.

    Args:
        sites: the worlds.

    Attributes:
        run: `step_worlds`; before the addresses of all blocks are known, what finds them first.
        address: the first argument of `run`.
        has_pending: whether edits of a world have caused events.
    """

    def __init__(self, sites: Sequence[Site]) -> None:
        self._sites = sites
        self._hits: npt.NDArray[Any] = np.zeros(FIRST_ROOM, Hit)
        self._bytes = self._hits.view(np.uint8).data
        self._call: npt.NDArray[np.int64] | None = None
        self.has_pending = self._has_sensors = False
        self.halt()
        for site in sites:
            site.steppers.append(self)

    def halt(self) -> None:
        """Ask for the addresses of all blocks before the next step: some may be elsewhere then."""
        self.run: Callable[[int, int, float, int], int] = self._get_ready_and_run
        self.address = 0

    def _get_ready_and_run(self, address: int, count: int, dt: float, steps: int) -> int:
        self._get_ready()
        return self.run(self.address, count, dt, steps)

    def _get_ready(self) -> None:
        """Find the addresses of all blocks.

        Raises:
            InseparableError: two bodies have to bounce that no finite translation separates.
        """
        for site in self._sites:
            site.check()
            self.has_pending |= len(site.pending) > 0
        self._has_sensors = any(site.setup.header.sensors for site in self._sites)
        blocks = [(site.state, site.inside, site.setup.workspace) for site in self._sites]
        self._call = call_of(blocks, self._hits, self._call)
        self.address = self._call.ctypes.data
        self.run = compiled_step()

    def step(self, dt: float, steps: int) -> npt.NDArray[Any]:
        """Step all worlds; return their hits, sorted by world and time.

        Raises:
            InseparableError: two bodies have to bounce that no finite translation separates.
            ValueError: if a position or velocity is too large, or has become so.
        """
        count = self.run(self.address, 0, dt, steps)
        return self.finish(count, dt, steps) if count or self.has_pending else NO_HITS

    def finish(self, count: int, dt: float, steps: int) -> npt.NDArray[Any]:
        """Finish what `run` has begun; return the hits.

        Args:
            count: what `run` has returned.
            dt, steps: as for `run`.
        """
        while count < 0:
            if count == INVALID:
                raise ValueError(
                    f"a position or velocity is not finite, or beyond {FARTHEST:g}: it was set so, "
                    "or has become too large; or the time has"
                )
            self._make_room()
            count = self.run(self.address, -1 - count, dt, steps)
        # NumPy copies records field by field, which takes several times as long.
        parts = bytearray(self._bytes[: count * Hit.itemsize])
        hits: npt.NDArray[Any] = np.ndarray((count,), Hit, parts)
        if self.has_pending:
            hits = self._with_pending(hits)
        if self._has_sensors and (hits["kind"] == END).any():
            # That a body left a sensor is known later than it happened.
            hits = hits[np.lexsort((hits["time"], hits["world"]))]
        return hits

    def _make_room(self) -> None:
        """Make room for more that is inside the sensors of a world, or for more hits."""
        if self._call is None or self._sites[int(self._call[1])].make_room_inside():
            return
        hits = np.zeros(2 * len(self._hits), Hit)
        hits[: len(self._hits)] = self._hits
        self._hits, self._bytes = hits, hits.view(np.uint8).data
        use_hits(self._call, hits)

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
