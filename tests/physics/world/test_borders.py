"""Rays along the border of two bodies: inside of both together, although each is only grazed."""

import math

import numpy as np
import numpy.typing as npt
import pytest
from arkanoid.physics import AxisAlignedRectangle, Body, Convex, HalfPlane, Particle, World
from helpers.grounds import FORMS, Frame, Rng, decimal

Bools = npt.NDArray[np.bool_]
SIZE = 6  # rows and columns of a map
LENGTH = 1.7 * SIZE  # of a ray, in tiles


def entry_along(filled: Bools, line: int, start: float, step: int) -> float | None:
    """Return where a point that moves along a line of a lattice comes to be between two tiles.

    Args:
        filled: bool [SIZE, SIZE], by place along the line, and across it.
        line: the number of the line, between the tiles ``line - 1`` and ``line``.
        start, step: where the point begins, and 1 or -1.
    """
    spans = [index for index in range(SIZE) if filled[index, line - 1] and filled[index, line]]
    if any(index < start < index + 1 for index in spans):
        return start
    if {int(start), int(start) - 1} <= set(spans) and start == int(start):
        return start
    begins = [index if step > 0 else index + 1 for index in spans]
    ahead = [place for place in begins if (place - start) * step >= 0]
    return min(ahead, key=lambda place: abs(place - start)) if ahead else None


def random_map(
    rng: Rng, frame: Frame, place: tuple[float, float], size: tuple[float, float]
) -> tuple[World, list[list[int]], Bools]:
    """Return a map of tiles, (column, row) of each body, and which tiles rays shall see.

    Some stand and some move; some are of a category that the mask 1 leaves out.
    """
    exists, is_seen = rng.random((SIZE, SIZE)) < 0.7, rng.random((SIZE, SIZE)) < 0.8
    cells = rng.permutation(np.argwhere(exists)).tolist()
    world = World()
    for column, row in cells:
        middle = place[0] + (column + 0.5) * size[0], place[1] + (row + 0.5) * size[1]
        tile = frame.block(str(rng.choice(FORMS)), *middle, *size)
        if rng.random() < 0.5:
            tile = Body(tile.collider, tile.position, (1, 2), mass=1)
        world.add(tile, category=1 if is_seen[column, row] else 2)
    return world, cells, exists & is_seen


def check_lines(seed: int, count: int, far: float = 9) -> None:
    """Send rays along the lines of random maps, and compare each with `entry_along`.

    Coordinates are up to ``far``.
    """
    rng = np.random.default_rng(seed)
    met, rounding = 0, 2.0**-50 * (9 + far)
    for _ in range(count):
        frame = Frame(float(rng.choice([0, rng.uniform(-3, 3)])))
        place, size = (
            (decimal(rng, -far, far), decimal(rng, -far, far)),
            (decimal(rng, 0.2, 0.9), 0.7),
        )
        world, cells, seen = random_map(rng, frame, place, size)
        lines, starts, ends = [], [], []
        for _ in range(60):
            is_flat, line, step = (
                rng.random() < 0.5,
                int(rng.integers(1, SIZE)),
                rng.choice([-1, 1]),
            )
            start = float(rng.choice([rng.integers(0, SIZE + 1), rng.uniform(-1, SIZE + 1)]))
            for points, along in ((starts, start), (ends, start + LENGTH * step)):
                column, row = (along, line) if is_flat else (line, along)
                points.append(frame.turn(place[0] + column * size[0], place[1] + row * size[1]))
            entry = entry_along(seen if is_flat else seen.T, line, start, step)
            lines.append((is_flat, line, start, entry))
        hits = world.query_rays(starts, ends, mask=1)
        for index, (is_flat, line, start, entry) in enumerate(lines):
            if entry is None:
                assert hits.bodies[index] == -1
                continue
            met += 1
            assert hits.fractions[index] == pytest.approx(abs(entry - start) / LENGTH, abs=rounding)
            assert cells[hits.bodies[index]][1 if is_flat else 0] in (line - 1, line)
            if entry != start:
                way = np.subtract(ends[index], starts[index])
                assert hits.normals[index] == pytest.approx(-way / math.hypot(*way), abs=rounding)
            one = world.query_ray(starts[index], ends[index], mask=1)
            assert one is not None
            assert (one.body, one.fraction) == (hits.bodies[index], hits.fractions[index])
    assert met > 10 * count


