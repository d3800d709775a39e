"""Edges that a kernel writes from corners are those of `Convex`, bit for bit."""

import numpy as np
from arkanoid.physics.shapes.colliders import Convex
from arkanoid.physics.shapes.polygons import close_polygon
from arkanoid.physics.shapes.table import shape_table


def test_edges_of_all_kinds_of_polygons() -> None:
    luck = np.random.default_rng(5)
    for _ in range(3000):
        angles = np.sort(luck.uniform(0.0, 2.0 * np.pi, luck.integers(3, 9)))
        if (np.diff(angles, append=angles[0] + 2.0 * np.pi) > 3.0).any():
            continue
        size = 10.0 ** luck.uniform(-3.0, 3.0)
        points = size * np.column_stack((np.cos(angles), np.sin(angles))) * [1.0, 0.7]
        _, expected = shape_table([Convex(points)])
        found = np.zeros_like(expected)
        for name in ("start_x", "start_y", "has_start", "has_end"):
            found[name] = expected[name]
        close_polygon(found, 0, len(found))
        assert found.tobytes() == expected.tobytes(), points
