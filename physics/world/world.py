"""`World`: many bodies, stepped from impact to impact, and what happened to them."""

import math
import warnings
from collections.abc import Iterable
from types import EllipsisType
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import inverse_mass, near_each, not_negative, vector, whole
from ..body import Body
from ..errors import HitLimitWarning
from ..kernels.one_thread import OneThread, alone
from ..protocols import Collidable
from ..shapes.colliders import Collider
from .memory.setup import Room, Setup
from .memory.site import NO_HITS, Family, Site, copied
from .memory.snapshots import pack, unpack
from .memory.stepper import Stepper, checked_step
from .questions import ALL, Handles, IndexArray, Questions, bits
from .state.records import ON

INF = math.inf
FIRST_ROOM = Room(bodies=8, movers=8, shapes=4, edges=16)  # of a world


class World(Questions):
    """Bodies that move and collide.

    A body with a mass is *dynamic*. A body without mass is *static*, or *kinematic* if it has a
    velocity: it moves, but collisions do not change its motion. The world takes a copy of a body's
    numbers, and never changes the body itself.

    Every impact happens at its exact time, in the order of time, and the step continues after it:
    no body tunnels through another at any speed, and no time is lost. Relaxation is for bodies that
    overlap when a step begins.

    A body is named by its **handle**, an integer that `add` returns. In a world from which nothing
    was removed, handles are 0, 1, 2 ... The index of a removed body, the low 32 bits of its handle,
    serves again for another body, with another handle. So the handle of a removed body is never
    the one of another body: it raises a `NoBodyError`. The cost of an edit depends on what is
    around the body, and not on the number of bodies.

    A world belongs to one thread at a time: while a method is running, each other one raises a
    RuntimeError.

    Args:
        bodies: added in this order, see `add`.
        continuous: if False, each step is the procedure of the lecture on collisions in games
            instead: move by dt, detect, relax, bounce.
        max_hits: of one body in one step. A body that has used them up bounces no more in that
            step: it rests on what it hits. `capped` counts that, and there is a `HitLimitWarning`.
            A hit counts tenfold if its bodies have gone less than 1e-4 of their size to it, or if
            the whole world has had ``max_hits`` in this step. (So a game does not wait long for
            bodies that are squeezed, or very fast.)
        rest_speed: two bodies that approach no faster than this do not bounce, if their restitution
            e is below 1: they rest on each other. With gravity g and steps dt, everything comes to
            rest from g * dt / (1 - e) on.

    Raises:
        ValueError: if ``max_hits`` is below 1, or ``rest_speed`` is negative or not finite.
    """

    def __init__(
        self,
        bodies: Iterable[Collidable] = (),
        *,
        continuous: bool = True,
        max_hits: int = 10_000,
        rest_speed: float = 0.0,
    ) -> None:
        self._max_hits = whole("max_hits", max_hits, at_least=1)
        slow = not_negative("rest_speed", rest_speed)
        setup = Setup(FIRST_ROOM, self._max_hits, slow, bool(continuous))
        self._use(Family([setup], [0]).sites[0], OneThread("this world"))
        for body in bodies:
            self.add(body)

    def _use(self, site: Site, guard: OneThread) -> None:
        self.site = site
        self._stepper = Stepper([site])
        self._alone = guard

    @classmethod
    def at(cls, site: Site, guard: OneThread) -> "World":
        """Return the world whose blocks are given, which a batch steps, too."""
        world = cls.__new__(cls)
        world._max_hits = int(site.setup.header.max_hits)
        world._use(site, guard)
        return world

    @alone
    def add(
        self, body: Collidable, *, category: int = 1, mask: int = ALL, sensor: bool = False
    ) -> int:
        """Add a body, or anything with a ``collider`` and a ``position``; return its handle.

        Args:
            body: its ``velocity``, ``mass`` and ``restitution`` are used, too, if it has them.
            category: one or several of 64 bits; with 0 it meets nothing, and no query finds it.
            mask: the categories that it meets. Two bodies meet if each one's mask has a bit of the
                other one's category.
            sensor: it is not solid: there are events when another body enters or leaves it.
        """
        if type(body) is not Body and not isinstance(body, Collidable):
            raise TypeError(f"a body needs a collider and a position; {body!r} lacks one")
        if not isinstance(body.collider, Collider):
            raise TypeError(f"a collider is needed, such as Particle(1.0), not {body.collider!r}")
        position = vector("position", body.position)
        velocity = vector("velocity", getattr(body, "velocity", (0.0, 0.0)))
        mass = getattr(body, "mass", None)
        inverse = inverse_mass("mass", mass)
        return self.site.add(
            body.collider,
            (*position, *velocity),
            math.inf if mass is None else float(mass),
            inverse,
            not_negative("restitution", getattr(body, "restitution", 1.0)),
            bits("category", category),
            bits("mask", mask),
            bool(sensor),
        )

    @alone
    def remove(self, handle: int) -> None:
        """Remove a body. All other handles stay as they are.

        For each sensor that it was inside, and for each body inside it if it was a sensor, the next
        step begins with an `END`, which names the handles that there were.
        """
        self.site.remove(self._index(handle))

    @alone
    def place(
        self, handle: Handles, position: Any | None = None, velocity: Any | None = None
    ) -> None:
        """Put a body somewhere, give it another velocity, or both; or several bodies at once.

        The next step relaxes the overlaps that this makes. It begins with an `END` for each sensor
        that the body is no longer inside, and a `BEGIN` for each that it is now inside.

        Args:
            handle: of the body; or of several, int64 [n].
            position, velocity: (x, y); of several bodies float64 [n, 2], or (x, y) for all of them.
        """
        if type(handle) is not int and np.ndim(handle):
            self._place_all(self._indices(handle), position, velocity)
            return
        index = self._index(handle)
        motion = self.site.place_of(index)
        if position is not None:
            motion[:2] = vector("position", position)
        if velocity is not None:
            motion[2:] = vector("velocity", velocity)
        self.site.place(index, motion)

    def _place_all(self, indices: IndexArray, position: Any | None, velocity: Any | None) -> None:
        """Place several bodies."""
        motions = np.empty((len(indices), 4))
        for first, name, given in ((0, "position", position), (2, "velocity", velocity)):
            motions[:, first : first + 2] = (
                self.site.places(indices, first)
                if given is None
                else near_each(name, given, len(indices))
            )
        self.site.place_all(indices, motions)

    @alone
    def change(
        self,
        handle: int,
        *,
        mass: float | EllipsisType | None = ...,
        restitution: float | None = None,
        category: int | None = None,
        mask: int | None = None,
        sensor: bool | None = None,
        active: bool | None = None,
    ) -> None:
        """Change what a body is; what is not given stays.

        What the body is no longer inside by that, or the other way round, ends as with `remove`.

        Args:
            handle: the body's.
            mass: or None for a body that collisions do not move.
            restitution, category, mask, sensor: as for `add`.
            active: a body that is not active stays where it is, meets nothing, and no query finds
                it. It keeps its handle, and its velocity for later.
        """
        index, site = self._index(handle), self.site
        trait, entry = site.setup.traits[index], site.setup.entries[index]
        new_mass, inverse = float(entry["mass"]), float(trait["inverse_mass"])
        if not isinstance(mass, EllipsisType):
            inverse = inverse_mass("mass", mass)
            new_mass = math.inf if mass is None else float(mass)
        elasticity = None if restitution is None else not_negative("restitution", restitution)
        is_on = bool(entry["state"] == ON) if active is None else bool(active)
        masks = (
            int(trait["category"]) if category is None else bits("category", category),
            int(trait["mask"]) if mask is None else bits("mask", mask),
            bool(trait["sensor"] >= 0) if sensor is None else bool(sensor),
        )
        if elasticity is not None:
            site.set_restitution(index, elasticity)
        if any(value is not None for value in (category, mask, sensor, active)) or mass is not ...:
            site.change(index, is_on, new_mass, inverse, *masks)

    @alone
    def set_restitution(self, a: int, b: int, restitution: float | None) -> None:
        """Give a pair its own restitution, or again the product of its bodies' values (None)."""
        first, second = sorted((self._index(a), self._index(b)))
        if first == second:
            raise ValueError(f"a pair is of two bodies, but both are {a}")
        value = math.nan if restitution is None else not_negative("restitution", restitution)
        self.site.override(min(int(a), int(b)), max(int(a), int(b)), value)

    def step(self, dt: float, steps: int = 1) -> npt.NDArray[Any]:
        """Step the world ``steps`` times by ``dt``; return what happened.

        Returns:
            `Hit` records in the order of time: bounces (`HIT`), and bodies that enter (`BEGIN`) or
            leave (`END`) a sensor. Their handles may be of bodies that were removed since. An END
            that an edit has caused, see `remove`, has the time of the edit; these come first, in
            the order of their bodies' indices.

        Raises:
            InseparableError: no finite translation separates two solid bodies of which one moves.
            ValueError: ``dt`` is negative or not finite, or a position or velocity is beyond 1e140,
                or has become so.
            RuntimeError: another call is in progress.
        """
        # Most steps save this call, and the next but one.
        if not (type(dt) is float and 0.0 <= dt < INF and type(steps) is int and steps == 1):
            dt, steps = checked_step(dt, steps)
        guard, stepper = self._alone, self._stepper
        if guard.taken:
            guard.refuse()
        guard.taken = True
        try:
            # What `stepper.step` does: to call it would take a sixth of the time of a short step.
            count = stepper.run(stepper.address, 0, dt, steps)
            if not count and not stepper.has_pending:
                return NO_HITS
            hits = stepper.finish(count, dt, steps)
        finally:
            guard.taken = False
        site = self.site
        if len(hits) and site.capped.item() != site.warned:
            site.warned = site.capped.item()
            warnings.warn(
                "a body has no room, or used up the hits of a step (max_hits="
                f"{self._max_hits}); for the rest of it, it did not bounce. If it is only "
                "very fast, it needs shorter steps or a larger max_hits",
                HitLimitWarning,
                stacklevel=2,
            )
        return hits

    @alone
    def snapshot(self) -> bytes:
        """Return all that steps and edits change, as bytes for `restore`."""
        return pack([self._checked()])

    @alone
    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot of this world, or of another one with the same shapes.

        Its bodies have the handles then that they had when it was taken.

        Raises:
            ValueError: if it is corrupt, has another ``max_hits``, ``rest_speed`` or
                ``continuous``, or shapes that no body of this world ever had. This world does not
                change then.
        """
        if self.site.family.sites != [self.site]:
            raise ValueError("this world is part of a batch: restore a snapshot of the batch")
        unpack(snapshot, self.site.family)

    @alone
    def copies(self, count: int, parts: int) -> Family:
        """Return copies of this world, in so many parts, each of which one thread steps."""
        return copied(self._checked(), count, parts)

    def __getstate__(self) -> dict[str, Any]:
        """Support pickling and copying: the shapes, and a snapshot."""
        setup = self.site.setup
        return {
            "colliders": tuple(setup.colliders),
            "continuous": bool(setup.header.continuous),
            "max_hits": self._max_hits,
            "rest_speed": float(setup.header.rest_speed),
            "snapshot": self._alone.run(pack, [self.site]),
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        names = ("continuous", "max_hits", "rest_speed")
        World.__init__(self, **{name: state[name] for name in names})
        for collider in state["colliders"]:
            self.site.setup.add_collider(collider)
        self.restore(state["snapshot"])
