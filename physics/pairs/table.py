"""The one table: which algorithm serves which pair of colliders.

An algorithm is registered for an ordered pair of kinds. It serves the swapped pair, too, with
swapped arguments and a reversed normal. Two shapes of one kind are ordered by their positions, so
that swapping them reverses the normal bit for bit. (Two identical shapes at the very same position
cannot be told apart: their normal is the same whichever comes first.)
"""

import math

import numpy as np
import numpy.typing as npt

from ..kernels import kernel
from ..shapes.records import (
    AXIS_ALIGNED_HALF_PLANE,
    AXIS_ALIGNED_RECTANGLE,
    CONVEX,
    HALF_PLANE,
    KINDS,
    PARTICLE,
    RECTANGLE,
    EdgeRecord,
    Edges,
    Shapes,
)
from .box_box import contact_box_box, sweep_box_box
from .convex_convex import contact_convex_convex, sweep_convex_convex
from .disc_box import contact_disc_box, sweep_disc_box
from .disc_convex import contact_disc_convex, sweep_disc_convex, sweep_point_convex
from .disc_disc import contact_disc_disc, sweep_disc_disc
from .disc_half_plane import contact_disc_half_plane, sweep_disc_half_plane
from .results import NO_CONTACT, NO_IMPACT
from .touching_point import touching_point

# The algorithms. The name gives the order of the two kinds.
DISC_DISC = 0
DISC_HALF_PLANE = 1
DISC_BOX = 2
DISC_CONVEX = 3
BOX_BOX = 4
CONVEX_CONVEX = 5
UNREGISTERED = -1

REGISTERED = (
    (PARTICLE, PARTICLE, DISC_DISC),
    (PARTICLE, HALF_PLANE, DISC_HALF_PLANE),
    (PARTICLE, AXIS_ALIGNED_HALF_PLANE, DISC_HALF_PLANE),
    (PARTICLE, AXIS_ALIGNED_RECTANGLE, DISC_BOX),
    (PARTICLE, RECTANGLE, DISC_CONVEX),
    (PARTICLE, CONVEX, DISC_CONVEX),
    (HALF_PLANE, HALF_PLANE, CONVEX_CONVEX),
    (HALF_PLANE, AXIS_ALIGNED_HALF_PLANE, CONVEX_CONVEX),
    (HALF_PLANE, AXIS_ALIGNED_RECTANGLE, CONVEX_CONVEX),
    (HALF_PLANE, RECTANGLE, CONVEX_CONVEX),
    (HALF_PLANE, CONVEX, CONVEX_CONVEX),
    (AXIS_ALIGNED_HALF_PLANE, AXIS_ALIGNED_HALF_PLANE, CONVEX_CONVEX),
    (AXIS_ALIGNED_HALF_PLANE, AXIS_ALIGNED_RECTANGLE, CONVEX_CONVEX),
    (AXIS_ALIGNED_HALF_PLANE, RECTANGLE, CONVEX_CONVEX),
    (AXIS_ALIGNED_HALF_PLANE, CONVEX, CONVEX_CONVEX),
    (AXIS_ALIGNED_RECTANGLE, AXIS_ALIGNED_RECTANGLE, BOX_BOX),
    (AXIS_ALIGNED_RECTANGLE, RECTANGLE, CONVEX_CONVEX),
    (AXIS_ALIGNED_RECTANGLE, CONVEX, CONVEX_CONVEX),
    (RECTANGLE, RECTANGLE, CONVEX_CONVEX),
    (RECTANGLE, CONVEX, CONVEX_CONVEX),
    (CONVEX, CONVEX, CONVEX_CONVEX),
)


def _algorithm_table() -> npt.NDArray[np.int64]:
    """Return the algorithm of every ordered pair of kinds, [KINDS, KINDS]."""
    table = np.full((KINDS, KINDS), UNREGISTERED)
    for first, second, algorithm in REGISTERED:
        table[first, second] = algorithm
        table[second, first] = algorithm
    return table


def _swap_table() -> npt.NDArray[np.bool_]:
    """Return for every ordered pair of kinds whether it is registered in the other order."""
    table = np.zeros((KINDS, KINDS), np.bool_)
    for first, second, _ in REGISTERED:
        table[second, first] = first != second
    return table


