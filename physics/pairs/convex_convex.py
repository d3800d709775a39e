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
    shapes: Shapes, edges: Edges, a: int, b: int, dx: float, dy: float
) -> tuple[bool, float, float, float]:
    """Return (found, normal_x, normal_y, depth), depth inf if no translation separates them."""
    normal_x, normal_y, gap = separation_along(shapes, edges, a, b, 0, dx, dy)
    for axis in range(1, shapes[a].count + shapes[b].count):
        if gap >= 0.0:
            break
        x, y, candidate = separation_along(shapes, edges, a, b, axis, dx, dy)
        if candidate > gap:
            normal_x, normal_y, gap = x, y, candidate
    if gap >= 0.0:
        return NO_OVERLAP
    return True, normal_x, normal_y, -gap


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
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); region b starts at (dx, dy) and moves with (vx, vy)."""
    enter = -1.0
    leave = math.inf
    normal_x = 0.0
    normal_y = 0.0
    for axis in range(shapes[a].count + shapes[b].count):
        x, y, gap = separation_along(shapes, edges, a, b, axis, dx, dy)
        velocity = x * vx + y * vy
        if gap >= 0.0:
            if velocity >= 0.0:
                return NO_IMPACT
            if gap / -velocity > enter:
                enter, normal_x, normal_y = gap / -velocity, x, y
        elif velocity > 0.0:
            leave = min(leave, gap / -velocity)
    if enter < 0.0:
        _, normal_x, normal_y, _ = contact_convex_convex(shapes, edges, a, b, dx, dy)
        return 0.0, normal_x, normal_y
    if enter >= leave or enter > duration:
        return NO_IMPACT
    return enter, normal_x, normal_y
