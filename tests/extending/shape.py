"""With the changes of `docs/extending.md`: a pill agrees with GEOS (through Shapely).

Overlaps, separations and impacts are compared with the distance between the cores, which Shapely
computes.
"""

import math
from collections.abc import Callable

import numpy as np
import shapely
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Pill,
    Rectangle,
    contact,
    time_of_impact,
)
from shapely import affinity

FAR = 1e3  # the size of the box that represents a half-plane
NEAR = 1e-9
RNG = np.random.default_rng(0)


def random_pill() -> Pill:
    return Pill(RNG.uniform(0.1, 3), RNG.uniform(0.1, 1), RNG.uniform(-4, 4))


PARTNERS: tuple[Callable[[], Collider], ...] = (
    lambda: Particle(RNG.uniform(0.1, 1)),
    lambda: HalfPlane(RNG.normal(size=2), RNG.uniform(-1, 1)),
    lambda: AxisAlignedHalfPlane("-x", RNG.uniform(-1, 1)),
    lambda: AxisAlignedRectangle(*RNG.uniform(0.2, 3, 2)),
    lambda: Rectangle(*RNG.uniform(0.2, 3, 2), RNG.uniform(-4, 4)),
    lambda: Convex([(-1, -0.5), (1, -1), (0.3, 1.2)], (), RNG.uniform(-4, 4)),
    random_pill,
)


def core_of(collider: Collider) -> shapely.Geometry:
    """Return a collider's core about the origin, built from the collider's arguments."""
    match collider:
        case Particle():
            return shapely.Point(0, 0)
        case Pill(length, _, rotation):
            half = 0.5 * length * np.array((math.cos(rotation), math.sin(rotation)))
            return shapely.LineString([-half, half])
        case HalfPlane(normal, offset):
            block = shapely.box(offset - FAR, -FAR, offset, FAR)
            return affinity.rotate(
                block, math.atan2(normal[1], normal[0]), origin=(0, 0), use_radians=True
            )
        case AxisAlignedHalfPlane(_, offset):
            return shapely.box(-offset, -FAR, FAR, FAR)
        case Convex():
            return shapely.Polygon(collider.vertices)
    width, height = collider.width, collider.height
    block = shapely.box(-width / 2, -height / 2, width / 2, height / 2)
    turn = getattr(collider, "rotation", 0.0)
    return affinity.rotate(block, turn, origin=(0, 0), use_radians=True)


def placed(body: Body) -> shapely.Geometry:
    return affinity.translate(core_of(body.collider), *body.position)


def gap(a: Body, b: Body, way: np.ndarray | tuple[float, float] = (0.0, 0.0)) -> float:
    """Return the gap between two bodies after b has moved a way; below 0 if they overlap."""
    cores = placed(a), affinity.translate(placed(b), *way)
    return cores[0].distance(cores[1]) - a.collider.rounding - b.collider.rounding


def check_contact(a: Body, b: Body) -> bool:
    """Check the contact of two bodies; return whether they overlap."""
    found = contact(a, b)
    if found is None:
        assert gap(a, b) > -NEAR
        return False
    assert gap(a, b) < NEAR
    assert abs(gap(a, b, found.normal * found.depth)) < NEAR
    for turn in RNG.uniform(-math.pi, math.pi, 3):
        assert gap(a, b, 0.999 * found.depth * np.array((math.cos(turn), math.sin(turn)))) < 0
    half = 0.5 * found.depth * found.normal
    for body, surface in ((a, found.point + half), (b, found.point - half)):
        core = placed(body)
        outline = core.boundary if core.area else core
        assert abs(outline.distance(shapely.Point(surface)) - body.collider.rounding) < NEAR
    return True


def check_impact(a: Body, b: Body) -> bool:
    """Check when b hits a; return whether it does."""
    impact = time_of_impact(a, b)
    last = 12.0 if impact is None else 0.999 * impact.time
    assert min(gap(a, b, b.velocity * time) for time in np.linspace(0, last, 40)) > -NEAR
    if impact is None:
        return False
    assert abs(gap(a, b, b.velocity * impact.time)) < NEAR
    assert impact.normal @ b.velocity < 0
    return True


overlaps = impacts = 0
for number in range(3500):
    one = Body(random_pill(), RNG.uniform(-1, 1, 2))
    other = Body(PARTNERS[number % len(PARTNERS)](), RNG.uniform(-3, 3, 2), RNG.normal(size=2))
    if check_contact(one, other):
        overlaps += 1
    else:
        impacts += check_impact(one, other)
assert overlaps > 1000
assert impacts > 500
