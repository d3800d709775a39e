"""Difficult scenes: overlaps, touching bodies, squeezed bodies, extreme numbers."""

import math
import warnings
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    HIT,
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    HalfPlane,
    HitLimitWarning,
    Particle,
    Rectangle,
    World,
)
from helpers.bodies import DISC, FLOOR, SHAPES, SMALL_SHAPES, bodies_of, deepest_overlap
from helpers.bodies import room as box_of
from hypothesis import example, given, settings
from hypothesis import strategies as st

# Relaxation, as a step begins.


@pytest.mark.parametrize("dt", [0.0, 1.0])
def test_an_overlap_is_shared_by_the_reciprocal_of_mass(dt: float) -> None:
    world = World([Body(DISC, (0, 0), mass=3), Body(DISC, (0.5, 0), mass=1)])
    assert len(world.step(dt)) == 0
    assert world.positions.tolist() == [[-0.125, 0], [0.875, 0]]
    assert world.velocities.tolist() == [[0, 0], [0, 0]]


@pytest.mark.parametrize("velocity", [(0, 0), (2, 0)])
def test_a_body_without_mass_does_not_give_way(velocity: tuple[float, float]) -> None:
    world = World([Body(DISC, (0, 0), velocity), Body(DISC, (0.25, 0), (3, 0), mass=1e9)])
    world.step(0.0)
    assert world.positions.tolist() == [[0, 0], [1, 0]]


def test_static_and_kinematic_bodies_may_overlap_as_they_like() -> None:
    bodies = [Body(DISC), Body(DISC, (0.1, 0)), Body(DISC, (0.2, 0), (0.1, 0)), FLOOR]
    world = World([*bodies, Body(HalfPlane((1, 1)), (0, 0), (0, 0.1))])
    before = world.positions
    assert len(world.step(0.0)) == 0
    assert world.positions.tolist() == before.tolist()
    assert len(world.step(1.0)) == 0


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 12))
@example(547, 12)
def test_a_heap_is_relaxed(seed: int, count: int) -> None:
    """Any shapes at almost one position, on a floor: after a few steps nothing overlaps.

    Pair by pair, a light body between heavy ones took thousands of rounds.
    """
    rng = np.random.default_rng(seed)
    world = World([FLOOR])
    for _ in range(count):
        shape, mass = SHAPES[rng.integers(len(SHAPES))], float(rng.uniform(0.1, 10))
        world.add(Body(shape, rng.uniform((-1, -0.3), (1, 1.2)), mass=mass))
    world.step(0.0, steps=20)
    # Two that overlap by less than rounding tells only touch: there is no contact.
    assert deepest_overlap(bodies_of(world)) == 0.0
    assert world.velocities.tolist() == [[0, 0]] * (count + 1)
    assert len(world.step(1.0)) == 0


