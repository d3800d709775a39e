"""`World`: many bodies, stepped from impact to impact, and what happened to them."""

import copy
import warnings
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..body import Body, FloatArray
from ..errors import HitLimitWarning, InseparableError
from ..protocols import Collidable
from ..shapes.colliders import AxisAlignedRectangle, Collider, Particle
from ..validation import finite, integer, inverse_mass, not_negative, vector, whole
from .queries import find_first, find_overlapping
from .records import Clock
from .setup import Item, Setup, build_setup, inseparable_pair, with_query
from .snapshots import pack_states, unpack_states
from .stepper import Stepper, checked_step

Indices = npt.NDArray[np.int64]

ALL = -1  # a mask of every category

# The attributes of a world as it is edited; what else it has is made from them.
_EDITABLE = (
    "_continuous",
    "_max_hits",
    "_items",
    "_places",
    "_overrides",
    "_inside",
    "_time",
    "_capped",
)


class RayHit(NamedTuple):
    """What a ray meets first.

    Attributes:
        body: its index.
        fraction: of the way, 0 at the start (also where it starts inside of the body) to 1.
        point: where the ray, or the centre of the disc that is cast, is then.
        normal: unit vector out of the body.
    """

    body: int
    fraction: float
    point: FloatArray
    normal: FloatArray


