"""What one may ask of a world: its bodies, what is where, what a ray meets, how it looks."""

import math
from collections.abc import Iterable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ..arguments import finite, integer, near_all, vector
from ..body import Body, FloatArray
from ..drawing import draw_scene
from ..errors import NoBodyError
from ..kernels.one_thread import OneThread, alone
from ..shapes.colliders import AxisAlignedRectangle, Collider, Particle
from .memory.site import Site
from .queries.answers import RayHit, RayHits, answer_of, answers_of, new_ray, new_rays
from .queries.finding import find_first, find_overlapping
from .state.records import INDEX_MASK, UNUSED

IndexArray = npt.NDArray[np.int64]

Handles: TypeAlias = int | npt.ArrayLike

ALL = -1  # a mask of every category
POINT = Particle(0.0)


class Questions:
    """The part of a `World` that changes nothing.

    Attributes:
        site: the blocks of bytes that kernels see.
    """

    site: Site
    _alone: OneThread

    def __len__(self) -> int:
        return int(self.site.setup.header.living)

    def __contains__(self, handle: object) -> bool:
        """Return whether a handle names a body that was not removed."""
        try:
            self._index(handle)
        except KeyError:
            return False
        return True

    @property
    @alone
    def handles(self) -> IndexArray:
        """The handles of all bodies, int64 [n], in the order of their indices; a copy."""
        handles: IndexArray = self.site.setup.entries["handle"][self.site.living]
        return handles

    @property
    @alone
    def positions(self) -> FloatArray:
        """The positions of all bodies: float64 [n, 2], a read-only copy (see `place`).

        Row i is of the body ``handles[i]``. For one body, or some, `position` is faster.
        """
        return _read_only(self.site.places(self.site.living, 0))

    @property
    @alone
    def velocities(self) -> FloatArray:
        """The velocities of all bodies, as `positions`; of inactive ones, what they keep."""
        return _read_only(self.site.places(self.site.living, 2))

    @property
    def time(self) -> float:
        """How long the world has been stepped."""
        return float(self.site.clock.time)

    @property
    def capped(self) -> int:
        """How often a body has used up its hits of a step, or had no room."""
        return int(self.site.clock.capped)

    @alone
    def position(self, handle: Handles) -> FloatArray:
        """The position of a body, float64 [2], or of several, [n, 2]; a copy."""
        return self._place_of(handle, 0)

    @alone
    def velocity(self, handle: Handles) -> FloatArray:
        """The velocity of a body, as `position`."""
        return self._place_of(handle, 2)

    @alone
    def body(self, handle: int) -> Body:
        """Return a body as it is now; changing it does not change the world."""
        return self.site.body(self._index(handle))

    @alone
    def query_point(self, point: Any, mask: int = ALL) -> IndexArray:
        """Return the handles of the bodies that contain a point; on a border it is in no body."""
        return self._overlapping(POINT, vector("point", point), mask)

    @alone
    def query_box(self, lower: Any, upper: Any, mask: int = ALL) -> IndexArray:
        """Return the handles of the bodies that overlap a box, from its lower left corner up."""
        low, high = vector("lower", lower), vector("upper", upper)
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
        a side does not. One that would enter if it were longer meets it at its end. At a corner the
        normal points against the ray, but is turned no further than the normals of the corner's
        sides. A ray along the border of two polygons, or half-planes, is inside of both together:
        it meets them where the border begins.
        """
        ray = new_ray(*vector("start", start), *vector("end", end))
        self._cast(ray, radius, mask)
        return answer_of(ray)

    @alone
    def query_rays(self, starts: Any, ends: Any, radius: float = 0.0, mask: int = ALL) -> RayHits:
        """Return what many rays meet first, with the answers of `query_ray`, but much faster.

        Args:
            starts, ends: float64 [n, 2].
            radius, mask: of all rays.
        """
        rays = new_rays(near_all("starts", starts), near_all("ends", ends))
        self._cast(rays, radius, mask)
        return answers_of(rays)

    def __repr__(self) -> str:
        living = self.site.living
        dynamic = int((self.site.setup.entries["mass"][living] < math.inf).sum())
        sensors = int((self.site.setup.traits["sensor"][living] >= 0).sum())
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
        setup, living = self.site.setup, self.site.living
        looks = [
            "sensor" if trait["sensor"] >= 0 else "static" if mass == math.inf else "dynamic"
            for trait, mass in zip(setup.traits[living], setup.entries["mass"][living], strict=True)
        ]
        colliders = [setup.colliders[number] for number in setup.traits["collider"][living]]
        return draw_scene(colliders, self.positions, looks, hits, paths, width)

    def _repr_svg_(self) -> str:
        """Return the picture that notebooks show."""
        return self.draw()

    def _checked(self) -> Site:
        """Return this world's blocks, if all bodies that have to bounce can be separated."""
        self.site.check()
        return self.site

    def _cast(self, rays: npt.NDArray[Any], radius: float, mask: int) -> None:
        """Let rays, or discs that are cast along them, meet bodies."""
        shape = POINT if type(radius) is float and radius == 0.0 else Particle(radius)
        rays["room"] = shape.rounding
        site = self._checked()
        find_first(
            site.state,
            site.setup.workspace,
            *site.setup.tables_with(shape),
            rays.view(np.uint8),
            bits("mask", mask),
        )

    def _overlapping(self, shape: Collider, position: tuple[float, float], mask: int) -> IndexArray:
        site = self._checked()
        found = np.zeros(int(site.setup.header.bodies), np.int64)
        count = find_overlapping(
            site.state,
            site.setup.workspace,
            *site.setup.tables_with(shape),
            finite("x", position[0]),
            finite("y", position[1]),
            bits("mask", mask),
            found,
        )
        return found[:count]

    def _place_of(self, handle: Handles, first: int) -> FloatArray:
        """Return the positions (first = 0) or velocities (2) of a body or several."""
        if type(handle) is int or not np.ndim(handle):
            return np.array(self.site.place_of(self._index(handle))[first : first + 2])
        return self.site.places(self._indices(handle), first)

    def _index(self, handle: Any) -> int:
        """Check the handle of a body, and return its index."""
        number = handle if type(handle) is int else integer("the handle of a body", handle)
        index, setup = number & INDEX_MASK, self.site.setup
        if number >= 0 and index < setup.room.bodies:
            own = setup.numbers.item(index)
            if own == number and setup.uses.item(index) != UNUSED:
                return index
            if own > number:
                raise NoBodyError(
                    f"body {number} was removed. Forget the handles of bodies that you remove, or "
                    "ask `handle in world` first"
                )
        raise NoBodyError(f"there is no body {number}, and there never was: see `world.handles`")

    def _indices(self, handles: Any) -> IndexArray:
        """Check the handles of some bodies, and return their indices, int64 [n]."""
        numbers, setup = np.asarray(handles), self.site.setup
        if numbers.ndim != 1 or (len(numbers) and numbers.dtype.kind not in "iu"):
            raise TypeError(f"handles must be integers, [n], but are {handles!r}")
        numbers = numbers.astype(np.int64)
        indices: IndexArray = numbers & INDEX_MASK
        known = (numbers >= 0) & (indices < setup.room.bodies)
        places = np.where(known, indices, 0)
        known &= (setup.numbers[places] == numbers) & (setup.uses[places] != UNUSED)
        if not known.all():
            self._index(int(numbers[~known][0]))
        return indices


def _read_only(array: FloatArray) -> FloatArray:
    array.flags.writeable = False
    return array


def bits(name: str, value: Any) -> int:
    """Return an integer of 64 bits, as one with a sign: -1 and 2**64 - 1 have all of them."""
    bits = integer(name, value)
    if not -(1 << 63) <= bits < 1 << 64:
        raise ValueError(f"{name} must fit into 64 bits, but is {value!r}")
    return bits if bits < 1 << 63 else bits - (1 << 64)
