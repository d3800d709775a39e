"""Polygons whose corners move: their edges anew, with the bits of `Convex`."""

import math

from ..kernels import kernel
from .records import Edges
from .vectors import squared_excess


@kernel
def close_polygon(edges: Edges, first: int, count: int) -> None:
    """Write ends, normals and offsets of a counterclockwise polygon.

    Args:
        edges: of all shapes, which know where they start; first, count: the polygon's.
    """
    for number in range(count):
        edge = edges[first + number]
        following = edges[first + (number + 1) % count]
        edge.end_x = following.start_x
        edge.end_y = following.start_y
        x = edge.end_x - edge.start_x
        y = edge.end_y - edge.start_y
        length = _length(x, y)
        # Adding 0 turns -0 into 0, as for other edges.
        edge.normal_x = y / length + 0.0
        edge.normal_y = -x / length + 0.0
        # By rounding the ends differ a little in their distance: take the middle.
        start = edge.normal_x * edge.start_x + edge.normal_y * edge.start_y
        end = edge.normal_x * edge.end_x + edge.normal_y * edge.end_y
        edge.offset = 0.5 * (start + end) + 0.0


@kernel
def _length(x: float, y: float) -> float:
    """Return the length of a vector, neither tiny nor huge, rounded once, like `math.hypot`."""
    length = math.sqrt(x * x + y * y)
    return length + 0.5 * squared_excess(x, y, length) / length