ALGORITHM = _algorithm_table()
SWAPPED = _swap_table()


@kernel
def _edge_order(one: EdgeRecord, other: EdgeRecord) -> float:
    """Return a number whose sign orders two edges; 0 if they are equal."""
    order: float = one.offset - other.offset
    if order == 0.0:
        order = one.normal_x - other.normal_x
    if order == 0.0:
        order = one.normal_y - other.normal_y
    if order == 0.0:
        order = one.start_x - other.start_x
    if order == 0.0:
        order = one.start_y - other.start_y
    if order == 0.0:
        order = one.end_x - other.end_x
    if order == 0.0:
        order = one.end_y - other.end_y
    return order


@kernel
def _shape_order(shapes: Shapes, edges: Edges, a: int, b: int) -> float:
    """Return a number whose sign orders two shapes of one kind; 0 if they are equal."""
    first = shapes[a]
    second = shapes[b]
    order: float = first.radius - second.radius
    if order == 0.0:
        order = float(first.count - second.count)
    if order == 0.0:
        for index in range(first.count):
            order = _edge_order(edges[first.first + index], edges[second.first + index])
            if order != 0.0:
                break
    return order


@kernel
def _is_swapped(shapes: Shapes, edges: Edges, a: int, b: int, dx: float, dy: float) -> bool:
    """Return whether the pair is computed as (b, a): by kind, then position, then data."""
    kind_a = shapes[a].kind
    kind_b = shapes[b].kind
    swapped = bool(SWAPPED[kind_a, kind_b])
    if kind_a == kind_b:
        swapped = dx < 0.0 or (dx == 0.0 and dy < 0.0)
        if dx == 0.0 and dy == 0.0:
            swapped = _shape_order(shapes, edges, a, b) > 0.0
    return swapped


@kernel
def _contact(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    margin_x: float,
    margin_y: float,
) -> tuple[bool, float, float, float, float, float]:
    """Return the contact of a pair in registered order."""
    first = shapes[a]
    second = shapes[b]
    algorithm = ALGORITHM[first.kind, second.kind]
    if algorithm == DISC_DISC:
        return contact_disc_disc(first.radius, second.radius, dx, dy, margin_x, margin_y)
    if algorithm == DISC_BOX:
        return contact_disc_box(
            first.radius, second.upper_x, second.upper_y, dx, dy, margin_x, margin_y
        )
    if algorithm == DISC_CONVEX:
        return contact_disc_convex(
            first.radius, edges, second.first, second.count, dx, dy, margin_x, margin_y
        )
    if algorithm == DISC_HALF_PLANE:
        edge = edges[second.first]
        return contact_disc_half_plane(
            first.radius,
            edge.normal_x,
            edge.normal_y,
            edge.offset,
            dx,
            dy,
            margin_x,
            margin_y,
        )
    if algorithm == BOX_BOX:
        found, normal_x, normal_y, depth = contact_box_box(
            first.upper_x + second.upper_x,
            first.upper_y + second.upper_y,
            dx,
            dy,
            margin_x,
            margin_y,
        )
    else:
        found, normal_x, normal_y, depth = contact_convex_convex(
            shapes, edges, a, b, dx, dy, margin_x, margin_y
        )
    if not found:
        return NO_CONTACT
    x, y = touching_point(shapes, edges, a, b, dx, dy, normal_x, normal_y)
    return True, normal_x, normal_y, depth, x, y


