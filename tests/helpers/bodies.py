"""Bodies, rooms and measurements that the tests of the engine share."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
    World,
    contact,
)

DISC = Particle(0.5)
FLOOR = Body(AxisAlignedHalfPlane("+y"))

# One shape of each bounded kind, about as large as DISC, and smaller ones.
SHAPES: tuple[Collider, ...] = (
    DISC,
    AxisAlignedRectangle(1, 0.6),
    Rectangle(0.9, 0.5, 0.7),
    Convex([(-0.5, -0.4), (0.6, 0), (-0.3, 0.5)]),
)
SMALL_SHAPES: tuple[Collider, ...] = (
    Particle(0.3),
    AxisAlignedRectangle(0.6, 0.4),
    Rectangle(0.5, 0.3, 0.7),
    Convex([(-0.3, -0.2), (0.4, 0), (-0.2, 0.4)]),
)
# Half of a strip, open to one side.
OPEN_SHAPE = Convex([(1, 1), (-1, 1), (-1, 0), (1, 0)], [3], 0.25)
# One collider of each kind, and an open one.
COLLIDERS: tuple[Collider, ...] = (
    DISC,
    HalfPlane((1, 2), 0.25),
    AxisAlignedHalfPlane("-y", 0.5),
    AxisAlignedRectangle(2, 1),
    Rectangle(2, 1, 0.5),
    Convex([(0, 0), (2, 0), (1, 1.5)]),
    OPEN_SHAPE,
)


@dataclass
class Fog:
    """A user's own class with nothing but a collider and a position."""

    collider: Collider
    position: Any


def room(width: float, height: float) -> list[Body]:
    """Return four walls about [0, width] x [0, height]: left, right, lower and upper."""
    return [
        Body(AxisAlignedHalfPlane("+x")),
        Body(AxisAlignedHalfPlane("-x", -width)),
        Body(AxisAlignedHalfPlane("+y")),
        Body(AxisAlignedHalfPlane("-y", -height)),
    ]


def bodies_of(world: World) -> list[Body]:
    """Return all bodies of a world as they are now."""
    return [world.body(index) for index in range(len(world))]


def deepest_overlap(bodies: Sequence[Body]) -> float:
    """Return the depth of the deepest overlap of two bodies of which one has a mass."""
    overlaps = [contact(a, b) for a, b in combinations(bodies, 2) if a.mass or b.mass]
    return max((overlap.depth for overlap in overlaps if overlap is not None), default=0.0)
