"""Queries of a world, compared with a test of every body, one by one."""

import math
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
    # It once passed through the corner.
    diamond = World([Body(Rectangle(2, 2, math.pi / 4))])
    hit = diamond.query_ray((-5, 0), (5, 0))
    assert hit is not None
    assert hit.fraction == pytest.approx((5 - math.sqrt(2)) / 10, rel=1e-15)
    assert hit.normal.tolist() == [-1, 0]


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


def random_polygon(rng: np.random.Generator) -> Collider:
    """Return a polygon of each kind, partly in numbers that users write."""
    kind = rng.integers(3)
    if kind == 0:
        return AxisAlignedRectangle(*rng.uniform(0.2, 3, 2).round(1))
    if kind == 1:
        rotation = float(rng.choice([math.pi / 4, 0.3, rng.uniform(-3, 3)]))
        return Rectangle(*rng.uniform(0.2, 3, 2).round(1), rotation)
    count = int(rng.integers(3, 8))
    angles = (np.sort(rng.uniform(0, 0.8, count)) + np.arange(count)) * math.tau / count
    size = rng.uniform(0.3, 3)
    return Convex((size * np.column_stack([np.cos(angles), np.sin(angles)])).tolist())


def check_corners(seed: int, count: int) -> None:
    """Send rays through corners, in random directions and along the axes.

    Which side of each edge of the corner a direction leads to says whether the ray enters.
    """
    rng = np.random.default_rng(seed)
    seen = {"enters": 0, "grazes": 0}
    for _ in range(count):
        shape, place = random_polygon(rng), rng.uniform(-20, 20, 2).round(1)
        world = World([Body(shape, place)])
        for index, edge in enumerate(shape.edges):
            before = shape.edges[index - 1]
            angle = (
                rng.uniform(0, math.tau) if rng.random() < 0.7 else rng.integers(8) / 8 * math.tau
            )
            way = np.array([math.cos(angle), math.sin(angle)])
            normals = [np.array([e.normal_x, e.normal_y]) for e in (before, edge)]
            rises = [normal @ way for normal in normals]
            # Nearly along an edge, rounding decides; from inside, it has entered before.
            if min(map(abs, rises)) < 1e-3 or min(rises) > 0:
                continue
            corner = place + np.array([edge.start_x, edge.start_y])
            lengths = rng.uniform(1, 10, 2).round(1)
            hit = world.query_ray(corner - lengths[0] * way, corner + lengths[1] * way)
            if max(rises) > 0:
                assert hit is None
                seen["grazes"] += 1
                continue
            assert hit is not None
            assert hit.fraction == pytest.approx(lengths[0] / lengths.sum(), abs=1e-12)
            first, last = (normal[1] * way[0] - normal[0] * way[1] for normal in normals)
            normal = normals[0] if first < 0 else normals[1] if last > 0 else -way
            assert hit.normal == pytest.approx(normal, abs=1e-9)
            seen["enters"] += 1
    assert min(seen.values()) > count / 2


def test_a_ray_enters_through_a_corner_and_passes_one_that_it_grazes() -> None:
    """Of 6767 rays into corners 2138 passed through, and rays that grazed corners met them."""
    check_corners(1, 500)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10, 14))
def test_a_ray_enters_through_a_corner_and_passes_one_that_it_grazes_at_length(seed: int) -> None:
    check_corners(seed, 10_000)


def test_a_ray_at_a_corner_knows_neither_left_nor_up() -> None:
    """At a corner it met the left or right side, and after swapping the axes the other one.

    A point that flies there as a body bounces straight back, if it comes from between the normals.
    """
    mirrors = [np.array(rows) for rows in ([[1, 0], [0, 1]], [[-1, 0], [0, 1]], [[0, 1], [1, 0]])]
    rng = np.random.default_rng(5)
    for shape in (AxisAlignedRectangle(2, 2), Rectangle(2, 2), Rectangle(2, 2, math.pi / 4)):
        corner = np.array([shape.edges[2].end_x, shape.edges[2].end_y])
        assert corner[1] < 0
        for way in (*rng.uniform(-1, 1, (20, 2)), np.array([1.0, 1.0]), np.array([1.0, 0.0])):
            hits = []
            for mirror in mirrors:
                start, end = mirror @ (corner - way), mirror @ (corner + way)
                hit = World([Body(shape)]).query_ray(start, end)
                hits.append([hit.fraction, *(mirror.T @ hit.normal)] if hit else [])
            assert hits[0] == pytest.approx(hits[1], abs=1e-15)
            assert hits[0] == pytest.approx(hits[2], abs=1e-15)
    world = World([Body(AxisAlignedRectangle(2, 2)), Body(Particle(0), (-2, -3), (1, 2), mass=1)])
    (hit,) = world.step(1.5)
    assert (hit["time"], hit["point"].tolist()) == (1, [-1, -1])
    assert world.velocities[-1] == pytest.approx([-1, -2], abs=1e-15)


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
        (lambda w: w.query_box((-1e308, 0), (1, 1)), ValueError, "lower.*at most 1e\\+140.*-1e"),
        (lambda w: w.query_point((0, 1e141)), ValueError, "point.*at most 1e\\+140"),
        (lambda w: w.query_ray((-1.7e308, 0), (1, 1)), ValueError, "start.*at most 1e\\+140"),
        (lambda w: w.query_ray((0, 0), (0, 1.7e308), 1), ValueError, "end.*at most 1e\\+140"),
        (lambda w: w.query_ray((0,), (1, 1)), ValueError, "start must be two numbers"),
        (lambda w: w.query_ray((0, 0), "up"), TypeError, "end must be two numbers"),
        (lambda w: w.query_ray((0, 0), (1, 1), -1), ValueError, "radius.*negative.*-1"),
        (lambda w: w.query_ray((0, 0), (1, 1), mask=None), TypeError, "mask.*integer.*None"),
    ],
)
def test_an_invalid_query_is_refused(call: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        call(WORLD)


def crowd(seed: int, bodies: int) -> tuple[World, list[Body]]:
    """Return a world that has been stepped, in which users then moved some bodies, and its bodies.

    Its bodies have all sizes, and are many more than a world may have without a grid.
    """
    rng = np.random.default_rng(seed)
    world = World([Body(HalfPlane((1, 3)), (0, -40)), Body(AxisAlignedHalfPlane("-x"), (40, 0))])
    for index in range(bodies):
        size, place = 10.0 ** rng.uniform(-2, 0.5), rng.uniform(-30, 30, 2)
        shape = (Particle(size), Rectangle(size, 0.5, 0.3), AxisAlignedRectangle(1, size))[
            index % 3
        ]
        velocity = rng.normal(size=2) if index % 2 else (0, 0)
        world.add(Body(shape, place, velocity, mass=None if index % 4 < 2 else 1), mask=0)
    for turn in range(int(rng.integers(3))):
        world.step(0.5 * turn)
    for body in rng.choice(bodies, int(rng.integers(4))).tolist():
        world.place(2 + body, rng.uniform(-30, 30, 2))
    return world, bodies_of(world)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.0, 0.3]))