def test_a_ray_along_a_border_meets_the_tiles_where_it_enters() -> None:
    """It grazed both, and went through the whole wall."""
    for far in (9, 1e3, 1e6):
        check_lines(1, 6, far)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10, 14))
def test_a_ray_along_a_border_meets_the_tiles_where_it_enters_at_length(seed: int) -> None:
    check_lines(seed, 500)


def test_a_polygon_of_triangles_is_met_at_its_corners() -> None:
    """Of 3582 rays along the diagonals that divide polygons, 2164 went through."""
    for seed in range(40):
        rng = np.random.default_rng(seed)
        count = int(rng.integers(4, 9))
        angles = (np.sort(rng.uniform(0, 0.8, count)) + np.arange(count)) * math.tau / count
        corners = rng.uniform(0.5, 3) * np.column_stack([np.cos(angles), np.sin(angles)])
        corners = np.roll(corners, rng.integers(count), axis=0) + rng.uniform(-20, 20, 2)
        world = World()
        for index in range(1, count - 1):
            triangle = corners[[0, index, index + 1]]
            middle = triangle.mean(axis=0) * (seed % 2)
            velocity = rng.integers(0, 2, 2)
            world.add(Body(Convex((triangle - middle).tolist()), middle, velocity))
        for index in range(2, count - 1):
            for start, end in ((corners[0], corners[index]), (corners[index], corners[0])):
                way = (end - start) / math.dist(start, end)
                hit = world.query_ray(start - rng.uniform(0.1, 3) * way, end + way)
                assert hit is not None
                assert hit.point == pytest.approx(start, abs=1e-12)
                assert hit.normal @ way < 0


def test_what_stands_on_a_floor_has_no_gap_below() -> None:
    """A ray along the floor passed under the crate."""
    floor, crate = Body(HalfPlane((0, 1))), Body(AxisAlignedRectangle(1, 1), (3, 0.5))
    for bodies in ([floor, crate], [crate, floor]):
        hit = World(bodies).query_ray((-5, 0), (5, 0))
        assert hit is not None
        assert (hit.fraction, hit.normal.tolist()) == (0.75, [-1, 0])
        assert bodies[hit.body] is crate
    # Above a margin there is one, and the floor alone is grazed.
    crate.position = (3, 0.5 + 1e-9)
    assert World([floor, crate]).query_ray((-5, 0), (5, 0)) is None
    assert World([floor]).query_ray((-5, 0), (5, 0)) is None


def test_at_a_border_a_wall_has_its_own_normal() -> None:
    """A slanted ray took the corner of a tile for a corner of the wall."""
    wall = World([Body(AxisAlignedRectangle(1, 1), (0, row)) for row in range(4)])
    for slope in (0.3, 1.0, -2.0):
        hit = wall.query_ray((-2.5, 1.5 - 2 * slope), (1.5, 1.5 + 2 * slope))
        assert hit is not None
        assert hit.fraction == pytest.approx(0.5, abs=1e-15)
        assert hit.normal.tolist() == [-1, 0]


def test_bodies_that_share_a_corner_leave_a_way() -> None:
    """Two tiles that touch at one point have nothing between them."""
    tiles = World([Body(AxisAlignedRectangle(1, 1), (i, i)) for i in range(2)])
    assert tiles.query_ray((-0.5, 1.5), (1.5, -0.5)) is None
    # Nor is a disc on a floor a border: they share a point.
    disc = World([Body(HalfPlane((0, 1))), Body(Particle(1), (0, 1))])
    assert disc.query_ray((-5, 0), (5, 0)) is None
    # A wedge that stands on its tip neither.
    wedge = World([Body(HalfPlane((0, 1))), Body(Convex([(0, 0), (1, 1), (-1, 1)]))])
    assert wedge.query_ray((-5, 0), (5, 0)) is None
    assert math.isinf(wedge.query_rays([(-5, 0)], [(5, 0)]).fractions[0])
