"""Where two regions touch, or will touch once they are apart: the middle of what they share."""

import math

from ..kernels import kernel
from ..shapes.records import Edges, ShapeRecord, Shapes
from ..tolerances import PARALLEL


@kernel
def support_feature(
    shape: ShapeRecord, edges: Edges, x: float, y: float
) -> tuple[float, float, float]:
    """Return (height, low, high) of a region's farthest points along the unit vector (x, y).

    They span ``low`` to ``high`` along (-y, x): one value for a corner or a disc, perhaps infinite
    for an edge.
    """
    if shape.count == 0:
        return shape.radius, 0.0, 0.0
    height = -math.inf
    low = 0.0
    high = 0.0
    for index in range(shape.first, shape.first + shape.count):
        edge = edges[index]
        start = x * edge.start_y - y * edge.start_x
        end = x * edge.end_y - y * edge.end_x
        if (
            abs(x * edge.normal_y - y * edge.normal_x) <= PARALLEL
            and x * edge.normal_x + y * edge.normal_y > 0.0
        ):
            return (
                edge.offset,
                start if edge.has_start else -math.inf,
                end if edge.has_end else math.inf,
            )
        level = x * edge.start_x + y * edge.start_y
        if level > height:
            height, low, high = level, start, start
        level = x * edge.end_x + y * edge.end_y
        if level > height:
            height, low, high = level, end, end
    return height, low, high


@kernel
def shared_stretch(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    normal_x: float,
    normal_y: float,
) -> tuple[float, float, float]:
    """Return (height, low, high) of where the surfaces of a and b face each other along a normal.

    It lies halfway between them, ``height`` along the normal, and spans ``low`` to ``high`` along
    (-normal_y, normal_x), both relative to a: perhaps infinite, one value at a corner or disc.
    """
    top, low_a, high_a = support_feature(shapes[a], edges, normal_x, normal_y)
    depth, low_b, high_b = support_feature(shapes[b], edges, -normal_x, -normal_y)
    # b's interval runs along the opposite direction.
    along = normal_x * dy - normal_y * dx
    height = 0.5 * (top + (normal_x * dx + normal_y * dy - depth))
    return height, max(low_a, along - high_b), min(high_a, along - low_b)


@kernel
def touching_point(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    normal_x: float,
    normal_y: float,
) -> tuple[float, float]:
    """Return the point, relative to a, halfway between the surfaces that meet along the normal."""
    height, low, high = shared_stretch(shapes, edges, a, b, dx, dy, normal_x, normal_y)
    if low == -math.inf and high == math.inf:
        middle = 0.0
    elif low == -math.inf:
        middle = high
    elif high == math.inf:
        middle = low
    else:
        middle = 0.5 * (low + high)
    return height * normal_x - middle * normal_y, height * normal_y + middle * normal_x
