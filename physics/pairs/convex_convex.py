"""Convex region against convex region, closed or open: separating axes.

Two convex regions are disjoint exactly if a line along an edge of one of them separates them: the
edges of their Minkowski difference are the edges of both. An edge of one is no such axis if the
other region is open and reaches to infinity across it. If no axis remains, the difference is the
whole plane and no finite translation separates the two.
"""

import math

from ..kernels import kernel
from ..shapes.records import Edges, ShapeRecord, Shapes
from ..tolerances import PARALLEL
from .results import NO_IMPACT, NO_OVERLAP
from .touching import axis_times, closing_speed, margin_along


@kernel
def lowest(shape: ShapeRecord, edges: Edges, x: float, y: float) -> float:
    """Return the least value of (x, y) . p over the region's points, perhaps -inf."""
    least = math.inf
    for index in range(shape.first, shape.first + shape.count):
        edge = edges[index]
        # How fast the value rises along the edge, towards its end.
        rise = y * edge.normal_x - x * edge.normal_y
        if not edge.has_end and rise < -PARALLEL:
            return -math.inf
        if not edge.has_start and rise > PARALLEL:
            return -math.inf
        # A half-plane reaches to infinity behind its edge, too.
        if shape.count == 1 and x * edge.normal_x + y * edge.normal_y > 0.0:
            return -math.inf
        least = min(least, x * edge.start_x + y * edge.start_y)
        least = min(least, x * edge.end_x + y * edge.end_y)
    return least


@kernel
def separation_along(
    shapes: Shapes, edges: Edges, a: int, b: int, axis: int, dx: float, dy: float
) -> tuple[float, float, float]:
    """Return (x, y, gap) of an axis from a to b; ``axis`` counts a's edges, then b's."""
    first = shapes[a]
    second = shapes[b]
    if axis < first.count:
        edge = edges[first.first + axis]
        x = edge.normal_x
        y = edge.normal_y
        return x, y, (lowest(second, edges, x, y) + (x * dx + y * dy)) - edge.offset
    edge = edges[second.first + axis - first.count]
    x = edge.normal_x
    y = edge.normal_y
    return -x, -y, (lowest(first, edges, x, y) - (x * dx + y * dy)) - edge.offset


@kernel
def contact_convex_convex(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    margin_x: float,
    margin_y: float,
) -> tuple[bool, float, float, float]:
    """Return (found, normal_x, normal_y, depth), depth inf if no translation separates them."""
    normal_x, normal_y, gap = 0.0, 0.0, -math.inf
    for axis in range(shapes[a].count + shapes[b].count):
        x, y, candidate = separation_along(shapes, edges, a, b, axis, dx, dy)
        if candidate >= -margin_along(x, y, margin_x, margin_y):
            return NO_OVERLAP
        if candidate > gap or axis == 0:
            normal_x, normal_y, gap = x, y, candidate
    return True, normal_x, normal_y, -gap


@kernel
def _slower_axis(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    margin_x: float,
    margin_y: float,
    time: float,
    normal_x: float,
    normal_y: float,
) -> tuple[float, float]:
    """Return the axis along which the two approach most slowly, of all that touch at the time.

    At a corner there are several: a slower one than the given normal changes less. So a body that
    comes down almost along a floor does not meet the side of the next tile.
    """
    margin = margin_along(normal_x, normal_y, margin_x, margin_y)
    least = closing_speed(normal_x, normal_y, vx, vy, margin)
    for axis in range(shapes[a].count + shapes[b].count):
        x, y, gap = separation_along(shapes, edges, a, b, axis, dx, dy)
        margin = margin_along(x, y, margin_x, margin_y)
        closing = closing_speed(x, y, vx, vy, margin)
        if closing < least and axis_times(gap, closing, margin)[1] > time:
            normal_x, normal_y, least = x, y, closing
    return normal_x, normal_y


@kernel
def sweep_convex_convex(
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
    """Return (time, normal_x, normal_y); region b starts at (dx, dy) and moves with (vx, vy)."""
    time, sinks, parts = -1.0, -1.0, math.inf
    normal_x = 0.0
    normal_y = 0.0
    for axis in range(shapes[a].count + shapes[b].count):
        x, y, gap = separation_along(shapes, edges, a, b, axis, dx, dy)
        margin = margin_along(x, y, margin_x, margin_y)
        axis_touches, axis_sinks, axis_parts = axis_times(
            gap, closing_speed(x, y, vx, vy, margin), margin
        )
        if axis_touches == math.inf:
            return NO_IMPACT
        if axis_touches > time:
            time, normal_x, normal_y = axis_touches, x, y
        sinks = max(sinks, axis_sinks)
        parts = min(parts, axis_parts)
    if time < 0.0:
        _, normal_x, normal_y, _ = contact_convex_convex(
            shapes, edges, a, b, dx, dy, margin_x, margin_y
        )
        return 0.0, normal_x, normal_y
    if sinks >= parts or time > duration:
        return NO_IMPACT
    if margin_x > 0.0 or margin_y > 0.0:
        normal_x, normal_y = _slower_axis(
            shapes, edges, a, b, dx, dy, vx, vy, margin_x, margin_y, time, normal_x, normal_y
        )
    return time, normal_x, normal_y
