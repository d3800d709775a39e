"""A disc among a lattice's solid cells, against the distance to their union (Shapely)."""

import math

import numpy as np
import pytest
from arkanoid.physics.pairs.lattice import Lattice, _sweep_cell, sweep_disc_lattice
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point, box, union_all

COLUMNS, ROWS = 6, 5
coordinate = st.floats(-2.0, 8.0)
velocity = st.floats(-9.0, 9.0).map(lambda value: 0.0 if abs(value) < 1e-9 else value)


def make_lattice(columns=COLUMNS, rows=ROWS, width=1.0, height=0.5, left=0.25, top=4.0):
    lattice = np.zeros(1, Lattice)
    lattice[0] = (left, top, width, height, columns, rows)
    return lattice[0]


def cells_of(lattice, solid):
    """Return the union of the solid cells as a Shapely region."""
    boxes = []
    for cell in np.flatnonzero(solid):
        row, column = divmod(int(cell), int(lattice.columns))
        left = lattice.left + column * lattice.cell_width
        top = lattice.top - row * lattice.cell_height
        boxes.append(box(left, top - lattice.cell_height, left + lattice.cell_width, top))
    return union_all(boxes)


@settings(max_examples=600, deadline=None)
@given(
    st.lists(st.booleans(), min_size=COLUMNS * ROWS, max_size=COLUMNS * ROWS),
    coordinate,
    coordinate,
    velocity,
    velocity,
    st.sampled_from([0.0625, 0.125, 0.4, 1.3]),
)
def test_first_impact_against_the_distance_to_the_union(solid, x, y, vx, vy, radius):
    solid = np.array(solid, np.uint8)
    lattice = make_lattice()
    region = cells_of(lattice, solid)
    if not solid.any() or region.distance(Point(x, y)) < radius:
        return
    time, nx, ny, cell = sweep_disc_lattice(lattice, solid, x, y, vx, vy, radius, 1.0)

    def gap(at):
        return region.distance(Point(x + vx * at, y + vy * at)) - radius

    end = min(time, 1.0)
    assert all(gap(at) > -1e-12 for at in np.linspace(0.0, end, 100))
    if time <= 1.0:
        assert solid[cell]
        assert abs(gap(time)) < 1e-12
        assert math.isclose(nx * nx + ny * ny, 1.0, abs_tol=1e-15)
        # The normal points from the nearest point of the union to the disc, against the motion.
        nearest = Point(x + vx * time - radius * nx, y + vy * time - radius * ny)
        assert region.distance(nearest) < 1e-12
        assert vx * nx + vy * ny <= 0.0


@pytest.mark.parametrize("filled", [0.02, 0.3, 0.9])
def test_a_long_way_gives_the_bits_of_a_look_at_every_cell(filled):
    """It visits few cells, in another order; of cells met at once, the first in the rows counts."""
    columns, rows = 11, 18
    generator = np.random.default_rng(0)
    lattice = make_lattice(columns, rows, left=0.0, top=13.0)
    met = 0
    for number in range(1500):
        solid = (generator.random(columns * rows) < filled).astype(np.uint8)
        x, y = generator.uniform(-1.0, 12.0), generator.uniform(1.0, 15.0)
        vx, vy = generator.uniform(-0.5, 0.5, 2)
        if number % 3 == 0:
            # Along an axis or a diagonal, through the lattice's corners.
            x, y = round(x), round(2 * y) / 2
            vx, vy = ((0.0, 0.25), (0.25, 0.0), (0.25, -0.125), (-0.25, 0.125))[number // 3 % 4]
        radius = (0.125, 0.5)[number % 2]
        way = (x, y, vx, vy, radius, 200.0)
        expected = math.inf, 0.0, 0.0, -1
        for cell in np.flatnonzero(solid).tolist():
            row, column = divmod(cell, columns)
            found = _sweep_cell(lattice, solid, column, row, *way)
            if found[0] < expected[0]:
                expected = (*found, cell)
        assert sweep_disc_lattice(lattice, solid, *way) == expected
        met += expected[0] < math.inf
    assert met > 200


@settings(max_examples=300, deadline=None)
@given(st.floats(1.0, 5.0), st.floats(0.1, 1.0), st.floats(-20.0, 20.0), st.floats(-9.0, -0.1))
def test_a_row_of_cells_gives_the_same_bits_as_one_wall(x, y, vx, vy):
    """In other engines, balls hit inner corners at the seams ("ghost collisions")."""
    row, wall = (
        make_lattice(64, 1, left=-32.0, top=0.0),
        make_lattice(1, 1, 64.0, left=-32.0, top=0.0),
    )
    bricks = np.ones(64, np.uint8)
    one = sweep_disc_lattice(row, bricks, x, y + 0.125, vx, vy, 0.125, 1.0)
    other = sweep_disc_lattice(wall, bricks[:1], x, y + 0.125, vx, vy, 0.125, 1.0)
    assert one[:3] == other[:3]


def test_a_disc_in_a_concave_corner_meets_both_faces_and_neither_corner():
    lattice = make_lattice(2, 2, 1.0, 1.0, left=0.0, top=2.0)
    solid = np.array([1, 0, 1, 1], np.uint8)  # an L: the free cell is the upper right one
    time, nx, ny, _ = sweep_disc_lattice(lattice, solid, 1.125, 1.125, -1.0, -1.0, 0.125, 1.0)
    assert (time, abs(nx) + abs(ny)) == (0.0, 1.0)
    time, nx, ny, _ = sweep_disc_lattice(lattice, solid, 1.125, 1.125, 1.0, -1.0, 0.125, 1.0)
    assert (time, nx, ny) == (0.0, 0.0, 1.0)


@pytest.mark.parametrize("speed", [1e3, 1e9])
def test_no_speed_is_too_fast(speed):
    lattice = make_lattice(left=0.0, top=4.0)
    solid = np.ones(COLUMNS * ROWS, np.uint8)
    time, nx, ny, _ = sweep_disc_lattice(lattice, solid, 3.5, 0.0, 0.0, speed, 0.125, 1.0)
    assert math.isclose(time * speed, 1.375, rel_tol=1e-15)
    assert (nx, ny) == (0.0, -1.0)


def test_touching_is_no_impact_for_a_disc_that_slides_or_recedes():
    lattice = make_lattice(left=0.0, top=4.0)
    solid = np.ones(COLUMNS * ROWS, np.uint8)
    for vx, vy in [(1.0, 0.0), (-1.0, 0.0), (0.3, -1.0), (0.0, 0.0)]:
        assert sweep_disc_lattice(lattice, solid, 3.0, 1.375, vx, vy, 0.125, 1.0)[0] == math.inf
    assert sweep_disc_lattice(lattice, solid, 3.0, 1.375, 0.0, 1.0, 0.125, 1.0)[0] == 0.0
