"""Any shape among the boxes of a lattice: when it meets which cell, by an independent search."""

import math

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedRectangle,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
    time_of_impact,
)
from arkanoid.physics.pairs.approach import approach_between, will_touch
from arkanoid.physics.pairs.lattice import Lattice, cell_centre
from arkanoid.physics.pairs.shape_lattice import sweep_shape_lattice
from arkanoid.physics.shapes.table import shape_table
from shapely import Polygon, box, union_all

COLUMNS, ROWS = 7, 6
WIDTH, HEIGHT = 1.0, 0.5
OUTLINES = [
    [(0.0, -0.36), (0.36, 0.24), (-0.36, 0.24)],
    [(-0.3, -0.2), (0.3, -0.2), (0.3, 0.2), (-0.3, 0.2)],
    [(0.5, 0.0), (0.0, 0.8), (-0.4, 0.1), (-0.1, -0.7)],
]
SHAPES = [Convex(OUTLINES[0]), AxisAlignedRectangle(0.6, 0.4), Convex(OUTLINES[2])]


def make_lattice():
    lattice = np.zeros(1, Lattice)
    lattice[0] = (-2.0, 3.0, WIDTH, HEIGHT, COLUMNS, ROWS)
    return lattice[0]


def box_of(cell):
    column, row = cell % COLUMNS, cell // COLUMNS
    left, top = -2.0 + column * WIDTH, 3.0 - row * HEIGHT
    return box(left, top - HEIGHT, left + WIDTH, top)


@pytest.mark.parametrize("shape", range(3))
def test_the_first_impact_is_where_shapely_finds_the_first_overlap(shape):
    lattice = make_lattice()
    rng = np.random.default_rng(shape)
    shapes, edges = shape_table([SHAPES[shape], AxisAlignedRectangle(WIDTH, HEIGHT)])
    outline = np.array(OUTLINES[shape])
    met = 0
    for _ in range(800):
        solid = (rng.random(COLUMNS * ROWS) < 0.3).astype(np.uint8)
        bricks = union_all([box_of(cell) for cell in np.flatnonzero(solid)])
        x, y = rng.uniform(-3, 6), rng.uniform(-1, 4)
        if Polygon(np.add(outline, [x, y])).distance(bricks) < 1e-6:
            continue
        vx, vy = rng.normal(size=2)
        duration = rng.uniform(0.1, 3.0)
        time, normal_x, normal_y, cell = sweep_shape_lattice(
            shapes, edges, 0, 1, lattice, solid, x, y, vx, vy, duration
        )
        ends = [np.add(outline, [x, y]), np.add(outline, [x + vx * duration, y + vy * duration])]
        swept = union_all([Polygon(end) for end in ends]).convex_hull
        if time == math.inf:
            assert swept.intersection(bricks).area < 1e-9
            continue
        met += 1
        assert solid[cell] != 0
        assert math.isclose(math.hypot(normal_x, normal_y), 1.0, rel_tol=1e-12)
        assert normal_x * vx + normal_y * vy < 0.0
        # Until then it overlaps nothing, and at that time it touches the cell.
        there = np.add(outline, [x + vx * time, y + vy * time])
        before = union_all([Polygon(np.add(outline, [x, y])), Polygon(there)]).convex_hull
        assert before.intersection(bricks).area < 1e-9
        assert Polygon(there).distance(box_of(cell)) < 1e-9
    assert met > 80


def test_a_shape_far_away_meets_nothing():
    shapes, edges = shape_table([SHAPES[0], AxisAlignedRectangle(WIDTH, HEIGHT)])
    solid = np.ones(COLUMNS * ROWS, np.uint8)
    for x, y, vx, vy in [(1.0, 10.0, 5.0, 0.0), (-9.0, 1.0, 0.0, 3.0), (1.0, 9.0, 0.0, 1.0)]:
        assert (
            sweep_shape_lattice(shapes, edges, 0, 1, make_lattice(), solid, x, y, vx, vy, 1.0)[0]
            == math.inf
        )


def test_a_receding_overlap_is_no_impact_and_hides_none():
    """A shape that a rounding error leaves inside a brick moves off it, to the next one."""
    lattice = make_lattice()
    shapes, edges = shape_table([SHAPES[1], AxisAlignedRectangle(WIDTH, HEIGHT)])
    solid = np.zeros(COLUMNS * ROWS, np.uint8)
    solid[[0, 3]] = 1  # from -2 to -1 and from 1 to 2, 2.5 to 3
    x = -1.0 + 0.3 - 1e-9
    time, normal_x, _, cell = sweep_shape_lattice(
        shapes, edges, 0, 1, lattice, solid, x, 2.75, 1.0, 0.0, 5.0
    )
    assert cell == 3
    assert normal_x == -1.0
    assert math.isclose(time, 1.0 - 0.3 - x, rel_tol=1e-9)


def test_centres_of_cells():
    for cell in range(COLUMNS * ROWS):
        centre = box_of(cell).centroid
        assert cell_centre(make_lattice(), cell) == pytest.approx((centre.x, centre.y))


COLLIDERS = [
    Particle(0.4),
    HalfPlane((0.6, 0.8), 0.1),
    AxisAlignedRectangle(0.7, 0.5),
    Rectangle(0.7, 0.5, 0.4),
    Convex(OUTLINES[2]),
]


class Thing:
    def __init__(self, collider, position, velocity=(0.0, 0.0)):
        self.collider, self.position, self.velocity = collider, position, velocity


@pytest.mark.parametrize("first", range(5))
@pytest.mark.parametrize("second", range(5))
def test_approach_is_the_time_of_impact_of_approaching_pairs(first, second):
    rng = np.random.default_rng(first * 5 + second)
    a, b = COLLIDERS[first], COLLIDERS[second]
    shapes, edges = shape_table([a, b])
    outcomes = set()
    for _ in range(300):
        dx, dy, vx, vy = rng.normal(size=4) * 1.5
        arguments = (shapes, edges, 0, 1, dx, dy, vx, vy, 1.0)
        time, normal_x, normal_y = approach_between(*arguments)
        impact = time_of_impact(Thing(a, (0, 0)), Thing(b, (dx, dy), (vx, vy)), 1.0)
        assert will_touch(*arguments) == (impact is not None)
        if impact is None or impact.normal @ (vx, vy) >= 0.0:
            assert time == math.inf
        else:
            assert (time, normal_x, normal_y) == (impact.time, *impact.normal)
        outcomes.add(time < math.inf)
    assert outcomes == {False, True} or (first == 1 and second == 1)
