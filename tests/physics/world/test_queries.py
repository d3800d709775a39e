"""Queries of a world, compared with a test of every body, one by one."""

import math
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    HalfPlane,
    Particle,
    World,
    contact,
    detect,
    time_of_impact,
)
from helpers.bodies import OPEN_SHAPE, SHAPES, bodies_of
from hypothesis import assume, given, settings
from hypothesis import strategies as st


def scene() -> tuple[World, list[Body], list[int]]:
    """Return a world that has been stepped, its bodies as they are now, and their categories."""
    rng = np.random.default_rng(4)
    world = World([Body(HalfPlane((1, 3)), (0, -6)), Body(AxisAlignedHalfPlane("-x"), (7, 0))])
    categories = [1, 1]
    for index in range(20):
        category, shape = 1 << int(rng.integers(4)), (*SHAPES, OPEN_SHAPE)[index % 5]
        place, velocity = rng.uniform(-5, 5, 2), rng.normal(size=2) * (index % 3 > 0)
        if index % 5 == 4 or index % 4 == 0:
            body = Body(shape, place, velocity if index % 5 != 4 else (0, 0))
        else:
            body = Body(shape, place, velocity, mass=1)
        world.add(body, category=category, mask=0, sensor=index % 7 == 0)
        categories.append(category)
    world.step(0.75, steps=3)
    return world, bodies_of(world), categories


WORLD, BODIES, CATEGORIES = scene()
coordinate = st.one_of(st.floats(-8, 8), st.integers(-8, 8).map(float))
places = st.tuples(coordinate, coordinate)
masks = st.sampled_from([-1, -1, -1, 0, 1, 2, 6, 15, 1 << 62])


@settings(max_examples=150, deadline=None)
@given(places, masks)
def test_points_are_in_the_bodies_that_contain_them(point: tuple[float, float], mask: int) -> None:
    expected = [
        index
        for index, (body, category) in enumerate(zip(BODIES, CATEGORIES, strict=True))
        if category & mask and detect(Body(Particle(0), point), body)
    ]
    found = WORLD.query_point(point, mask)
    assert found.dtype == np.int64
    assert found.tolist() == expected


@settings(max_examples=150, deadline=None)
@given(places, places, masks)
def test_boxes_find_the_bodies_that_they_overlap(
    corner: tuple[float, float], opposite: tuple[float, float], mask: int
) -> None:
    lower, upper = np.minimum(corner, opposite), np.maximum(corner, opposite)
    assume((upper - lower).min() > 0)
    box = Body(AxisAlignedRectangle(*(upper - lower)), (lower + upper) / 2)
    expected = [
        index
        for index, (body, category) in enumerate(zip(BODIES, CATEGORIES, strict=True))
        if category & mask and detect(box, body)
    ]
    assert WORLD.query_box(lower, upper, mask).tolist() == expected


@settings(max_examples=300, deadline=None)
@given(places, places, st.sampled_from([0.0, 0.0, 0.25, 2.0]), masks)
def test_rays_find_the_first_body(
    start: tuple[float, float], end: tuple[float, float], radius: float, mask: int
) -> None:
    probe = Body(Particle(radius), start, np.subtract(end, start))
    met = []
    for index, (body, category) in enumerate(zip(BODIES, CATEGORIES, strict=True)):
        impact = time_of_impact(probe, Body(body.collider, body.position), 1.0)
        if category & mask and impact is not None:
            met.append((impact.time, index, impact.normal))
    hit = WORLD.query_ray(start, end, radius, mask)
    if not met:
        assert hit is None
        return
    time, index, normal = min(met, key=lambda row: row[:2])
    assert hit is not None
    assert (hit.body, hit.fraction) == (index, time)
    assert hit.normal.tolist() == (-normal).tolist()
    assert hit.point == pytest.approx(np.add(start, time * np.subtract(end, start)), abs=1e-15)


