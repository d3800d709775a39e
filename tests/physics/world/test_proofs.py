"""What the engine proves: no tunnelling, no lost time, no energy gained, no seams."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from arkanoid.physics import (
    HIT,
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
    World,
    WorldBatch,
    time_of_impact,
)
from helpers.bodies import room
from hypothesis import given, settings
from hypothesis import strategies as st

Array = npt.NDArray[np.float64]


def unfolded(start: float, velocity: float, time: float, low: float, high: float) -> float:
    """Return where a point is that moves back and forth between two walls, exactly."""
    width = Fraction(high) - Fraction(low)
    way = (Fraction(start) - Fraction(low) + Fraction(velocity) * Fraction(time)) % (2 * width)
    return float(Fraction(low) + (way if way <= width else 2 * width - way))


def billiards(count: int, seed: int, packing: float = 0.22) -> tuple[World, float]:
    """Return equal discs of radius 1/2 in a square room, and the room's width."""
    width = math.sqrt(count * math.pi * 0.25 / packing)
    world = World(room(width, width))
    columns = math.ceil(math.sqrt(count))
    rng = np.random.default_rng(seed)
    for index in range(count):
        place = (np.array(divmod(index, columns)) + 0.5) * width / columns
        world.add(Body(Particle(0.5), place, rng.normal(size=2), mass=1.0))
    return world, width


def energy(world: World, first: int = 4) -> float:
    return float((world.velocities[first:] ** 2).sum())


# Proof 4: zero tunnelling, at any speed.


@settings(max_examples=40, deadline=None)
@given(
    st.tuples(st.floats(0.2, 1.8), st.floats(0.2, 0.8)),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    st.sampled_from([1e-3, 1.0, 30.0, 1e3]),
    st.integers(1, 5),
)
def test_a_ball_in_a_box_is_where_the_unfolded_box_says(
    start: tuple[float, float], direction: tuple[float, float], speed: float, steps: int
) -> None:
    velocity = (direction[0] * speed, direction[1] * speed)
    ball = Body(Particle(0.125), start, velocity, mass=1)
    world = World([*room(2, 1), ball], max_hits=10_000)
    hits = sum(len(world.step(1.0)) for _ in range(steps))
    expected = [
        unfolded(start[0], velocity[0], steps, 0.125, 1.875),
        unfolded(start[1], velocity[1], steps, 0.125, 0.875),
    ]
    # Each bounce rounds once or twice, in the last digit of a position.
    assert world.positions[-1] == pytest.approx(expected, abs=1e-15 * (10 + 4 * hits))
    assert abs(world.velocities[-1]).tolist() == [abs(v) for v in velocity]


@pytest.mark.parametrize(
    "widths",
    [1e5, 1e6, pytest.param(1e9, marks=pytest.mark.slow)],
)
def test_a_step_may_be_any_number_of_box_widths(widths: float) -> None:
    velocity = (0.61803398875 * widths, -widths)
    ball = Body(Particle(0.125), (0.4, 0.3), velocity, mass=1)
    world = World([*room(1, 1), ball], max_hits=10**10)
    duration = 0.9973
    # A billion hits would be 64 GB: several steps limit how many are returned at once.
    parts = max(1, round(widths / 1e6))
    hits = sum(len(world.step(duration / parts)) for _ in range(parts))
    x, y = world.positions[-1]
    time = duration / parts * parts
    assert hits == pytest.approx((abs(velocity[0]) + abs(velocity[1])) * time / 0.75, abs=2.5)
    # The length of a step itself is known only to one part in 1e16.
    error = 1e-15 * hits + 4e-16 * widths * parts
    assert x == pytest.approx(unfolded(0.4, velocity[0], time, 0.125, 0.875), abs=error)
    assert y == pytest.approx(unfolded(0.3, velocity[1], time, 0.125, 0.875), abs=error)


@pytest.mark.parametrize("speed", [1.0, 50.0, 1e4, 1e8])
def test_no_wall_is_too_thin(speed: float) -> None:
    """Two hundred balls meet walls of a millionth of their size, from all sides."""
    world = World()
    for index in range(200):
        angle = 2 * math.pi * index / 200
        wall = Rectangle(1e-6, 100, angle)
        toward = (math.cos(angle), math.sin(angle))
        body = world.add(Body(wall, (0, 0)), category=1 << (index % 60))
        ball = Body(Particle(0.5), np.multiply(toward, -3), np.multiply(toward, speed), mass=1)
        world.add(ball, category=1 << (index % 60), mask=1 << (index % 60))
        assert body == 2 * index
    for index in range(200):
        only = World([world.body(2 * index), world.body(2 * index + 1)])
        (hit,) = only.step(10.0)
        assert hit["time"] == pytest.approx(2.5 / speed, rel=1e-6)
        along = np.array([math.cos(2 * math.pi * index / 200), math.sin(2 * math.pi * index / 200)])
        assert only.positions[1] @ along < -0.5


