"""What holds for every pair of kinds: it is registered, swapping mirrors it, nothing is NaN."""

import math
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
)
from arkanoid.physics.pairs.table import (
    ALGORITHM,
    REGISTERED,
    UNREGISTERED,
    contact_between,
    impact_between,
    may_touch,
    overlap_between,
)
from arkanoid.physics.shapes.records import KINDS
from arkanoid.physics.shapes.table import shape_table
from helpers.bodies import COLLIDERS
from hypothesis import example, given, settings
from hypothesis import strategies as st

SAMPLES: tuple[Collider, ...] = (
    *COLLIDERS,
    Convex([(1, 1), (-1, 1), (-1, 0), (1, 0)], [0, 2], 1.0),
)
PAIRS = list(combinations_with_replacement(SAMPLES, 2))


def test_every_pair_of_kinds_is_registered_once() -> None:
    assert len(REGISTERED) == KINDS * (KINDS + 1) // 2 == 21
    assert len({frozenset((first, second)) for first, second, _ in REGISTERED}) == 21
    assert not (ALGORITHM == UNREGISTERED).any()
    assert (ALGORITHM == ALGORITHM.T).all()
    assert {collider.kind for collider in SAMPLES} == set(range(KINDS))


# Numbers that are difficult to compute with, and ordinary ones.
TRICKY = [0.0, -0.0, 0.5, 1.0, -1.0, 1.5, 2.0, 1e-9, -1e-300, 5e-324, 1e9, -1e9, 1e-160]
coordinate = st.one_of(st.sampled_from(TRICKY), st.floats(-4, 4), st.integers(-4, 4).map(float))
pairs = st.sampled_from(PAIRS)


def table(a: Collider, b: Collider) -> tuple[Any, Any]:
    return shape_table((a, b))


@settings(max_examples=1500, deadline=None)
@given(pairs, coordinate, coordinate)
def test_swapping_a_contact_reverses_its_normal(
    pair: tuple[Collider, Collider], dx: float, dy: float
) -> None:
    shapes, edges = table(*pair)
    found, nx, ny, depth, x, y = contact_between(shapes, edges, 0, 1, dx, dy)
    back = contact_between(shapes, edges, 1, 0, -dx, -dy)
    assert back[0] == found == overlap_between(shapes, edges, 0, 1, dx, dy)
    assert np.isfinite([nx, ny, x, y]).all()
    if found:
        if pair[0] == pair[1] and dx == dy == 0.0:
            # The same shape at the same position: nothing tells the two apart.
            assert back[1:4] == (nx, ny, depth)
        else:
            assert back[1:4] == (-nx, -ny, depth)
        assert depth > 0
        assert math.hypot(nx, ny) == pytest.approx(1, abs=1e-15)


@settings(max_examples=1500, deadline=None)
@given(pairs, *[coordinate] * 4, st.sampled_from([0.0, 1.0, 1e9, math.inf]))
@example((Particle(0.5), AxisAlignedRectangle(2, 1)), -2.0, 0.0, 5e-324, 0.0, math.inf)
def test_swapping_an_impact_reverses_its_normal(
    pair: tuple[Collider, Collider], dx: float, dy: float, vx: float, vy: float, duration: float
) -> None:
    """In the example the time is too large for a number: it was inf, but there was a normal."""
    shapes, edges = table(*pair)
    time, nx, ny = impact_between(shapes, edges, 0, 1, dx, dy, vx, vy, duration)
    back = impact_between(shapes, edges, 1, 0, -dx, -dy, -vx, -vy, duration)
    assert back[0] == time
    if not (pair[0] == pair[1] and dx == dy == 0.0):
        assert back[1:] == (-nx, -ny)
    found, contact_x, contact_y = contact_between(shapes, edges, 0, 1, dx, dy)[:3]
    if found:
        assert (time, nx, ny) == (0.0, contact_x, contact_y)
    elif time < math.inf:
        assert 0 <= time <= duration
        assert math.hypot(nx, ny) == pytest.approx(1, abs=1e-14)
        assert nx * vx + ny * vy < 0
        assert may_touch(shapes, 0, 1, dx, dy, vx, vy, duration)
    else:
        assert (nx, ny) == (0, 0)


@settings(max_examples=1000, deadline=None)
@given(pairs, *[coordinate] * 4, st.floats(0, 50))
def test_bounding_boxes_never_miss_a_touch(
    pair: tuple[Collider, Collider], dx: float, dy: float, vx: float, vy: float, duration: float
) -> None:
    shapes, edges = table(*pair)
    if impact_between(shapes, edges, 0, 1, dx, dy, vx, vy, duration)[0] < math.inf:
        assert may_touch(shapes, 0, 1, dx, dy, vx, vy, duration)
        assert may_touch(shapes, 1, 0, -dx, -dy, -vx, -vy, duration)


def test_bounding_boxes_exclude_pairs_that_stay_apart() -> None:
    shapes, _ = shape_table((Particle(1), AxisAlignedRectangle(2, 2), AxisAlignedHalfPlane("-x")))
    assert not may_touch(shapes, 0, 1, 3.0, 0.0, 0.0, 0.0, math.inf)
    assert not may_touch(shapes, 0, 1, 3.0, 0.0, 1.0, 5.0, math.inf)
    assert not may_touch(shapes, 0, 1, 3.0, 0.0, -1.0, 0.0, 0.9)
    assert may_touch(shapes, 0, 1, 3.0, 0.0, -1.0, 0.0, 1.0)
    assert not may_touch(shapes, 0, 1, 0.0, -3.0, 0.0, 0.5, 1.0)
    assert not may_touch(shapes, 0, 2, 2.0, 7.0, 0.0, -9.0, 100.0)
    assert may_touch(shapes, 0, 2, 2.0, 7.0, -1.0, -9.0, 1.0)


