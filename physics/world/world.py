"""`World`: many bodies, stepped from impact to impact, and what happened to them."""

import copy
import math
import warnings
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..arguments import finite, integer, inverse_mass, near, not_negative, vector, whole
from ..body import Body, FloatArray
from ..drawing import draw_scene
from ..errors import HitLimitWarning
from ..kernels.one_thread import OneThread, alone
from ..protocols import Collidable
from ..shapes.colliders import AxisAlignedRectangle, Collider, Particle
from .forms import Built, Scene
from .queries import find_first, find_overlapping
from .setup import BodySpec, ByteArray, Setup, with_query
from .states import checked_step, pack_states, unpack_states

IndexArray = npt.NDArray[np.int64]

ALL = -1  # a mask of every category


class RayHit(NamedTuple):
    """What a ray meets first.

    Attributes:
        body: its index.
        fraction: of the ray, from 0 at its start (also if it starts inside the body) to 1.
        point: where the ray, or the centre of the disc that is cast, is then.
        normal: unit vector out of the body.
    """

    body: int
    fraction: float
    point: FloatArray
    normal: FloatArray


class World:
    """Bodies that move and collide.

    A body with a mass is *dynamic*. A body without mass is *static*, or *kinematic* if it has a
    velocity: it moves, but collisions do not change its motion. The world takes a copy of a body's
    numbers, and never changes the body itself.

    Every impact happens at its exact time, in the order of time, and the step continues after it:
    no body tunnels through another at any speed, and no time is lost. Relaxation is for bodies that
    overlap when a step begins.

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
    """

    def __init__(
        self, bodies: Iterable[Collidable] = (), *, continuous: bool = True, max_hits: int = 10_000
    ) -> None:
        # The scene holds what users edit. From the first step on, until the next edit, the built
        # form is ahead of it.
        self._scene = Scene(bool(continuous), whole("max_hits", max_hits, at_least=1))
        self._built: Built | None = None
        self._alone = OneThread("this world")
        for body in bodies:
            self.add(body)

    @alone
    def add(
        self, body: Collidable, *, category: int = 1, mask: int = ALL, sensor: bool = False
    ) -> int:
        """Add a body, or anything with a ``collider`` and a ``position``; return its index.

        Args:
            body: its ``velocity``, ``mass`` and ``restitution`` are used, too, if it has them.
            category: one or several of 63 bits.
            mask: the categories that it meets. Two bodies meet if each one's mask has a bit of the
                other one's category.
            sensor: it is not solid: there are events when another body enters or leaves it.
        """
        if not isinstance(body, Collidable):
            raise TypeError(f"a body needs a collider and a position; {body!r} lacks one")
        if not isinstance(body.collider, Collider):
            raise TypeError(f"a collider is needed, such as Particle(1.0), not {body.collider!r}")
        position = vector("position", body.position)
        velocity = vector("velocity", getattr(body, "velocity", (0.0, 0.0)))
        mass = getattr(body, "mass", None)
        inverse_mass("mass", mass)
        spec = BodySpec(
            body.collider,
            None if mass is None else float(mass),
            not_negative("restitution", getattr(body, "restitution", 1.0)),
            _bits("category", category),
            _bits("mask", mask),
            bool(sensor),
        )
        scene = self._edit()
        scene.specs.append(spec)
        scene.motions.append([*position, *velocity])
        return len(scene.specs) - 1

    @alone
    def remove(self, index: int) -> None:
        """Remove a body. The indices of later ones go down by one."""
        checked = self._index(index)
        self._edit().remove(checked)

    @alone
    def body(self, index: int) -> Body:
        """Return a body as it is now; changing it does not change the world."""
        return self._scene.body(self._index(index), self._all_motions())

    @alone
    def place(self, index: int, position: Any | None = None, velocity: Any | None = None) -> None:
        """Put a body somewhere, give it another velocity, or both.

        The next step relaxes the overlaps that this makes. It begins with an `END` for each sensor
        that the body is no longer inside, and a `BEGIN` for each that it is now inside.
        """
        body = self._index(index)
        changes = [] if position is None else [(slice(0, 2), vector("position", position))]
        changes += [] if velocity is None else [(slice(2, 4), vector("velocity", velocity))]
        slot = -1 if self._built is None else int(self._built.setup.traits["slot"][body])
        if self._built is not None and slot >= 0:
            for columns, value in changes:
                self._built.motions[slot, columns] = value
        else:
            # A static body is part of the setup, which is built again.
            scene = self._edit()
            for columns, value in changes:
                scene.motions[body][columns] = value

    @alone
    def set_restitution(self, a: int, b: int, restitution: float | None) -> None:
        """Give a pair its own restitution, or again the product of its bodies' values (None)."""
        first, second = sorted((self._index(a), self._index(b)))
        if first == second:
            raise ValueError(f"a pair is of two bodies, but both are {first}")
        if restitution is not None:
            restitution = not_negative("restitution", restitution)
        scene = self._edit()
        scene.overrides.pop((first, second), None)
        if restitution is not None:
            scene.overrides[first, second] = restitution

    def __len__(self) -> int:
        return len(self._scene.specs)

    @property
    @alone
    def positions(self) -> FloatArray:
        """The positions of all bodies: float64 [n, 2], a read-only copy (see `place`)."""
        return self._columns(slice(0, 2))

    @property
    @alone
    def velocities(self) -> FloatArray:
        """The velocities of all bodies: float64 [n, 2], a read-only copy (see `place`)."""
        return self._columns(slice(2, 4))

    @property
    def time(self) -> float:
        """How long the world has been stepped."""
        if self._built is None:
            return self._scene.time[0]
        return float(self._built.clock["time"][0])

    @property
    def capped(self) -> int:
        """How often a body has used up its hits of a step, or had no room."""
        return (self._built or self._scene).capped

    def step(self, dt: float, steps: int = 1) -> npt.NDArray[Any]:
        """Step the world ``steps`` times by ``dt``; return what happened.

        Returns:
            `Hit` records in the order of time: bounces (`HIT`), and bodies that enter (`BEGIN`) or
            leave (`END`) a sensor.

        Raises:
            InseparableError: no finite translation separates two solid bodies of which one moves.
            ValueError: ``dt`` is negative or not finite, or a position or velocity has become too
                large for a number.
            RuntimeError: another call is in progress.
        """
        # Most steps save this call, and the next but one.
        if not (type(dt) is float and 0.0 <= dt < math.inf and type(steps) is int and steps == 1):
            dt, steps = checked_step(dt, steps)
        guard = self._alone
        if guard.taken:
            guard.refuse()
        guard.taken = True
        try:
            built = self._built or self.built()
            hits = built.stepper.step(dt, steps)
        finally:
            guard.taken = False
        if len(hits) and built.capped != built.warned:
            built.warned = built.capped
            warnings.warn(
                "a body has no room, or used up the hits of a step (max_hits="
                f"{self._scene.max_hits}); for the rest of it, it did not bounce. If it is only "
                "very fast, it needs shorter steps or a larger max_hits",
                HitLimitWarning,
                stacklevel=2,
            )
        return hits

    @alone
    def query_point(self, point: Any, mask: int = ALL) -> IndexArray:
        """Return the indices of the bodies that contain a point."""
        return self._overlapping(Particle(0.0), near("point", point), mask)

    @alone
    def query_box(self, lower: Any, upper: Any, mask: int = ALL) -> IndexArray:
        """Return the indices of the bodies that overlap a box, from its lower left corner up."""
        low, high = near("lower", lower), near("upper", upper)
        if not (low[0] < high[0] and low[1] < high[1]):
            raise ValueError(f"lower must be below and left of upper, but they are {low}, {high}")
        middle = (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]))
        return self._overlapping(
            AxisAlignedRectangle(high[0] - low[0], high[1] - low[1]), middle, mask
        )

    @alone
    def query_ray(
        self, start: Any, end: Any, radius: float = 0.0, mask: int = ALL
    ) -> RayHit | None:
        """Return what a ray from start to end, or a disc cast along it, meets first; or None.

        A ray that enters a body at a corner meets it; one that only grazes a corner or runs along
        a side does not. At a corner the normal points against the ray, but is turned no further
        than the normals of the corner's sides.
        """
        x, y = near("start", start)
        way = np.subtract(near("end", end), (x, y))
        built = self.built()
        index, fraction, normal_x, normal_y = find_first(
            built.states[0],
            built.stepper.workspace,
            *with_query(built.setup, Particle(radius)),
            x,
            y,
            float(way[0]),
            float(way[1]),
            _bits("mask", mask),
        )
        if index < 0:
            return None
        point = np.add((x, y), fraction * way)
        return RayHit(int(index), float(fraction), point, np.array((-normal_x, -normal_y)))

    @alone
    def snapshot(self) -> bytes:
        """Return all that changes as the world is stepped, as bytes for `restore`."""
        built = self.built()
        return pack_states(built.states, [built.stepper.insides], built.setup)

    @alone
    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot of this world, or of one with the same bodies.

        Raises:
            ValueError: if it is corrupt, or of another world. This world does not change then.
        """
        built = self.built()
        built.stepper.insides = unpack_states(snapshot, built.states, built.setup)
        built.warned = built.capped

    @alone
    def copies(self, count: int) -> tuple[Setup, ByteArray, ByteArray]:
        """Return what does not change as the world is stepped, and copies of what does.

        Returns:
            (setup, states, insides), both uint8 [count, bytes].
        """
        built = self.built()
        insides = np.repeat(built.stepper.insides, count, axis=0)
        return built.setup, np.repeat(built.states, count, axis=0), insides

    def built(self) -> Built:
        """Return the form of the world that kernels step; it is built if need be."""
        if self._built is None:
            self._built = Built(self._scene)
        return self._built

    def __repr__(self) -> str:
        dynamic = sum(spec.mass is not None for spec in self._scene.specs)
        sensors = sum(spec.is_sensor for spec in self._scene.specs)
        kinds = f"{dynamic} dynamic, {sensors} sensors"
        return f"<World of {len(self)} bodies ({kinds}) at time {self.time:g}>"

    def draw(self, hits: Iterable[Any] = (), paths: Any = (), width: int = 480) -> str:
        """Return a picture of the bodies as SVG; static ones are grey, sensors are dashed.

        Args:
            hits: `Hit` records; each one's point and normal are drawn.
            paths: positions of all bodies at several times, [times, n, 2], for example a list of
                `positions`; the ways between them are drawn.
            width: of the picture, in pixels.
        """
        looks = [
            "sensor" if spec.is_sensor else "static" if spec.mass is None else "dynamic"
            for spec in self._scene.specs
        ]
        colliders = [spec.collider for spec in self._scene.specs]
        return draw_scene(colliders, self.positions, looks, hits, paths, width)

    def _repr_svg_(self) -> str:
        """Return the picture that notebooks show."""
        return self.draw()

    def __getstate__(self) -> dict[str, Any]:
        """Support pickling and copying: what the world was built from, and a snapshot."""
        snapshot = None if self._built is None else self.snapshot()
        return {"scene": self._scene, "snapshot": snapshot}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._scene = copy.deepcopy(state["scene"])
        self._built = None
        self._alone = OneThread("this world")
        if state["snapshot"] is not None:
            self.restore(state["snapshot"])

    def _edit(self) -> Scene:
        """Return the scene, up to date and free to be edited; give up the built form."""
        if self._built is not None:
            self._built.write_back(self._scene)
            self._built = None
        return self._scene

    def _all_motions(self) -> FloatArray:
        """Return x, y, vx, vy of all bodies, float64 [n, 4], a copy."""
        return (self._built or self._scene).all_motions()

    def _columns(self, columns: slice) -> FloatArray:
        part = np.ascontiguousarray(self._all_motions()[:, columns])
        part.flags.writeable = False
        return part

    def _overlapping(self, shape: Collider, position: tuple[float, float], mask: int) -> IndexArray:
        built = self.built()
        found = np.zeros(len(self), np.int64)
        count = find_overlapping(
            built.states[0],
            built.stepper.workspace,
            *with_query(built.setup, shape),
            finite("x", position[0]),
            finite("y", position[1]),
            _bits("mask", mask),
            found,
        )
        return found[:count]

    def _index(self, index: Any) -> int:
        """Check the index of a body, and return it."""
        checked = integer("the index of a body", index)
        if not 0 <= checked < len(self):
            raise IndexError(f"there is no body {index!r}: there are {len(self)}")
        return checked


def _bits(name: str, value: Any) -> int:
    """Return an integer of 64 bits."""
    bits = integer(name, value)
    if not -(1 << 63) <= bits < 1 << 63:
        raise ValueError(f"{name} must fit into 64 bits, but is {value!r}")
    return bits