@kernel
def _impact(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return the impact of a pair in registered order."""
    first = shapes[a]
    second = shapes[b]
    algorithm = ALGORITHM[first.kind, second.kind]
    if algorithm == DISC_DISC:
        return sweep_disc_disc(
            first.radius, second.radius, dx, dy, vx, vy, duration, margin_x, margin_y
        )
    if algorithm == DISC_HALF_PLANE:
        edge = edges[second.first]
        return sweep_disc_half_plane(
            first.radius,
            edge.normal_x,
            edge.normal_y,
            edge.offset,
            dx,
            dy,
            vx,
            vy,
            duration,
            margin_x,
            margin_y,
        )
    if first.radius == 0.0 and algorithm in (DISC_BOX, DISC_CONVEX):
        return sweep_point_convex(
            edges, second.first, second.count, dx, dy, vx, vy, duration, margin_x, margin_y
        )
    if algorithm == DISC_BOX:
        return sweep_disc_box(
            first.radius,
            second.upper_x,
            second.upper_y,
            dx,
            dy,
            vx,
            vy,
            duration,
            margin_x,
            margin_y,
        )
    if algorithm == DISC_CONVEX:
        return sweep_disc_convex(
            first.radius,
            edges,
            second.first,
            second.count,
            dx,
            dy,
            vx,
            vy,
            duration,
            margin_x,
            margin_y,
        )
    if algorithm == BOX_BOX:
        return sweep_box_box(
            first.upper_x + second.upper_x,
            first.upper_y + second.upper_y,
            dx,
            dy,
            vx,
            vy,
            duration,
            margin_x,
            margin_y,
        )
    return sweep_convex_convex(shapes, edges, a, b, dx, dy, vx, vy, duration, margin_x, margin_y)


@kernel
def contact_between(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    margin_x: float = 0.0,
    margin_y: float = 0.0,
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, point_x, point_y) for b at (dx, dy) from a.

    The unit normal points from a to b; depth is the shortest translation that separates (inf if
    no translation does); the point is relative to a, halfway between the surfaces that separate
    along the normal. Nothing is found if the two merely touch, within the margins of `touching`.
    """
    if _is_swapped(shapes, edges, a, b, dx, dy):
        found, normal_x, normal_y, depth, x, y = _contact(
            shapes, edges, b, a, -dx, -dy, margin_x, margin_y
        )
        if not found:
            return NO_CONTACT
        return True, -normal_x, -normal_y, depth, x + dx, y + dy
    return _contact(shapes, edges, a, b, dx, dy, margin_x, margin_y)


@kernel
def overlap_between(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    margin_x: float = 0.0,
    margin_y: float = 0.0,
) -> bool:
    """Return whether the interiors of a and of b, at (dx, dy) from a, overlap."""
    return contact_between(shapes, edges, a, b, dx, dy, margin_x, margin_y)[0]


@kernel
def impact_between(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
    margin_x: float = 0.0,
    margin_y: float = 0.0,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) for b at (dx, dy) from a, moving with (vx, vy).

    Time is when the two touch and begin to overlap, at most ``duration``. It is inf if they never
    begin to overlap: if they stay apart, touch and separate, or slide past each other, all within
    the margins of `touching`. If they overlap already, it is 0 and the normal is the contact's. The
    unit normal points from a to b.
    """
    is_swapped = _is_swapped(shapes, edges, a, b, dx, dy)
    if is_swapped:
        a, b, dx, dy, vx, vy = b, a, -dx, -dy, -vx, -vy
    time, normal_x, normal_y = _impact(
        shapes, edges, a, b, dx, dy, vx, vy, duration, margin_x, margin_y
    )
    # The time may be too large for a number, at a speed of 1e-320 for instance.
    if not time < math.inf:
        return NO_IMPACT
    if is_swapped:
        return time, -normal_x, -normal_y
    return time, normal_x, normal_y


@kernel
def _interval_may_touch(
    lower_a: float, upper_a: float, lower_b: float, upper_b: float, velocity: float, time: float
) -> bool:
    """Return whether interval b, moving for the time, may meet interval a."""
    if lower_b > upper_a:
        return velocity < 0.0 and lower_b + velocity * time <= upper_a
    if upper_b < lower_a:
        return velocity > 0.0 and upper_b + velocity * time >= lower_a
    return True


@kernel
def may_touch(
    shapes: Shapes, a: int, b: int, dx: float, dy: float, vx: float, vy: float, duration: float
) -> bool:
    """Return False only if the bounding boxes of a and of b, which moves, stay apart."""
    first = shapes[a]
    second = shapes[b]
    return _interval_may_touch(
        first.lower_x, first.upper_x, second.lower_x + dx, second.upper_x + dx, vx, duration
    ) and _interval_may_touch(
        first.lower_y, first.upper_y, second.lower_y + dy, second.upper_y + dy, vy, duration
    )