@pytest.mark.parametrize(("a", "b"), PAIRS)
def test_every_pair_separates_or_is_inseparable(a: Collider, b: Collider) -> None:
    """After one translation by the depth the two are apart, or just touch."""
    rng = np.random.default_rng(3)
    shapes, edges = table(a, b)
    contacts = 0
    for dx, dy in rng.normal(0, 1, (100, 2)).tolist():
        found, nx, ny, depth, _, _ = contact_between(shapes, edges, 0, 1, dx, dy)
        if not found:
            continue
        contacts += 1
        if depth == math.inf:
            continue
        dx, dy = dx + nx * depth, dy + ny * depth
        _, _, _, left, _, _ = contact_between(shapes, edges, 0, 1, dx, dy)
        assert left <= 1e-12
        # A slightly shorter translation does not separate.
        assert overlap_between(shapes, edges, 0, 1, dx - 1e-9 * nx, dy - 1e-9 * ny)
    assert contacts > 5


@pytest.mark.parametrize(("a", "b"), PAIRS)
def test_at_the_time_of_impact_every_pair_touches(a: Collider, b: Collider) -> None:
    """They are apart shortly before and overlap shortly after: impact and contact agree."""
    rng = np.random.default_rng(4)
    shapes, edges = table(a, b)
    impacts = 0
    for dx, dy, vx, vy in rng.normal(0, [3, 3, 2, 2], (300, 4)).tolist():
        if overlap_between(shapes, edges, 0, 1, dx, dy):
            continue
        time, _, _ = impact_between(shapes, edges, 0, 1, dx, dy, vx, vy, math.inf)
        if time == math.inf:
            for later in np.linspace(0, 20, 200):
                assert not overlap_between(shapes, edges, 0, 1, dx + vx * later, dy + vy * later)
            continue
        impacts += 1
        for later in np.linspace(0, max(time - 1e-9, 0), 20):
            assert not overlap_between(shapes, edges, 0, 1, dx + vx * later, dy + vy * later)
        after = time + 1e-6
        assert overlap_between(shapes, edges, 0, 1, dx + vx * after, dy + vy * after)
    apart = contact_between(shapes, edges, 0, 1, 0.0, 0.0)[3] < math.inf
    assert impacts > 5 or not apart


@pytest.mark.parametrize(
    ("a", "b"), [(a, b) for a, b in PAIRS if a.kind != b.kind or a.kind == Particle.kind]
)
def test_shapes_at_the_very_same_position_have_a_contact(a: Collider, b: Collider) -> None:
    shapes, edges = table(a, b)
    found, nx, ny, depth, _, _ = contact_between(shapes, edges, 0, 1, 0.0, 0.0)
    if found:
        assert depth > 0
        assert math.hypot(nx, ny) == pytest.approx(1, abs=1e-15)
        time = impact_between(shapes, edges, 0, 1, 0.0, 0.0, 0.0, 0.0, math.inf)
        assert time == (0.0, nx, ny)


@pytest.mark.parametrize(("first", "second"), [(0.5, 1.5), (1.5, 0.5)])
def test_coincident_discs_of_different_sizes_swap(first: float, second: float) -> None:
    """Where positions cannot order the two, their data does."""
    shapes, edges = shape_table((Particle(first), Particle(second)))
    one = contact_between(shapes, edges, 0, 1, 0.0, 0.0)
    other = contact_between(shapes, edges, 1, 0, 0.0, 0.0)
    assert one[3] == other[3] == 2.0
    assert (one[1], one[2]) == (-other[1], -other[2])


def test_a_specialised_algorithm_equals_the_general_one() -> None:
    """Boxes as axis-aligned rectangles, as rectangles, and as polygons."""
    rng = np.random.default_rng(8)
    box = [(1, 0.5), (-1, 0.5), (-1, -0.5), (1, -0.5)]
    forms = (AxisAlignedRectangle(2, 1), Rectangle(2, 1), Convex(box), Rectangle(1, 2, math.pi / 2))
    planes = (AxisAlignedHalfPlane("+y", 0.5), HalfPlane((0, 2), 1), Convex(box, [1, 2, 3]))
    for group in (forms, planes):
        for other in (Particle(0.75), AxisAlignedRectangle(1, 3), Rectangle(1, 2, 0.3)):
            shapes, edges = shape_table((*group, other))
            last = len(group)
            for dx, dy, vx, vy in rng.normal(0, 2, (300, 4)).tolist():
                contacts = [contact_between(shapes, edges, i, last, dx, dy) for i in range(last)]
                impacts = [
                    impact_between(shapes, edges, i, last, dx, dy, vx, vy, math.inf)
                    for i in range(last)
                ]
                np.testing.assert_allclose(contacts, [contacts[0]] * last, rtol=0, atol=1e-14)
                np.testing.assert_allclose(impacts, [impacts[0]] * last, rtol=1e-12, atol=1e-14)
