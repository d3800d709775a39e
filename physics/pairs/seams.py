"""Seams: where the face of one body ends, and the ground goes on in another one.

A corner that comes down on a seam meets the corners of two tiles. Each tile alone cannot tell
whether it is an end of the ground, at which a body may turn or pass, or a seam, which nobody should
feel. So the world asks who covers the place just beyond the end, and just below the face. If anyone
does, the face counts up to its end and a little further, on either side of the seam: no point of it
is without an owner. The same holds for a ray that comes along the border of two tiles.
"""

import math

from ..kernels import kernel
from ..shapes.records import Edges, Shapes
from .convex_convex import lowest
from .touching import closing_speed, margin_along
from .touching_point import support_feature

NO_END = (math.inf, 0.0, 0.0)
ENDS = 2  # of a face: its start and its end


@kernel
def lies_along(shapes: Shapes, edges: Edges, index: int, x: float, y: float) -> bool:
    """Return whether a normal (x, y) is that of one of a shape's faces, to the bit."""
    shape = shapes[index]
    for number in range(shape.first, shape.first + shape.count):
        edge = edges[number]
        if edge.normal_x * y == edge.normal_y * x:
            return True
    return False


@kernel
def covers(shapes: Shapes, edges: Edges, index: int, x: float, y: float) -> bool:
    """Return whether a polygon, or a half-plane, has the point (x, y) inside."""
    shape = shapes[index]
    for number in range(shape.first, shape.first + shape.count):
        edge = edges[number]
        if edge.normal_x * x + edge.normal_y * y >= edge.offset:
            return False
    return bool(shape.count > 0)


@kernel
def next_end(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    tried: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
) -> tuple[int, int, float, float, float]:
    """Return (tried, number, time, x, y): the next end of a face of b that shape a meets in time.

    Args:
        shapes, edges, a, b: the shapes.
        tried: how many ends were looked at already; the first time 0, then what was returned.
        dx, dy, vx, vy, margin_x, margin_y: as of `_time_at_end`.
        duration: how much time there is.

    Returns:
        The number is the face's, an index of ``edges``, or -1 if there is no further end. The rest
        is as of `_time_at_end`.
    """
    first, count = shapes[b].first, ENDS * shapes[b].count
    while tried < count:
        number, side = first + tried // ENDS, 1 if tried % ENDS else -1
        tried += 1
        time, x, y = _time_at_end(
            shapes, edges, a, b, number, side, dx, dy, vx, vy, margin_x, margin_y
        )
        if time <= duration and time < math.inf:
            return tried, number, time, x, y
    return tried, -1, math.inf, 0.0, 0.0


@kernel
def next_stretch(
    shapes: Shapes,
    edges: Edges,
    index: int,
    tried: int,
    dx: float,
    dy: float,
    way_x: float,
    way_y: float,
    margin_x: float,
    margin_y: float,
) -> tuple[int, int, float, float]:
    """Return (tried, number, first, last): the next side of a shape along which a point moves.

    Args:
        shapes, edges, index: the shape, at (dx, dy) from where the point begins.
        tried: how many sides were looked at already; the first time 0, then what was returned.
        way_x, way_y: the way of the point.
        margin_x, margin_y: as of `touching`.

    Returns:
        The number is the side's, an index of ``edges``, or -1 if there is no further one. The point
        touches it between two fractions of its way.
    """
    begin, count = shapes[index].first, shapes[index].count
    while tried < count:
        number = begin + tried
        tried += 1
        edge = edges[number]
        x, y = edge.normal_x, edge.normal_y
        margin, aside = (
            margin_along(x, y, margin_x, margin_y),
            margin_along(-y, x, margin_x, margin_y),
        )
        place, speed = y * dx - x * dy, x * way_y - y * way_x  # along (-y, x)
        if speed == 0.0:
            continue
        low = x * edge.start_y - y * edge.start_x if edge.has_start else -math.inf
        high = x * edge.end_y - y * edge.end_x if edge.has_end else math.inf
        one, other = (low - place) / speed, (high - place) / speed
        first, last = max(0.0, min(one, other)), min(1.0, max(one, other))
        gap, rise = -(x * dx + y * dy) - edge.offset, x * way_x + y * way_y
        if (
            (last - first) * abs(speed) > 2.0 * aside
            and abs(gap + rise * first) <= margin
            and abs(gap + rise * last) <= margin
        ):
            return tried, number, first, last
    return tried, -1, 0.0, 0.0


@kernel
def _time_at_end(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    number: int,
    side: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return (time, x, y): when shape a meets a face of b just at its end, and what lies beyond.

    Args:
        shapes, edges, a, b: the shapes.
        number: the face, an index of ``edges``.
        side: the end, 1 for the face's end and -1 for its start.
        dx, dy, vx, vy: b's place and velocity, relative to a.
        margin_x, margin_y: as of `touching`.

    Returns:
        The time is inf if a does not meet the face, or not with a corner or a disc at its end: it
        meets the end, or it passes the end while it touches the face's line, within the margin. The
        point, relative to b, is as far beyond the end and below the face as rounding may hide.
    """
    edge = edges[number]
    x, y = edge.normal_x, edge.normal_y
    margin = margin_along(x, y, margin_x, margin_y)
    closing = closing_speed(-x, -y, vx, vy, margin)
    if closing <= 0.0 or not (edge.has_end if side > 0 else edge.has_start):
        return NO_END
    if shapes[a].count > 0 and lowest(shapes[a], edges, x, y) == -math.inf:
        return NO_END
    height, low, high = support_feature(shapes[a], edges, -x, -y)
    gap = -(x * dx + y * dy) - height - edge.offset
    aside = margin_along(-y, x, margin_x, margin_y)
    if gap < -margin or high - low > aside:
        return NO_END
    end_x = edge.end_x if side > 0 else edge.start_x
    end_y = edge.end_y if side > 0 else edge.start_y
    # How far a is beyond the end, along the face's direction (-y, x), and how fast it goes there.
    beyond = side * (-low - (x * (dy + end_y) - y * (dx + end_x)))
    slide = side * (y * vx - x * vy)
    time = max(gap, 0.0) / closing
    place = beyond + slide * time
    if place > 2.0 * aside:
        # It comes to the end later, perhaps still within the margin.
        if slide >= 0.0:
            return NO_END
        time += place / -slide
        if gap - closing * time < -margin:
            return NO_END
    elif place < -2.0 * (aside + max(slide, 0.0) / closing * margin):
        return NO_END
    return (
        time,
        end_x - side * aside * y - margin * x,
        end_y + side * aside * x - margin * y,
    )
