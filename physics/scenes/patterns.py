"""The patterns of shapes: colliders of size 1, which scenes turn and enlarge."""

import math
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..shapes.colliders import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
    turned_axis,
)

TURNS = 360  # in one full turn
POLYGONS: dict[str, list[tuple[float, float]]] = {
    "triangle": [(-0.9, -0.8), (1.1, -0.5), (-0.1, 1.0)],
    "trapezium": [(-1.2, -0.6), (1.2, -0.6), (0.6, 0.6), (-0.6, 0.6)],
    "pentagon": [(-1.0, -0.6), (0.35, -1.0), (1.1, 0.1), (0.3, 1.0), (-0.8, 0.7)],
}


def make_patterns() -> dict[str, Collider]:
    """Return all patterns by name, in order.

    The name of a polygon ends with its missing edges: ``"Convex triangle 02"``.
    """
    patterns: dict[str, Collider] = {
        "Particle": Particle(1),
        "HalfPlane": HalfPlane((0, 1)),
        "AxisAlignedHalfPlane": AxisAlignedHalfPlane("+y"),
        "AxisAlignedRectangle": AxisAlignedRectangle(1, 1),
        "Rectangle": Rectangle(1, 1),
    }
    for name, vertices in POLYGONS.items():
        for missing in range(len(vertices)):
            for edges in combinations(range(len(vertices)), missing):
                digits = "".join(map(str, edges))
                patterns[f"Convex {name} {digits}".rstrip()] = Convex(vertices, edges)
    return patterns


def make_turns() -> NDArray[np.float64]:
    """Return cosine and sine of each degree, as colliders have them, [TURNS, 2]."""
    return np.array([turned_axis(math.radians(degree)) for degree in range(TURNS)])
