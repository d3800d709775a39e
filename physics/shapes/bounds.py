"""Bounding boxes of shapes."""

import math

from ..kernels import kernel
from .records import Edges


@kernel
def bounds_of(
    edges: Edges, first: int, count: int, radius: float
) -> tuple[float, float, float, float]:
    """Return (lower_x, lower_y, upper_x, upper_y) of a region, infinite where it is unbounded.

    Args:
        edges: all edges; first, count: which of them are the core's.
        radius: how far the region reaches beyond its core.
    """
    return (
        -_reach(edges, first, count, -1.0, 0.0) - radius,
        -_reach(edges, first, count, 0.0, -1.0) - radius,
        _reach(edges, first, count, 1.0, 0.0) + radius,
        _reach(edges, first, count, 0.0, 1.0) + radius,
    )


@kernel
def _reach(edges: Edges, first: int, count: int, x: float, y: float) -> float:
    """Return how far a core extends along the unit vector (x, y), perhaps infinitely."""
    farthest = -math.inf if count > 0 else 0.0
    for number in range(first, first + count):
        edge = edges[number]
        rise = y * edge.normal_x - x * edge.normal_y
        behind = count == 1 and x * edge.normal_x + y * edge.normal_y < 0.0
        endless = (edge.has_end == 0 and rise > 0.0) or (edge.has_start == 0 and rise < 0.0)
        if endless or behind:
            return math.inf
        farthest = max(
            farthest, max(x * edge.start_x + y * edge.start_y, x * edge.end_x + y * edge.end_y)
        )
    return farthest