@pytest.mark.parametrize("count", [3, 10, 40])
def test_a_chain_too_long_for_one_step_is_relaxed_in_several(count: int) -> None:
    """Discs were pushed into each other and into a wall, and one step's rounds were not enough.

    Nobody had changed the world since, so the next step assumed that nothing overlapped.
    """
    chain = [Body(DISC, (0.5 + 0.1 * index, 0), mass=1) for index in range(count)]
    world = World([Body(AxisAlignedHalfPlane("+x")), *chain])
    for _ in range(count * count // 4 + 20):
        world.step(1.0)
    assert deepest_overlap(bodies_of(world)) <= 1e-12 * (1 + 2 * count)
    assert np.sort(world.positions[1:, 0]) == pytest.approx(np.arange(count) + 0.5, abs=1e-9)
    assert world.velocities.tolist() == [[0, 0]] * (count + 1)


def test_a_body_put_into_a_wall_comes_out_on_the_near_side() -> None:
    for y, out in ((0.1, 1.0), (-0.2, -1.0)):
        world = World([Body(AxisAlignedRectangle(9, 1)), Body(DISC, (0, 9), mass=1)])
        world.step(1.0)
        world.place(1, (0, y))
        world.step(1.0)
        assert world.positions[1].tolist() == [0, out]


@pytest.mark.parametrize("velocity", [(0, 0), (1, 0.5), (1e9, 1e-9)])
def test_too_little_room_between_two_walls_is_no_trap(velocity: tuple[float, float]) -> None:
    """A disc of width 1 is between walls 0.8 apart. If it moves, a warning says it is squeezed.

    Then it has lost its speed across the walls, and goes on along them.
    """
    world = World(Body(AxisAlignedRectangle(2, 20), (x, 0)) for x in (-1, 1.8))
    world.add(Body(DISC, (0.4, 0), velocity, mass=1))
    for step in range(1, 4):
        if velocity == (0, 0) or step > 1:
            assert len(world.step(1.0)) == 0
        else:
            with pytest.warns(HitLimitWarning, match="max_hits=1000"):
                assert 1000 <= len(world.step(1.0)) <= 1002
        assert world.capped == (velocity != (0, 0))
        assert world.velocities[2].tolist() == [0, velocity[1]]
        assert abs(world.positions[2, 0] - 0.4) < 0.2
        assert world.positions[2, 1] == pytest.approx(velocity[1] * step, rel=1e-14)
        assert world.time == step
    # With enough room, it is free again.
    world.place(2, (0.4, 20), (0, -1))
    assert len(world.step(9.0)) == 0
    assert world.positions[2].tolist() == [0.4, 11]


def test_identical_bodies_at_the_same_position_separate() -> None:
    for shape in SHAPES:
        world = World([Body(shape, (3, 4), mass=1), Body(shape, (3, 4), mass=1)])
        world.step(1.0)
        assert deepest_overlap(bodies_of(world)) <= 1e-12
        assert np.isfinite(world.positions).all()
        assert world.positions.sum(axis=0) == pytest.approx([6, 8], abs=1e-14)


# Touching bodies.


def test_a_body_without_velocity_stays() -> None:
    touching = [Body(DISC, (x, 0.5), mass=1) for x in range(12)]
    world = World([FLOOR, Body(AxisAlignedHalfPlane("+x"), (-0.5, 0)), *touching])
    before = world.positions
    for _ in range(10):
        assert len(world.step(1e3)) == 0
    assert world.positions.tolist() == before.tolist()


@pytest.mark.parametrize("speed", [1.0, 1e9, 1e-9, 5e-324])
def test_sliding_and_grazing_are_no_hits(speed: float) -> None:
    world = World([FLOOR, Body(DISC, (0, 0.5), (speed, 0), mass=1)])
    world.add(Body(DISC, (5, 1.5), (-speed, 0), mass=1))
    assert len(world.step(10.0)) == 0
    assert world.positions[1:, 1].tolist() == [0.5, 1.5]


@pytest.mark.parametrize("slope", [(0, 1), (1, 2), (-3, 1), (0.1, 0.7)])
def test_an_inelastic_disc_stays_where_it_lands(slope: tuple[float, float]) -> None:
    """It slides along the wall, or stays: one hit, and not an endless number of tiny ones."""
    wall = Body(HalfPlane(slope), (0.1, 0.3))
    world = World([wall, Body(DISC, (0.2, 9), (0.3, -3), mass=1, restitution=0)])
    hits = np.concatenate([world.step(1.0) for _ in range(200)])
    assert len(hits) == 1
    normal = hits[0]["normal"]
    assert world.velocities[1] @ normal == pytest.approx(0, abs=1e-15)
    gap = (world.positions[1] - (0.1, 0.3)) @ normal - 0.5
    assert gap == pytest.approx(0, abs=1e-12)


def test_an_inelastic_disc_stops_in_a_corner() -> None:
    world = World([FLOOR, Body(AxisAlignedHalfPlane("+x"))])
    world.add(Body(DISC, (2, 3), (-1, -2), mass=1, restitution=0))
    assert len(world.step(1e6)) == 2
    assert world.positions[2].tolist() == [0.5, 0.5]
    assert world.velocities[2].tolist() == [0, 0]


def test_inelastic_discs_move_on_together() -> None:
    world = World([Body(DISC, (0, 0), (3, 0), mass=1, restitution=0), Body(DISC, (4, 0), mass=2)])
    hits = np.concatenate([world.step(1.0) for _ in range(100)])
    assert len(hits) == 1
    assert world.velocities == pytest.approx(np.array([[1, 0], [1, 0]]), abs=1e-15)
    assert np.diff(world.positions[:, 0]) == pytest.approx([1], abs=1e-12)


# Bodies squeezed by a body without mass.


def test_a_squeezed_ball_is_reported_and_is_free_when_the_paddle_leaves() -> None:
    """A paddle pushes a ball into a wall. The ball's hits follow faster and faster, without end."""
    world = World([Body(AxisAlignedHalfPlane("+x"))], max_hits=100)
    paddle = world.add(Body(AxisAlignedRectangle(1, 4), (5, 0), (-1, 0)))
    ball = world.add(Body(DISC, (2, 0), (-1, 0.125), mass=1))
    with pytest.warns(HitLimitWarning, match=r"max_hits=100\b"):
        hits = world.step(4.0)
    assert world.capped == 1
    assert world.time == 4
    # The hundredth makes it inert: one more lets it rest on one wall, the last finds no room.
    assert 101 <= len(hits) <= 103
    assert (np.diff(hits["time"]) >= 0).all()
    assert hits["time"][99] < 3.5
    assert hits["time"][-1] <= 3.5
    assert world.positions[paddle].tolist() == [1, 0]
    assert world.velocities[paddle].tolist() == [-1, 0]
    # Now it has no room. Whether it is pushed out or not: all is finite, and time continues.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HitLimitWarning)
        world.step(0.25, steps=4)
    assert world.time == 5
    assert np.isfinite(world.positions).all()
    world.place(paddle, (50, 0), (0, 0))
    world.place(ball, velocity=(1, 0))
    world.step(0.5)
    x, y = world.positions[ball]
    capped = world.capped
    world.step(1.0)
    assert world.positions[ball] == pytest.approx([x + 1, y], abs=1e-12)
    assert world.capped == capped


def test_the_cap_is_for_one_body_and_one_step() -> None:
    """With three hits per step, a ball bounces three times and then rests; others move on."""
    room = [Body(AxisAlignedHalfPlane("+x")), Body(AxisAlignedHalfPlane("-x"), (2, 0))]
    world = World([*room, Body(DISC, (1, 0), (10, 1), mass=1)], max_hits=3)
    slow = world.add(Body(DISC, (0.5, 5), (0.125, 0), mass=1))
    with pytest.warns(HitLimitWarning):
        hits = world.step(1.0)
    # The wall's distance from the middle, then back and forth.
    assert hits["time"] == pytest.approx([0.05, 0.15, 0.25, 0.35], rel=1e-13)
    assert hits["impulse"].tolist() == [-20, -20, -20, -10]
    assert world.positions[2] == pytest.approx([0.5, 1], rel=1e-14)
    assert world.velocities[2].tolist() == [0, 1]
    assert world.positions[slow].tolist() == [0.625, 5]
    # In the next step it bounces again.
    world.place(2, velocity=(2, 0))
    assert world.step(0.75)["impulse"].tolist() == [-4]
    assert world.capped == 1


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_a_capped_body_is_solid(restitution: float) -> None:
    """A crate that had used up its hits was left where it stood, and a fast ball went through it.

    Whatever comes of the crates: nothing passes through the pile or the floor.
    """
    crates = [Body(AxisAlignedRectangle(1, 1), (0, 0.5 + y), (0, -1), 1, 0.5) for y in range(3)]
    for y in (0.6, 1.4, 2.2):
        world = World([FLOOR, *crates], max_hits=3)
        ball = world.add(Body(Particle(0.25), (-20, y), (40, 0), 1, restitution))
        with pytest.warns(HitLimitWarning):
            hits = world.step(1.0)
        x, places = world.positions[ball, 0], world.positions[1:4]
        assert ball in hits["b"]
        assert x < places[abs(places[:, 1] - y).argmin(), 0] - 0.5
        assert world.velocities[ball, 0] <= world.velocities[1:4, 0].max()
        assert deepest_overlap(bodies_of(world)) < 1e-12
        assert places[:, 1].min() >= 0.5 - 1e-12


def test_there_is_no_second_warning_without_new_hits() -> None:
    room = [Body(AxisAlignedHalfPlane("+x")), Body(AxisAlignedHalfPlane("-x"), (2, 0))]
    world = World([*room, Body(DISC, (1, 0), (10, 0), mass=1)], max_hits=3)
    with pytest.warns(HitLimitWarning):
        world.step(1.0)
    world.place(2, velocity=(0, 0.01))
    assert len(world.step(0.1)) == 0
    assert world.capped == 1


# Extreme numbers.


@pytest.mark.parametrize("length", [1e9, 1.0, 1e-9])
@pytest.mark.parametrize("time", [1e9, 1.0, 1e-9])
def test_scales_do_not_matter(length: float, time: float) -> None:
    """The same scene in other units, which are no powers of two, has the same events."""

    def scene(length: float, time: float) -> World:
        speed = length / time
        walls = [("+x", 0.0), ("-x", -6.0), ("+y", 0.0), ("-y", -4.0)]
        world = World(Body(AxisAlignedHalfPlane(d, o * length)) for d, o in walls)
        world.add(Body(Rectangle(2 * length, length, 0.4), (3 * length, 2 * length)))
        rng = np.random.default_rng(1)
        for index in range(10):
            place = np.array([0.7 + index % 5 * 1.1, 0.5 + index // 5 * 3.0]) * length
            shape = Particle(0.3 * length)
            world.add(Body(shape, place, rng.normal(size=2) * speed, mass=1))
        return world

    plain, scaled = scene(1.0, 1.0), scene(length, time)
    expected, hits = plain.step(2.0), scaled.step(2.0 * time)
    assert len(expected) > 10
    assert hits[["a", "b"]].tolist() == expected[["a", "b"]].tolist()
    np.testing.assert_allclose(hits["time"] / time, expected["time"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(scaled.positions / length, plain.positions, rtol=0, atol=1e-9)


@pytest.mark.parametrize("speed", [1e9, 1e75, 1e139])
@pytest.mark.parametrize("restitution", [0.0, 0.9, 1.0])
def test_a_crowd_ends_its_step_at_any_speed(speed: float, restitution: float) -> None:
    """Squares of a group's speeds overflowed. A meeting came to nothing, and was due for ever."""
    world = World(box_of(12, 10), max_hits=200)
    for index in range(24):
        place = (0.8 + index % 8 * 1.4, 0.6 + index // 8 * 1.5)
        shape = SMALL_SHAPES[index % len(SMALL_SHAPES)]
        world.add(Body(shape, place, (0.1, -0.2), 1.0 + index % 3, restitution))
    world.place(10, velocity=(speed, 1))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HitLimitWarning)
        # Free, inert, crushed: a body has at most so many hits in each of these stages.
        assert len(world.step(0.2)) <= 3 * 200 * 24
    assert np.isfinite(world.velocities).all()


extreme = st.one_of(
    st.sampled_from([0.0, -0.0, 1e-9, -1e9, 1e9, 1e-150, 1e100, -1e-300, 5e-324, 0.5, -1.0]),
    st.floats(-3, 3),
)


@settings(max_examples=150, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(SHAPES),
            st.tuples(extreme, extreme),
            st.tuples(extreme, extreme),
            st.sampled_from([None, 1.0, 1e-9, 1e9]),
            st.sampled_from([0.0, 0.5, 1.0]),
            st.booleans(),
        ),
        max_size=10,
    ),
    st.sampled_from([0.0, 1e-300, 1e-9, 1.0, 1e9]),
    st.booleans(),
)
def test_no_input_hangs_or_makes_nan(
    rows: list[tuple[Any, ...]], dt: float, continuous: bool
) -> None:
    world = World(
        [FLOOR, Body(HalfPlane((1, 3)), (0, -4)), Body(SHAPES[2], (1, 1))],
        continuous=continuous,
        max_hits=50,
    )
    for shape, place, velocity, mass, restitution, sensor in rows:
        world.add(Body(shape, place, velocity, mass, restitution), sensor=sensor)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HitLimitWarning)
        for _ in range(3):
            hits = world.step(dt)
            assert np.isfinite(world.positions).all()
            assert np.isfinite(world.velocities).all()
            for name in ("time", "normal", "point", "impulse"):
                assert np.isfinite(hits[name]).all()
            assert (np.diff(hits["time"]) >= 0).all()
            assert (hits["a"] < hits["b"]).all()
            bounces = hits[hits["kind"] == HIT]
            assert np.hypot(*bounces["normal"].T) == pytest.approx(1, abs=1e-14)
            assert (bounces["impulse"] <= 0).all()
    assert world.time == pytest.approx(3 * dt, rel=1e-15)


@pytest.mark.parametrize(("ratio", "sag"), [(1e6, 1e-10), (1e10, 1e-6)])
def test_a_pile_bears_very_different_masses(ratio: float, sag: float) -> None:
    """Nothing said how different: from 1 : 1e11 on, the lightest box is pressed out."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        count = int(rng.integers(2, 11))
        masses = ratio ** np.append(rng.uniform(0, 1, count - 2), [0, 1])
        world = World([FLOOR])
        for level, mass in enumerate(rng.permutation(masses).tolist()):
            world.add(Body(AxisAlignedRectangle(1, 1), (0, level + 0.5), (0, 0), mass, 0))
        for _ in range(60):
            boxes = world.handles[1:]
            world.place(boxes, velocity=world.velocity(boxes) - (0, 0.16))
            world.step(1 / 60)
        assert world.positions[1:, 1] == pytest.approx(np.arange(count) + 0.5, abs=sag)


@pytest.mark.parametrize("continuous", [True, False])
def test_worlds_in_which_nothing_moves(continuous: bool) -> None:
    for bodies in ([], [FLOOR], [FLOOR, Body(DISC), Body(DISC)]):
        world = World(bodies, continuous=continuous)
        for _ in range(3):
            assert len(world.step(math.pi)) == 0
        assert world.time == pytest.approx(3 * math.pi, rel=1e-15)
        assert world.positions.tolist() == [[0, 0]] * len(bodies)
