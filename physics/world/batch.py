"""`WorldBatch`: copies of a world that are stepped together, by the kernel that steps one."""

import itertools
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from ..arguments import integer, whole
from ..body import FloatArray
from ..kernels.one_thread import OneThread
from ..kernels.threads import Threads
from .memory.snapshots import pack, unpack
from .memory.stepper import Stepper, checked_step
from .state.records import Clock
from .world import World


class WorldBatch:
    """Copies of a world that develop independently.

    Each copy has its own bodies: ``batch[i]`` is a `World`, with all that it offers. Copies that
    were never edited share what edits change, so a batch takes little memory. Each copy gives the
    same bits as the world alone would, for any number of copies and threads.

    A batch belongs to one thread at a time, with all its worlds: a method raises a RuntimeError
    while another one is in progress.

    Args:
        world: the world to copy, as it is now. It does not change.
        num_worlds: the number of copies.
        threads: the number of threads that step them, each a part of the worlds.
    """

    def __init__(self, world: World, num_worlds: int, *, threads: int = 1) -> None:
        count = whole("num_worlds", num_worlds, at_least=1)
        parts = min(count, whole("threads", threads, at_least=1))
        self._family = world.copies(count, parts)
        sites = self._family.sites
        self._starts = [
            row for row, site in enumerate(sites) if row == 0 or site.part != sites[row - 1].part
        ]
        self._steppers = [
            Stepper(sites[start:stop]) for start, stop in itertools.pairwise([*self._starts, count])
        ]
        self._worlds: dict[int, World] = {}
        self._threads = Threads("arkanoid-worlds")
        self._closed = False
        self._alone = OneThread("this batch of worlds")

    def __getitem__(self, index: int) -> World:
        """Return one of the worlds. It is part of the batch: what changes it changes the batch."""
        number = range(len(self))[integer("the index of a world", index)]
        if number not in self._worlds:
            self._worlds[number] = World.at(self._family.sites[number], self._alone)
        return self._worlds[number]

    @property
    def handles(self) -> npt.NDArray[np.int64]:
        """The handles of the bodies that move, int64 [num_worlds, m]; -1 for an unused row.

        A row is a body's until it is removed or ceases to move; then the last row of its world
        takes its place. Static bodies have no row: see ``batch[i].positions``.
        """
        handles = np.full((len(self), self._family.movers_room), -1)
        for own, site in zip(handles, self._family.sites, strict=True):
            moving = site.setup.moving
            own[: len(moving)] = site.setup.entries["handle"][moving]
        return handles

    @property
    def positions(self) -> FloatArray:
        """The positions of the bodies in `handles`, float64 [num_worlds, m, 2].

        This is a view of the states: write to it to change the next step. It is live until a world
        gets more bodies that move than there is room for; ask again then.
        """
        return self._motions()[:, :, :2]

    @property
    def velocities(self) -> FloatArray:
        """The velocities of the same bodies, as `positions`."""
        return self._motions()[:, :, 2:]

    def _motions(self) -> FloatArray:
        return self._family.sites[0].setup.motion_view(self._family.states)

    def __len__(self) -> int:
        return len(self._family.sites)

    def __repr__(self) -> str:
        times = self.times
        first, last = f"{times.min():g}", f"{times.max():g}"
        when = first if first == last else f"{first} to {last}"
        most = max(int(site.setup.header.movers) for site in self._family.sites)
        bodies = f"moving bodies in each: {most}"
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
        """Return all that steps and edits change, as bytes for `restore`."""
        return self._alone.run(pack, self._family.sites)

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot of a batch of this size of worlds with the same shapes.

        Raises:
            ValueError: if it is corrupt, or of another batch. This batch does not change then.
        """
        self._alone.run(unpack, snapshot, self._family)

    def __reduce__(self) -> NoReturn:
        """Say what to do instead of pickling or copying: a batch has threads."""
        raise TypeError(
            "a WorldBatch cannot be pickled or copied: make another one of the same world, and "
            "restore a snapshot of this one"
        )

    def close(self) -> None:
        """End the threads, if there are any."""
        self._closed = True
        self._threads.close()

    def _clocks(self) -> npt.NDArray[Any]:
        clocks: npt.NDArray[Any] = self._family.states[:, : Clock.itemsize].view(Clock)
        return clocks[:, 0]