class World:
    """Bodies that move and collide.

    A body with a mass is *dynamic*. One without is *static*, or *kinematic* if it has a velocity:
    it moves, and nothing moves it. The world takes copies of a body's numbers, and leaves the body
    as it is.

    Every impact happens at its exact time, in the order of time, and the rest of the step goes on
    after it: nothing is tunnelled through at any speed, and no time is lost. Relaxation is for what
    overlaps when a step begins.

    Args:
        bodies: added one after the other, see `add`.
        continuous: if False, the lecture's procedure instead: move by dt, detect, relax, bounce.
        max_hits: of one body in one step. A body that has had them stays where it is for the rest
            of the step; `capped` counts that, and there is a `HitLimitWarning`. (Only what is
            squeezed, or very fast, comes near.)
    """

    def __init__(
        self, bodies: Iterable[Collidable] = (), *, continuous: bool = True, max_hits: int = 10_000
    ) -> None:
        self._continuous = bool(continuous)
        self._max_hits = whole("max_hits", max_hits, at_least=1)
        self._items: list[Item] = []
        self._places: list[list[float]] = []  # x, y, vx, vy; of what moves, while there is no setup
        self._overrides: dict[tuple[int, int], float] = {}
        self._inside: set[tuple[int, int]] = set()  # (sensor, body), while there is no setup
        self._time = (0.0, 0.0)  # see `clock_time`; while there is no setup
        self._capped = 0
        self._setup: Setup | None = None
        self._stepper: Stepper
        self._warned: int
        for body in bodies:
            self.add(body)

    def add(
        self, body: Collidable, *, category: int = 1, mask: int = ALL, sensor: bool = False
    ) -> int:
        """Add a body, or anything with a ``collider`` and a ``position``; return its index.

        Args:
            body: ``velocity``, ``mass`` and ``restitution`` count, too, if it has them.
            category: a bit, or several, of 63.
            mask: the categories that it meets. Two bodies meet if each one's mask has a bit of the
                other one's category.
            sensor: it is not solid: there are events when another body enters or leaves it.
        """
        if not isinstance(body, Collidable):
            raise TypeError(f"a body needs a collider and a position; {body!r} lacks one")
        if not isinstance(body.collider, Collider):
            raise TypeError(f"a collider is needed, such as Particle(1.0), not {body.collider!r}")
        place = vector("position", body.position)
        velocity = vector("velocity", getattr(body, "velocity", (0.0, 0.0)))
        mass = getattr(body, "mass", None)
        inverse_mass("mass", mass)
        item = Item(
            body.collider,
            None if mass is None else float(mass),
            not_negative("restitution", getattr(body, "restitution", 1.0)),
            _bits("category", category),
            _bits("mask", mask),
            bool(sensor),
        )
        self._unbuild()
        self._items.append(item)
        self._places.append([*place, *velocity])
        return len(self._items) - 1

    def remove(self, index: int) -> None:
        """Remove a body. The indices of later ones go down by one."""
        gone = self._index(index)
        self._unbuild()
        del self._items[gone]
        del self._places[gone]

        def renamed(pairs: Iterable[tuple[int, int]]) -> Iterable[tuple[int, int]]:
            return ((a - (a > gone), b - (b > gone)) for a, b in pairs)

        kept = {pair: e for pair, e in self._overrides.items() if gone not in pair}
        self._overrides = dict(zip(renamed(kept), kept.values(), strict=True))
        self._inside = set(renamed(pair for pair in self._inside if gone not in pair))

    def body(self, index: int) -> Body:
        """Return a body as it is now; changing it does not change the world."""
        item = self._items[self._index(index)]
        x, y, vx, vy = self._all_places()[index].tolist()
        return Body(item.collider, (x, y), (vx, vy), item.mass, item.restitution)

    def place(self, index: int, position: Any | None = None, velocity: Any | None = None) -> None:
        """Put a body somewhere, give it another velocity, or both.

        What it then overlaps is relaxed in the next step. A body put elsewhere is in no sensor yet.
        """
        number = self._index(index)
        new = [] if position is None else [(slice(0, 2), vector("position", position))]
        new += [] if velocity is None else [(slice(2, 4), vector("velocity", velocity))]
        slot = -1 if self._setup is None else int(self._setup.traits["slot"][number])
        if slot < 0:
            # What is static is part of the setup.
            self._unbuild()
        for columns, value in new:
            if slot < 0:
                self._places[number][columns] = value
            else:
                self._motions[slot, columns] = value
        if position is not None:
            self._forget_inside(number)

    def set_restitution(self, a: int, b: int, restitution: float | None) -> None:
        """Give a pair a restitution of its own, or again the product of its bodies' (None)."""
        first, second = sorted((self._index(a), self._index(b)))
        if first == second:
            raise ValueError(f"a pair is of two bodies, but both are {first}")
        if restitution is not None:
            restitution = not_negative("restitution", restitution)
        self._unbuild()
        self._overrides.pop((first, second), None)
        if restitution is not None:
            self._overrides[first, second] = restitution

    def __len__(self) -> int:
        return len(self._items)

    @property
    def positions(self) -> FloatArray:
        """Where all bodies are: float64 [n, 2], a copy, not to be written to (see `place`)."""
        return self._part(slice(0, 2))

    @property
    def velocities(self) -> FloatArray:
        """The velocities of all bodies: float64 [n, 2], a copy, not to be written to."""
        return self._part(slice(2, 4))

    @property
    def time(self) -> float:
        """How long the world has been stepped."""
        return self._time[0] if self._setup is None else float(self._clock["time"][0])

    @property
    def capped(self) -> int:
        """How often a body has used up its hits of a step."""
        return self._capped if self._setup is None else int(self._clock["capped"][0])

    def step(self, dt: float, steps: int = 1) -> npt.NDArray[Any]:
        """Let time go on by ``steps`` steps of ``dt``; return what happened.

        Returns:
            `Hit` records in the order of time: bounces (`HIT`), and bodies that enter (`BEGIN`) or
            leave (`END`) a sensor.

        Raises:
            InseparableError: no finite translation separates two solid bodies of which one moves.
            ValueError: ``dt`` is negative or not finite, or a body has outgrown the numbers.
        """
        length, number = checked_step(dt, steps)
        if self._setup is None:
            self._build()
        hits = self._stepper.step(length, number)
        if len(hits) and self.capped != self._warned:
            self._warned = self.capped
            warnings.warn(
                f"a body used up its {self._max_hits} hits of a step, and stayed where it was for "
                "the rest of it. It is squeezed, or so fast that it needs shorter steps or a "
                "larger max_hits",
                HitLimitWarning,
                stacklevel=2,
            )
        return hits

    def query_point(self, point: Any, mask: int = ALL) -> Indices:
        """Return the indices of the bodies that have a point inside."""
        return self._overlapping(Particle(0.0), vector("point", point), mask)

    def query_box(self, lower: Any, upper: Any, mask: int = ALL) -> Indices:
        """Return the indices of the bodies that overlap a box, given by two of its corners."""
        low, high = vector("lower", lower), vector("upper", upper)
        if not (low[0] < high[0] and low[1] < high[1]):
            raise ValueError(f"lower must be below and left of upper, but they are {low}, {high}")
        middle = (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]))
        return self._overlapping(
            AxisAlignedRectangle(high[0] - low[0], high[1] - low[1]), middle, mask
        )

    def query_ray(
        self, start: Any, end: Any, radius: float = 0.0, mask: int = ALL
    ) -> RayHit | None:
        """Return what a ray from start to end, or a disc cast along it, meets first; or None."""
        x, y = vector("start", start)
        way = np.subtract(vector("end", end), (x, y))
        setup = self._built()
        index, fraction, normal_x, normal_y = find_first(
            self._states[0],
            self._stepper.desk,
            *with_query(setup, Particle(radius)),
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

    def snapshot(self) -> bytes:
        """Return all that changes as the world is stepped: `restore` goes back to it."""
        setup = self._built()
        return pack_states(self._states, setup.desk)

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot of this world, or of one with the same bodies.

        Raises:
            ValueError: if it is corrupt, or of another world; this one stays as it is then.
        """
        setup = self._built()
        unpack_states(snapshot, self._states, setup.desk)
        self._warned = self.capped

    def __getstate__(self) -> dict[str, Any]:
        """Let a world be pickled and copied: as what it was built from, and a snapshot."""
        kept = {name: value for name, value in self.__dict__.items() if name in _EDITABLE}
        return {**kept, "snapshot": None if self._setup is None else self.snapshot()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        snapshot = state.pop("snapshot")
        self.__dict__.update(copy.deepcopy(state))
        self._setup = None
        if snapshot is not None:
            self.restore(snapshot)

    def memory(self) -> tuple[Setup, npt.NDArray[np.uint8]]:
        """Return what kernels step: the setup, and the state, uint8 [1, bytes], of this world."""
        return self._built(), self._states

    # What follows keeps two forms in step: the lists that are edited (`_items`, `_places`, ...),
    # and from the first step on the memory that is stepped (`_setup`, `_states`).

    def _built(self) -> Setup:
        if self._setup is None:
            self._build()
        assert self._setup is not None
        return self._setup

    def _build(self) -> None:
        """Make the memory that is stepped."""
        places = self._all_places()
        setup = build_setup(
            self._items,
            places[:, :2],
            places[:, 2:],
            self._overrides,
            self._max_hits,
            self._continuous,
        )
        pair = inseparable_pair(setup)
        if pair is not None:
            raise InseparableError(*(self.body(index) for index in pair))
        states = setup.new_state(1)
        motions = setup.motion_view(states)[0]
        motions[:] = places[setup.moving]
        setup.left_as_view(states)[0] = motions
        inside = self._inside_table(states, setup)
        for row, sensor in enumerate(setup.sensing.tolist()):
            for body in range(len(self._items)):
                inside[row, body] = (sensor, body) in self._inside
        self._built_places, self._states, self._motions = places, states, motions
        self._clock = states[0, : Clock.itemsize].view(Clock)
        self._clock["time"], self._clock["time_low"] = self._time
        self._clock["capped"] = self._capped
        self._warned = self._capped
        self._stepper = Stepper(setup, states)
        self._setup = setup

    def _unbuild(self) -> None:
        """Go back to what can be edited."""
        if self._setup is None:
            return
        self._places = self._all_places().tolist()
        rows, bodies = np.nonzero(self._inside_table(self._states, self._setup))
        self._inside = set(zip(self._setup.sensing[rows].tolist(), bodies.tolist(), strict=True))
        self._time = (float(self._clock["time"][0]), float(self._clock["time_low"][0]))
        self._capped = self.capped
        self._setup = None
        for name in ("_built_places", "_states", "_motions", "_clock", "_stepper", "_warned"):
            delattr(self, name)

    def _inside_table(self, states: Any, setup: Setup) -> npt.NDArray[np.uint8]:
        """Return a view of who is inside of which sensor, uint8 [sensors, bodies]."""
        view: npt.NDArray[np.uint8] = setup.inside_view(states)[0]
        return view

    def _forget_inside(self, number: int) -> None:
        """Let a body be inside of no sensor, and nothing inside of it."""
        self._inside = {pair for pair in self._inside if number not in pair}
        if self._setup is not None:
            inside = self._inside_table(self._states, self._setup)
            inside[:, number] = 0
            inside[self._setup.sensing == number] = 0
            self._clock["planned"] = 0

    def _all_places(self) -> FloatArray:
        """Return x, y, vx, vy of all bodies, float64 [n, 4], a copy."""
        if self._setup is None:
            return np.array(self._places, np.float64).reshape(-1, 4)
        places = self._built_places.copy()
        places[self._setup.moving] = self._motions
        return places

    def _part(self, columns: slice) -> FloatArray:
        part = np.ascontiguousarray(self._all_places()[:, columns])
        part.flags.writeable = False
        return part

    def _overlapping(self, shape: Collider, at: tuple[float, float], mask: int) -> Indices:
        setup = self._built()
        found = np.zeros(len(self._items), np.int64)
        count = find_overlapping(
            self._states[0],
            self._stepper.desk,
            *with_query(setup, shape),
            finite("x", at[0]),
            finite("y", at[1]),
            _bits("mask", mask),
            found,
        )
        return found[:count]

    def _index(self, index: Any) -> int:
        number = integer("the index of a body", index)
        if not 0 <= number < len(self._items):
            raise IndexError(f"there is no body {index!r}: there are {len(self._items)}")
        return number


def _bits(name: str, value: Any) -> int:
    """Return an integer of 64 bits."""
    number = integer(name, value)
    if not -(1 << 63) <= number < 1 << 63:
        raise ValueError(f"{name} must fit into 64 bits, but is {value!r}")
    return number