def test_queries_use_present_positions() -> None:
    """They once used positions extrapolated back to time 0 with the present velocities."""
    world = World([Body(Particle(0.5), (0, 0), (1, 0), mass=1)])
    for time in (0, 5, 10):
        assert world.query_point((time, 0.25)).tolist() == [0]
        assert world.query_point((time - 5, 0.25)).tolist() == []
        assert world.query_box((time - 0.1, 0), (time, 0.1)).tolist() == [0]
        hit = world.query_ray((time, 5), (time, -5))
        assert hit is not None
        assert (hit.body, hit.fraction) == (0, 0.45)
        world.step(5.0)
    world.place(0, (3, 3))
    assert world.query_point((3, 3)).tolist() == [0]
    assert world.query_point((15, 0)).tolist() == []
    world.add(Body(Particle(1), (3, 3)))
    assert world.query_point((3, 3)).tolist() == [0, 1]


def test_what_a_ray_returns() -> None:
    world = World([Body(AxisAlignedRectangle(2, 2), (5, 0)), Body(Particle(1), (5, 5))])
    hit = world.query_ray((0, 0), (8, 0))
    assert hit is not None
    assert (hit.body, hit.fraction) == (0, 0.5)
    assert hit.point.tolist() == [4, 0]
    assert hit.normal.tolist() == [-1, 0]
    cast = world.query_ray((5, 10), (5, 0), radius=0.5)
    assert cast is not None
    assert (cast.body, cast.fraction) == (1, 0.35)
    assert cast.point.tolist() == [5, 6.5]
    assert cast.normal.tolist() == [0, 1]
    assert world.query_ray((0, 0), (3.999, 0)) is None
    assert world.query_ray((0, 0), (-8, 0)) is None
    # Along a side, it only touches.
    assert world.query_ray((0, 1), (8, 1)) is None


def test_a_ray_from_inside_begins_there() -> None:
    box = Body(AxisAlignedRectangle(4, 2))
    world = World([box])
    for end in ((9, 9), (0.5, 0.5), (-3, 0)):
        hit = world.query_ray((0.5, 0.5), end)
        assert hit is not None
        assert (hit.body, hit.fraction) == (0, 0)
        assert hit.point.tolist() == [0.5, 0.5]
        overlap = contact(box, Body(Particle(0), (0.5, 0.5)))
        assert overlap is not None
        assert hit.normal.tolist() == overlap.normal.tolist() == [0, 1]


def test_queries_leave_the_world_as_it_is() -> None:
    asked, alone = scene()[0], scene()[0]
    for _ in range(3):
        asked.query_point((0, 0))
        asked.query_ray((-9, -9), (9, 9))
        asked.query_box((-1, -1), (1, 1))
        assert asked.step(0.2).tobytes() == alone.step(0.2).tobytes()
    assert asked.snapshot() == alone.snapshot()


def test_nothing_is_found_where_there_is_nothing() -> None:
    world = World()
    assert world.query_point((0, 0)).tolist() == []
    assert world.query_box((0, 0), (1, 1)).tolist() == []
    assert world.query_ray((0, 0), (1, 1)) is None


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda w: w.query_point(3), TypeError, "point must be two numbers.*3"),
        (lambda w: w.query_point((0, math.nan)), ValueError, r"point\[1\].*finite.*nan"),
        (lambda w: w.query_point((0, 0), 1.0), TypeError, "mask.*integer.*1.0"),
        (lambda w: w.query_point((0, 0), 1 << 64), ValueError, "mask.*64 bits"),
        (lambda w: w.query_box((0, 0), (1, 0)), ValueError, "lower must be below and left"),
        (lambda w: w.query_box((0, 0), (math.inf, 1)), ValueError, r"upper\[0\].*finite"),
        (lambda w: w.query_box((-1e308, 0), (1e308, 1)), ValueError, "width.*finite"),
        (lambda w: w.query_ray((0,), (1, 1)), ValueError, "start must be two numbers"),
        (lambda w: w.query_ray((0, 0), "up"), TypeError, "end must be two numbers"),
        (lambda w: w.query_ray((0, 0), (1, 1), -1), ValueError, "radius.*negative.*-1"),
        (lambda w: w.query_ray((0, 0), (1, 1), mask=None), TypeError, "mask.*integer.*None"),
    ],
)
def test_an_invalid_query_is_refused(call: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        call(WORLD)
