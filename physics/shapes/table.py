"""Colliders as records, which kernels read."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from .bounds import bounds_of
from .colliders import Collider
from .records import Edge, Shape

ShapeTable = tuple[npt.NDArray[Any], npt.NDArray[Any]]


def shape_table(colliders: Iterable[Collider]) -> ShapeTable:
    """Return (shapes, edges): one `Shape` per collider, in order, and all their `Edge` records.

    There is at least one edge, so that even discs alone give arrays that kernels accept.

    Raises:
        TypeError: if one is not a collider.
    """
    given = list(colliders)
    for collider in given:
        if not isinstance(collider, Collider):
            raise TypeError(
                f"a collider is needed, such as Particle(1.0), but this is {collider!r}"
            )
    edges = [tuple(edge) for collider in given for edge in collider.edges]
    table = np.zeros(max(1, len(edges)), Edge)
    for index, edge in enumerate(edges):
        table[index] = edge
    shapes = np.zeros(len(given), Shape)
    first = 0
    for index, collider in enumerate(given):
        count, radius = len(collider.edges), collider.rounding
        bounds = bounds_of(table, first, count, radius)
        shapes[index] = (collider.kind, first, count, radius, *bounds)
        first += count
    return shapes, table
