"""Colliders as records, which kernels read."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import Vector
from .boundary import BoundaryEdge
from .colliders import Collider
from .records import Edge, Shape

ShapeTable = tuple[npt.NDArray[Any], npt.NDArray[Any]]


def shape_table(colliders: Iterable[Collider]) -> ShapeTable:
    """Return (shapes, edges): one `Shape` per collider, in order, and all their `Edge` records.

    There is at least one edge, so that even discs alone give arrays that kernels accept.

    Raises:
        TypeError: if one is not a collider.
    """
    rows = []
    edges: list[BoundaryEdge] = []
    for collider in colliders:
        if not isinstance(collider, Collider):
            raise TypeError(
                f"a collider is needed, such as Particle(1.0), but this is {collider!r}"
            )
        own = collider.edges
        rows.append(
            (collider.kind, len(edges), len(own), collider.rounding, *_bounding_box(collider))
        )
        edges.extend(own)
    table = np.zeros(max(1, len(edges)), Edge)
    for index, edge in enumerate(edges):
        table[index] = tuple(edge)
    shapes = np.zeros(len(rows), Shape)
    for index, row in enumerate(rows):
        shapes[index] = row
    return shapes, table


def _bounding_box(collider: Collider) -> tuple[float, float, float, float]:
    """Return (lower_x, lower_y, upper_x, upper_y) of a region, infinite where it is unbounded."""
    edges = collider.edges
    radius = collider.rounding
    return (
        -_reach(edges, (-1.0, 0.0)) - radius,
        -_reach(edges, (0.0, -1.0)) - radius,
        _reach(edges, (1.0, 0.0)) + radius,
        _reach(edges, (0.0, 1.0)) + radius,
    )


def _reach(edges: Sequence[BoundaryEdge], axis: Vector) -> float:
    """Return how far a core extends along the unit vector ``axis``, perhaps infinitely."""
    x, y = axis
    farthest = -math.inf if edges else 0.0
    for edge in edges:
        rise = y * edge.normal_x - x * edge.normal_y
        behind = len(edges) == 1 and x * edge.normal_x + y * edge.normal_y < 0.0
        if (not edge.has_end and rise > 0.0) or (not edge.has_start and rise < 0.0) or behind:
            return math.inf
        farthest = max(
            farthest, x * edge.start_x + y * edge.start_y, x * edge.end_x + y * edge.end_y
        )
    return farthest
