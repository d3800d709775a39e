"""`WorldBatch`: copies of a world that are stepped together, by the kernel that steps one."""

import itertools
from concurrent.futures import ThreadPoolExecutor, wait
from typing import Any

import numpy as np
import numpy.typing as npt

from ..body import FloatArray
from ..validation import whole
from .records import Clock
from .snapshots import pack_states, unpack_states
from .stepper import Stepper, checked_step
from .world import World


class WorldBatch:
    """Copies of a world, each of which goes its own way.

    What moves has a place and velocity in each of them; what is static is shared. Each copy gives
    the same bits as the world alone would, for any number of copies and threads.

    Args:
        world: what to copy, as it is now. It stays as it is.
        num_worlds: how many.
        threads: that step them. Each takes a part of the worlds.

    Attributes:
        moving: int64 [m], the indices of the bodies that move.
        positions, velocities: float64 [num_worlds, m, 2], of these bodies. Views of the states:
            what is written there counts from the next step on. A body put elsewhere is in no
            sensor yet.
    """

    def __init__(self, world: World, num_worlds: int, *, threads: int = 1) -> None:
        count = whole("num_worlds", num_worlds, at_least=1)
        parts = min(count, whole("threads", threads, at_least=1))
        setup, state = world.memory()
        self._setup = setup
        self._states = np.repeat(state, count, axis=0)
        self.moving = setup.moving
        motions = setup.motion_view(self._states)
        self.positions: FloatArray = motions[:, :, :2]
        self.velocities: FloatArray = motions[:, :, 2:]
        bounds = np.linspace(0, count, parts + 1).astype(int)
        self._starts = bounds[:-1].tolist()
        self._steppers = [
            Stepper(setup, self._states[start:stop]) for start, stop in itertools.pairwise(bounds)
        ]
        self._pool = ThreadPoolExecutor(parts - 1, "arkanoid-worlds") if parts > 1 else None

    def __len__(self) -> int:
        return len(self._states)

    @property
    def times(self) -> FloatArray:
        """How long each world has been stepped, float64 [num_worlds], a copy."""
        return self._clocks()["time"].copy()

    @property
    def capped(self) -> npt.NDArray[np.int64]:
        """How often a body has used up its hits of a step, int64 [num_worlds], a copy."""
        return self._clocks()["capped"].copy()

    def step(self, dt: float, steps: int = 1) -> npt.NDArray[Any]:
        """Let time go on in every world by ``steps`` steps of ``dt``.

        Returns:
            `Hit` records, by world (field ``world``) and time, as `World.step` returns them.

        Raises:
            ValueError: ``dt`` is negative or not finite, or a body has outgrown the numbers.
        """
        length, number = checked_step(dt, steps)
        if self._pool is None:
            return self._steppers[0].step(length, number)
        running = [self._pool.submit(part.step, length, number) for part in self._steppers[1:]]
        try:
            first = self._steppers[0].step(length, number)
        finally:
            # Nobody is still at work when this returns, not even if it raises.
            wait(running)
        parts = [first, *(task.result() for task in running)]
        for start, part in zip(self._starts, parts, strict=True):
            part["world"] += start
        return np.concatenate(parts)

    def snapshot(self) -> bytes:
        """Return all that changes as the worlds are stepped: `restore` goes back to it."""
        return pack_states(self._states, self._setup.desk)

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot of a batch of this size of the same world.

        Raises:
            ValueError: if it is corrupt, or of another batch; this one stays as it is then.
        """
        unpack_states(snapshot, self._states, self._setup.desk)

    def close(self) -> None:
        """End the threads, if there are any."""
        if self._pool is not None:
            self._pool.shutdown()

    def _clocks(self) -> npt.NDArray[Any]:
        clocks: npt.NDArray[Any] = self._states[:, : Clock.itemsize].view(Clock)
        return clocks[:, 0]