def test_no_bounce_is_missing() -> None:
    """Eight units per step, between walls a little more than a ball's width and 1.2 apart."""
    world = World([*room(1.2, 5), Body(Particle(0.125), (0.6, 2), (8.0, 0.0), mass=1)])
    hits = sum(len(world.step(1.0)) for _ in range(100))
    due = math.floor((0.6 - 0.125 + 8.0 * 100) / (1.2 - 0.25))
    assert hits == due


# Proof 5: one step of dt is k steps of dt / k.


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 9))
def test_a_step_equals_its_parts(seed: int, parts: int) -> None:
    """This holds up to rounding, which grows in a chaotic scene: so there are few hits per body."""
    whole, _ = billiards(12, seed)
    divided, _ = billiards(12, seed)
    whole.add(Body(Convex([(1, 0.2), (1.3, 0.8), (0.7, 0.8)]), (2, 2)))
    divided.add(Body(Convex([(1, 0.2), (1.3, 0.8), (0.7, 0.8)]), (2, 2)))
    one = whole.step(1.5)
    many = np.concatenate([divided.step(1.5 / parts) for _ in range(parts)])
    assert one[["a", "b"]].tolist() == many[["a", "b"]].tolist()
    np.testing.assert_allclose(many["time"], one["time"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(divided.positions, whole.positions, rtol=0, atol=1e-9)
    assert divided.time == pytest.approx(whole.time, rel=1e-15)


# Proof 6: energy and momentum.


def test_a_million_bounces_off_axis_aligned_walls_keep_the_energy_to_the_bit() -> None:
    velocity = (0.7, 0.41)
    ball = Body(Particle(0.125), (0.4, 0.3), velocity, mass=0.3)
    world = World([*room(1, 1), ball], max_hits=10**7)
    bounces = 0
    while bounces < 1_000_000:
        bounces += len(world.step(100_000.0))
        assert abs(world.velocities[-1]).tolist() == list(velocity)


def test_a_million_bounces_off_slanted_walls_keep_the_energy() -> None:
    walls = [
        Body(HalfPlane((math.cos(angle), math.sin(angle)), -1.0)) for angle in (0.1, 1.9, 3.3, 4.9)
    ]
    world = World([*walls, Body(Particle(0.1), (0, 0), (0.3, 0.8), mass=2)], max_hits=10**7)
    before = energy(world)
    bounces = 0
    while bounces < 1_000_000:
        bounces += len(world.step(200_000.0))
        assert energy(world) == pytest.approx(before, rel=1e-9)
    assert abs(world.positions[-1]).max() < 1.6


def test_discs_keep_energy_and_momentum_and_never_overlap() -> None:
    world, width = billiards(200, 1)
    before = energy(world)
    for _ in range(20):
        hits = world.step(1.0)
        assert energy(world) == pytest.approx(before, rel=1e-12)
        places = world.positions[4:]
        assert places.min() > 0.5 - 1e-12
        assert places.max() < width - 0.5 + 1e-12
        apart = np.hypot(*(places[:, None] - places[None]).T)[~np.eye(200, dtype=bool)]
        assert apart.min() > 1 - 1e-12
        assert (np.diff(hits["time"]) >= 0).all()
    assert world.capped == 0


def test_free_pairs_keep_their_momentum() -> None:
    rng = np.random.default_rng(2)
    masses = rng.uniform(0.1, 10, 30)
    world = World(
        Body(Particle(0.3), rng.uniform(-5, 5, 2), rng.normal(size=2), mass=m) for m in masses
    )
    world.step(0.0)  # relaxes what overlaps
    momentum = (masses[:, None] * world.velocities).sum(axis=0)
    energy_before = (masses[:, None] * world.velocities**2).sum()
    assert len(world.step(20.0)) >= 15
    after = (masses[:, None] * world.velocities).sum(axis=0)
    assert after == pytest.approx(momentum, abs=1e-12)
    assert (masses[:, None] * world.velocities**2).sum() == pytest.approx(energy_before, rel=1e-12)


@pytest.mark.parametrize(
    ("digits", "count"),
    [(0, 3), (1, 31), (2, 314), (3, 3141), (4, 31415), (5, 314159)],
)
def test_colliding_blocks_count_pi(digits: int, count: int) -> None:
    """Galperin, Playing pool with pi, Regular and Chaotic Dynamics 8(4), 2003."""
    world = World([Body(AxisAlignedHalfPlane("+x"))], max_hits=10**7 if digits > 3 else 10_000)
    world.add(Body(AxisAlignedRectangle(1, 1), (3, 0), mass=1.0))
    world.add(Body(AxisAlignedRectangle(1, 1), (6, 0), (-1, 0), mass=100.0**digits))
    hits = world.step(1e6)
    assert len(hits) == count
    assert (hits["kind"] == HIT).all()


def test_the_published_discs_meet_at_nine_tenths() -> None:
    """Radii 1/2, centres 10 apart, approaching at 10 per unit of time."""
    one = Body(Particle(0.5), (0, 0), (5, 0), mass=1)
    other = Body(Particle(0.5), (10, 0), (-5, 0), mass=1)
    impact = time_of_impact(one, other)
    assert impact is not None
    assert impact.time == pytest.approx(0.9, rel=1e-15)
    (hit,) = World([one, other]).step(1.0)
    assert hit["time"] == impact.time
    assert hit["normal"].tolist() == [1, 0]
    assert hit["point"] == pytest.approx([5, 0], abs=1e-14)
    assert hit["impulse"] == -10


@pytest.mark.parametrize("speed", [1e-3, 1.0, 1e6])
def test_a_disc_in_the_concave_corner_of_two_boxes_reverses_exactly(speed: float) -> None:
    world = World([Body(AxisAlignedRectangle(4, 1), (2, -0.5))])
    world.add(Body(AxisAlignedRectangle(1, 4), (-0.5, 2)))
    world.add(Body(Particle(0.25), (1.25, 1.25), (-speed, -speed), mass=1))
    hits = world.step(2.0 / speed)
    assert len(hits) == 2
    assert world.velocities[-1].tolist() == [speed, speed]


# Proof 7: seams.


def bouncing_balls(ceiling: list[Body], floor: list[Body], balls: int) -> World:
    world = World([*ceiling, *floor], max_hits=10**6)
    world.add(Body(AxisAlignedHalfPlane("+x")))
    world.add(Body(AxisAlignedHalfPlane("-x", -11)))
    rng = np.random.default_rng(7)
    for _ in range(balls):
        place, velocity = rng.uniform((0.2, 1.2), (10.8, 2.3)), rng.uniform(-1, 1, 2)
        # They meet only the walls.
        world.add(Body(Particle(0.125), place, velocity, mass=1), category=2, mask=1)
    return world


def test_a_row_of_bricks_is_a_wall_over_a_million_impacts() -> None:
    bricks = [
        [Body(AxisAlignedRectangle(1, 0.5), (x + 0.5, y)) for x in range(11)] for y in (0.75, 2.75)
    ]
    walls = [[Body(AxisAlignedRectangle(11, 0.5), (5.5, y))] for y in (0.75, 2.75)]
    row, wall = bouncing_balls(*bricks, balls=100), bouncing_balls(*walls, balls=100)
    impacts = 0
    while impacts < 1_000_000:
        ours, theirs = row.step(1_000.0), wall.step(1_000.0)
        assert len(ours) == len(theirs)
        assert row.velocities[-100:].tobytes() == wall.velocities[-100:].tobytes()
        np.testing.assert_allclose(row.positions[-100:], wall.positions[-100:], atol=1e-9, rtol=0)
        impacts += len(ours)


@pytest.mark.parametrize("is_left_first", [True, False])
@pytest.mark.parametrize("vx", [0.0, 0.3, -0.3, 1e-9, 5.0])
def test_a_disc_that_lands_on_a_seam_meets_a_face(vx: float, is_left_first: bool) -> None:
    """By rounding, the corner of the neighbouring box was met first, and deflected the ball.

    Within 1e-8 of a seam the two boxes are met at the same time, as far as numbers can tell.
    """
    offsets = [0.0, *(sign * 10.0**-k for k in range(5, 18) for sign in (1, -1))]
    for offset in offsets:
        middles = (-0.5, 0.5) if is_left_first else (0.5, -0.5)
        world = World(Body(AxisAlignedRectangle(1, 0.5), (x, 0)) for x in middles)
        world.add(Body(Particle(0.125), (offset - vx, 1.375), (vx, -1.0), mass=1))
        (hit,) = world.step(2.0)
        assert hit["normal"].tolist() == [0, 1]
        assert world.velocities[-1].tolist() == [vx, 1]


# Proof 8: determinism. (Compiled and interpreted, and the golden hash: test_batch.)


@pytest.mark.parametrize(("num_worlds", "threads"), [(1, 1), (4096, 1), (4096, 3)])
def test_the_batch_does_not_change_a_bit(num_worlds: int, threads: int) -> None:
    alone, _ = billiards(5, 3)
    batch = WorldBatch(alone, num_worlds, threads=threads)
    for _ in range(10):
        alone.step(0.7)
        batch.step(0.7)
    batch.close()
    assert (batch.positions == alone.positions[4:]).all()
    assert (batch.velocities == alone.velocities[4:]).all()


def test_a_thousand_discs_among_ten_thousand_bricks() -> None:
    """Benchmarks measure the time; this shows that it is practical, and right."""
    width = 200.0
    world = World(room(width, width))
    rng = np.random.default_rng(5)
    for x in range(100):
        for y in range(100):
            world.add(Body(AxisAlignedRectangle(0.5, 0.5), (2 * x + 1, 2 * y + 1)))
    for x in range(32):
        for y in range(32):
            place = (6 * x + 2.0, 6 * y + 2.0)
            world.add(Body(Particle(0.3), place, rng.normal(size=2), mass=1))
    before = energy(world)
    assert len(world.step(5.0)) > 1000
    assert energy(world) == pytest.approx(before, rel=1e-12)
    for place in world.positions[-200:]:
        near: Any = world.query_box(place - 0.2, place + 0.2)
        assert len(near) == 1
