"""What touching is: the margin, and that contacts, impacts and relaxation agree about it."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
    contact,
    detect,
    relax,
    time_of_impact,
)
from arkanoid.physics.pairs.table import impact_between, overlap_between
from arkanoid.physics.pairs.touching import touch_margins
from arkanoid.physics.shapes.table import shape_table
from arkanoid.physics.tolerances import TOUCH
from helpers.bodies import COLLIDERS


@pytest.mark.parametrize("far", [1.0, 1e3, 1e9])
def test_relaxed_bodies_are_apart(far: float) -> None:
    """After relaxation some pairs still overlapped by a rounding, and detection found them."""
    rng = np.random.default_rng(1)
    moved = 0
    for _ in range(1500):
        first, second = rng.choice(len(COLLIDERS), 2)
        place = rng.uniform(-far, far, 2)
        a = Body(COLLIDERS[first], place, mass=float(rng.uniform(0.1, 9)))
        b = Body(COLLIDERS[second], place + rng.normal(size=2), mass=float(rng.uniform(0.1, 9)))
        overlap = contact(a, b)
        if overlap is None or overlap.depth == math.inf:
            continue
        moved += 1
        relax(a, b, overlap)
        assert not detect(a, b)
        assert contact(a, b) is None
    assert moved > 300


def test_the_margin_is_a_fraction_of_coordinates_and_sizes_along_each_axis() -> None:
    shapes, edges = shape_table((AxisAlignedRectangle(8, 2), HalfPlane((0, 5), 15), Particle(0.5)))
    assert touch_margins(shapes, edges, 0, 2, 16.0, -3.0, -2.0, 0.5) == (22.5 * TOUCH, 5 * TOUCH)
    # A half-plane has no size; what counts is how far from its position it begins.
    assert touch_margins(shapes, edges, 1, 2, 0.0, 1.0, 7.0, 0.0) == (7.5 * TOUCH, 4.5 * TOUCH)
    assert touch_margins(shapes, edges, 2, 1, 7.0, 0.0, 0.0, 1.0) == (7.5 * TOUCH, 4.5 * TOUCH)


@pytest.mark.parametrize("above", [Particle(0.5), AxisAlignedRectangle(3, 1), Rectangle(1, 1, 0.0)])
@pytest.mark.parametrize(
    "below", [AxisAlignedRectangle(9, 1), Rectangle(9, 1, 0.0), AxisAlignedHalfPlane("+y", 0.5)]
)
def test_within_the_margin_two_bodies_touch_and_beyond_it_they_overlap(
    above: Collider, below: Collider
) -> None:
    """A gap within the margin counts as 0 for detection, contact and the time of impact."""
    margin = (0.5 + 0.5 + 2 + 3) * TOUCH  # half heights, and heights
    floor = Body(below, (0, 2))
    for depth in (-0.9 * margin, 0.0, 0.9 * margin):
        body = Body(above, (0.5, 3 - depth), mass=1)
        assert not detect(body, floor)
        assert contact(body, floor) is None
        for velocity in ((1, 0), (-3, 0), (0, 0), (0.5, 1e-9), (0, 2)):
            body.velocity = np.array(velocity, float)
            assert time_of_impact(body, floor) is None
        body.velocity = np.array((0.25, -2.0))
        impact = time_of_impact(body, floor)
        assert impact is not None
        assert impact.time == pytest.approx(max(-depth, 0.0) / 2, abs=1e-15)
        assert impact.normal.tolist() == [0, -1]
    body = Body(above, (0.5, 3 - 1.1 * margin), (1, 0), mass=1)
    overlap = contact(body, floor)
    assert overlap is not None
    assert overlap.depth == pytest.approx(1.1 * margin, rel=1e-2)
    impact = time_of_impact(body, floor)
    assert impact is not None
    assert impact.time == 0


@pytest.mark.parametrize("first", range(len(COLLIDERS)))
def test_an_impact_begins_an_overlap_and_without_one_there_is_none(first: int) -> None:
    """For shapes in one-decimal numbers, which meet corner to corner, slide and graze."""
    rng = np.random.default_rng(first)
    shapes, edges = shape_table(COLLIDERS)
    times = np.concatenate([np.geomspace(1e-6, 20, 60), np.linspace(0, 20, 101)])
    impacts = 0
    for _ in range(200):
        second = int(rng.integers(len(COLLIDERS)))
        d, v = rng.integers(-40, 41, 2) / 10, rng.integers(-3, 4, 2) / 2
        margins = touch_margins(shapes, edges, first, second, 0.0, 0.0, *d.tolist())

        def overlaps(time: float, second: int = second, d: Any = d, v: Any = v) -> bool:
            place = (d + v * time).tolist()
            # With a margin for the way, too: positions later in the flight are rounded again.
            wide = touch_margins(shapes, edges, first, second, 0.0, 0.0, *(place + d).tolist())
            return bool(overlap_between(shapes, edges, first, second, *place, *wide))

        if overlap_between(shapes, edges, first, second, *d.tolist(), *margins):
            continue
        time, nx, ny = impact_between(
            shapes, edges, first, second, *d.tolist(), *v.tolist(), math.inf, *margins
        )
        before = times[times < time - 1e-9] if time < math.inf else times
        # A disc that grazes may dip in by less than the samples see; what they see must be true.
        assert not any(overlaps(float(at)) for at in before)
        if time < math.inf:
            impacts += 1
            assert nx * v[0] + ny * v[1] < 0
            later = time + np.geomspace(1e-7, 20, 200)
            assert any(overlaps(float(at)) for at in later)
    assert impacts > 10


def exact_boxes(
    reach: list[Fraction], d: list[Fraction], v: list[Fraction]
) -> tuple[Fraction, set[int]] | None:
    """Return when open boxes meet, in exact numbers, and along which axes (0, 1); None if never."""
    enter, leave, axes = Fraction(0), None, set()
    for axis in (0, 1):
        if v[axis] == 0:
            if abs(d[axis]) >= reach[axis]:
                return None
            continue
        ends = sorted((side * reach[axis] - d[axis]) / v[axis] for side in (-1, 1))
        if ends[0] >= 0 and ends[0] >= enter:
            axes = {axis} if ends[0] > enter or not axes else axes | {axis}
        enter = max(enter, ends[0])
        leave = ends[1] if leave is None else min(leave, ends[1])
    if leave is not None and enter >= leave:
        return None
    return enter, axes


def test_boxes_in_decimal_numbers_meet_as_in_exact_arithmetic() -> None:
    """0.1 + 0.2 is not 0.3 in floating point, but boxes of these sizes slide, graze and meet so.

    Numbers with one digit make half of the flights slide along, pass corners or start at a touch.
    """
    rng = np.random.default_rng(6)
    forms = (
        lambda w, h: AxisAlignedRectangle(w, h),
        lambda w, h: Rectangle(h, w, math.pi / 2),
        lambda w, h: Convex([(-w / 2, -h / 2), (w / 2, -h / 2), (w / 2, h / 2), (-w / 2, h / 2)]),
    )
    seen = {"hits": 0, "misses": 0, "corners": 0, "overlaps": 0}
    for number in range(4000):
        sizes = 2 * rng.integers(1, 7, 4) - number % 2
        places, velocity = rng.integers(-15, 16, 4), rng.integers(-2, 3, 2)
        if number % 3 == 0:  # a corner flies at a corner
            corner = rng.choice([-1, 1], 2) * (sizes[:2] + sizes[2:]) // 2
            places[2:] = places[:2] + corner - velocity * rng.integers(4)
        sizes, places, velocity = sizes.tolist(), places.tolist(), velocity.tolist()
        a, b = (forms[rng.integers(3)](w / 10, h / 10) for w, h in (sizes[:2], sizes[2:]))
        one = Body(a, (places[0] / 10, places[1] / 10))
        other = Body(b, (places[2] / 10, places[3] / 10), velocity, mass=1)
        reach = [Fraction(sizes[axis] + sizes[axis + 2], 20) for axis in (0, 1)]
        d = [Fraction(places[axis + 2] - places[axis], 10) for axis in (0, 1)]
        found = time_of_impact(one, other)
        assert detect(one, other) == all(abs(d[axis]) < reach[axis] for axis in (0, 1))
        if detect(one, other):
            assert found is not None
            assert found.time == 0
            seen["overlaps"] += 1
            continue
        exact = exact_boxes(reach, d, [Fraction(speed) for speed in velocity])
        if exact is None:
            assert found is None
            seen["misses"] += 1
            continue
        time, axes = exact
        assert found is not None
        assert found.time == pytest.approx(float(time), abs=1e-14)
        axis = int(abs(found.normal[1]) > 0.5)
        assert found.normal[axis] == -np.sign(velocity[axis])
        assert axis in axes
        if len(axes) == 2:  # corner to corner: the slower axis, if one is slower
            assert abs(velocity[axis]) == min(map(abs, velocity))
            seen["corners"] += 1
        seen["hits"] += 1
    assert min(seen.values()) > 50