def test_many_rays_meet_what_they_meet_one_by_one(seed: int, radius: float) -> None:
    """Each ray was tested against each body. Now it walks through the cells and the tree."""
    world, bodies = crowd(seed, 60)
    rng = np.random.default_rng(seed)
    starts, ends = rng.uniform(-35, 35, (2, 40, 2))
    ends[::4, seed % 2] = starts[::4, seed % 2]  # straight along an axis
    ends[1::8] = starts[1::8] + 1e-3
    ends[2::16] *= 1e9
    ends[3] = starts[3]
    hits = world.query_rays(starts, ends, radius)
    for index, (start, end) in enumerate(zip(starts, ends, strict=True)):
        disc = Body(Particle(radius), start, end - start)
        due = [time_of_impact(disc, Body(b.collider, b.position)) for b in bodies]
        times = [math.inf if d is None or d.time > 1 else d.time for d in due]
        first = int(np.argmin(times)) if min(times) < math.inf else -1
        assert hits.bodies[index] == first
        one = world.query_ray(start, end, radius)
        if one is None:
            assert hits.fractions[index] == math.inf
            assert np.isnan(hits.points[index]).all()
            assert np.isnan(hits.normals[index]).all()
        else:
            assert (one.body, one.fraction) == (first, times[first])
            assert hits.fractions[index] == one.fraction
            assert hits.points[index].tolist() == one.point.tolist()
            assert hits.normals[index].tolist() == one.normal.tolist()


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
def test_places_in_a_crowd_are_searched_as_one_by_one(seed: int) -> None:
    world, bodies = crowd(seed, 60)
    rng = np.random.default_rng(seed)
    for lower in rng.uniform(-35, 30, (20, 2)):
        upper = lower + 10.0 ** rng.uniform(-2, 2, 2)
        box = Body(AxisAlignedRectangle(*(upper - lower)), 0.5 * (lower + upper))
        due = [index for index, body in enumerate(bodies) if detect(box, body)]
        assert world.query_box(lower, upper).tolist() == due
        point = Body(Particle(0), lower)
        due = [index for index, body in enumerate(bodies) if detect(point, body)]
        assert world.query_point(lower).tolist() == due


def test_rays_need_as_many_starts_as_ends() -> None:
    with pytest.raises(ValueError, match="2 starts, but 1 ends"):
        WORLD.query_rays([(0, 0), (1, 1)], [(2, 2)])
    with pytest.raises(ValueError, match=r"shape \[n, 2\]"):
        WORLD.query_rays((0, 0), (1, 1))
    with pytest.raises(ValueError, match="finite"):
        WORLD.query_rays([(0, math.nan)], [(1, 1)])


def test_empty_lists_are_no_rays_and_no_bodies() -> None:
    """A game without enemies in a frame got an error about the shape [0]."""
    assert WORLD.query_rays([], []).bodies.tolist() == []
    world = World([Body(Particle(1))])
    world.place([], [], velocity=[])
    assert world.positions.tolist() == [[0, 0]]
    with pytest.raises(ValueError, match=r"shape \[1, 2\], but has \[0, 2\]"):
        world.place([0], [])


def test_a_body_of_no_category_is_found_by_nothing() -> None:
    world = World()
    world.add(Body(Particle(1), (0, 0)), category=0)
    assert world.query_point((0, 0)).tolist() == []
    assert world.query_ray((-3, 0), (3, 0)) is None
