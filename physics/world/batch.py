"""`WorldBatch`: copies of a world that are stepped together, by the kernel that steps one."""

import itertools
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import whole
from ..body import FloatArray
from ..kernels.one_thread import OneThread
from ..kernels.threads import Threads
from .records import Clock
from .states import Stepper, checked_step, pack_states, unpack_states
from .world import World


class WorldBatch:
    """Copies of a world that develop independently.

    Each copy has its own moving bodies; static bodies are shared. Each copy gives the same bits as
    the world alone would, for any number of copies and threads.

    A batch belongs to one thread at a time: `step`, `snapshot` and `restore` raise a RuntimeError
    while another call of them is in progress.

    Args:
        world: the world to copy, as it is now. It does not change.
        num_worlds: the number of copies.
        threads: the number of threads that step them, each a part of the worlds.

    Attributes:
        moving: int64 [m], the indices of the bodies that move.
        positions, velocities: float64 [num_worlds, m, 2], of these bodies. Views of the states:
            write to them to change the next step.
    """

    def __init__(self, world: World, num_worlds: int, *, threads: int = 1) -> None:
        count = whole("num_worlds", num_worlds, at_least=1)
        parts = min(count, whole("threads", threads, at_least=1))
        setup, self._states, insides = world.copies(count)
        self._setup = setup
        self.moving = setup.moving
        motions = setup.motion_view(self._states)
        self.positions: FloatArray = motions[:, :, :2]
        self.velocities: FloatArray = motions[:, :, 2:]
        cuts = np.linspace(0, count, parts + 1).astype(int)
        self._starts = cuts[:-1].tolist()
        self._steppers = [
            Stepper(setup, self._states[start:stop], insides[start:stop])
            for start, stop in itertools.pairwise(cuts)
        ]
        self._threads = Threads("arkanoid-worlds")
        self._closed = False
        self._alone = OneThread("this batch of worlds")

    def __len__(self) -> int:
        return len(self._states)

    def __repr__(self) -> str:
        times = self.times
        first, last = f"{times.min():g}", f"{times.max():g}"
        when = first if first == last else f"{first} to {last}"
        bodies = f"moving bodies in each: {len(self.moving)}"
        return f"<WorldBatch of {len(self)} ({bodies}) at time {when}>"

    @property
    def times(self) -> FloatArray:
        """How long each world has been stepped, float64 [num_worlds], a copy."""
        return self._clocks()["time"].copy()

    @property
    def capped(self) -> npt.NDArray[np.int64]:
        """How often a body has used up its hits of a step, or had no room, int64 [num_worlds]."""
        return self._clocks()["capped"].copy()

    def step(self, dt: float, steps: int = 1) -> npt.NDArray[Any]:
        """Step every world ``steps`` times by ``dt``.

        Returns:
            `Hit` records, by world (field ``world``) and time, as `World.step` returns them.

        Raises:
            ValueError: ``dt`` is negative or not finite, or a position or velocity is beyond 1e140,
                or has become so.
            RuntimeError: the batch has several threads and is closed, or another call is in
                progress.
        """
        length, count = checked_step(dt, steps)
        alone = self._alone
        if alone.taken:
            alone.refuse()
        alone.taken = True
        try:
            if len(self._steppers) == 1:
                return self._steppers[0].step(length, count)
            return self._step_parts(length, count)
        finally:
            alone.taken = False

    def _step_parts(self, length: float, count: int) -> npt.NDArray[Any]:
        if self._closed:
            raise RuntimeError("step() after the shutdown of the batch's threads by close()")
        parts = self._threads.run(lambda part: part.step(length, count), self._steppers)
        for start, part in zip(self._starts, parts, strict=True):
            part["world"] += start
        return np.concatenate(parts)

    def snapshot(self) -> bytes:
        """Return all that changes as the worlds are stepped, as bytes for `restore`."""
        return self._alone.run(
            pack_states, self._states, [part.insides for part in self._steppers], self._setup
        )

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot of a batch of this size of the same world.

        Raises:
            ValueError: if it is corrupt, or of another batch. This batch does not change then.
        """
        self._alone.run(self._restore, snapshot)

    def _restore(self, snapshot: bytes) -> None:
        insides = unpack_states(snapshot, self._states, self._setup)
        for start, part in zip(self._starts, self._steppers, strict=True):
            part.insides = insides[start : start + len(part.insides)]

    def close(self) -> None:
        """End the threads, if there are any."""
        self._closed = True
        self._threads.close()

    def _clocks(self) -> npt.NDArray[Any]:
        clocks: npt.NDArray[Any] = self._states[:, : Clock.itemsize].view(Clock)
        return clocks[:, 0]
