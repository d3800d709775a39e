"""The world as an object: what goes in, what comes out, and how it is edited."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    BEGIN,
    END,
    HIT,
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Hit,
    NoBodyError,
    Particle,
    World,
)
from helpers.bodies import DISC, FLOOR, SMALL_SHAPES, Fog, room
from hypothesis import given, settings
from hypothesis import strategies as st


def random_world(seed: int, skip: int = -1) -> World:
    """Return a crowded room with sensors, masks and overrides, perhaps without one of its bodies.

    It is built in one go; a world from which the body is removed later must be the same.
    """
    rng = np.random.default_rng(seed)
    shapes = (SMALL_SHAPES[0], Particle(0.2), *SMALL_SHAPES[1:])
    rows: list[tuple[Body, dict[str, Any]]] = [(wall, {}) for wall in room(6, 4)]
    for index in range(15):
        place = (0.8 + index % 5 * 1.1, 0.8 + index // 5 * 1.1)
        solid = index % 7 != 3
        mass = None if index % 6 == 5 else float(rng.uniform(0.5, 2))
        velocity = rng.normal(size=2) if solid and mass else (0, 0)
        options = {"sensor": not solid, "category": int(rng.integers(1, 8))}
        rows.append((Body(shapes[index % 5], place, velocity, mass, 0.9), options))
    world = World()
    handles = {
        index: world.add(body, **options)
        for index, (body, options) in enumerate(rows)
        if index != skip
    }
    for a, b in rng.integers(4, len(rows), (40, 2)).tolist():
        if a != b and a in handles and b in handles:
            world.set_restitution(handles[a], handles[b], 0.25)
    return world


def same(first: Any, second: Any) -> bool:
    """Return whether two arrays have the same bits."""
    return bool(first.tobytes() == second.tobytes())


# Adding bodies and getting them back.


def test_bodies_are_numbered_as_they_are_added() -> None:
    world = World([FLOOR, Body(DISC, (1, 2), (3, 4), mass=5)])
    assert world.add(Body(DISC, (7, 8))) == 2
    assert len(world) == 3
    assert world.positions.tolist() == [[0, 0], [1, 2], [7, 8]]
    assert world.velocities.tolist() == [[0, 0], [3, 4], [0, 0]]
    assert world.positions.dtype == world.velocities.dtype == np.float64
    assert world.time == 0
    assert world.capped == 0


def test_an_empty_world_has_only_time() -> None:
    world = World()
    hits = world.step(2.5)
    assert hits.dtype == Hit
    assert hits.shape == (0,)
    assert world.positions.shape == world.velocities.shape == (0, 2)
    assert world.time == 2.5
    assert len(world) == 0


def test_the_world_takes_copies() -> None:
    body = Body(DISC, (0, 0), (1, 0), mass=1)
    world = World([body])
    world.step(1.0)
    assert body.position.tolist() == [0, 0]
    body.velocity = (5, 5)
    world.step(1.0)
    assert world.positions.tolist() == [[2, 0]]


def test_users_classes_are_bodies() -> None:
    world = World([Fog(AxisAlignedHalfPlane("-x"), [3, 0]), Body(DISC, (0, 0), (1, 0), mass=1)])
    (hit,) = world.step(3.0)
    assert hit["time"] == 2.5
    assert world.body(0).mass is None
    assert world.body(0).restitution == 1


@given(st.floats(1e-300, 1e300), st.floats(0, 10), st.floats(-10, 10), st.booleans())
def test_a_body_comes_back_as_it_was_added(
    mass: float, restitution: float, coordinate: float, is_static: bool
) -> None:
    """The mass came back as 1 / (1 / mass), which is right for 49 and wrong for 41."""
    given_mass = None if is_static else mass
    body = Body(DISC, (coordinate, 1), (2, coordinate), given_mass, restitution)
    back = World([body]).body(0)
    assert repr(back) == repr(body)


def test_changing_a_body_that_came_back_does_not_change_the_world() -> None:
    world = World([Body(DISC, (0, 0), (1, 0), mass=1)])
    world.step(1.0)
    back = world.body(0)
    assert back.position.tolist() == [1, 0]
    back.position = (9, 9)
    back.velocity[:] = 9
    assert world.positions.tolist() == [[1, 0]]
    assert world.velocities.tolist() == [[1, 0]]


def test_positions_are_copies_that_cannot_be_written_to() -> None:
    world = World([Body(DISC, (0, 0), (1, 0), mass=1)])
    world.step(1.0)
    before, speed = world.positions, world.velocities
    for array in (before, speed):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    world.step(1.0)
    assert before.tolist() == [[1, 0]]
    assert world.positions.tolist() == [[2, 0]]


# Removal.


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.integers(4, 18))
def test_a_removed_body_leaves_no_trace(seed: int, gone: int) -> None:
    """Overrides, sensors and masks are all as if it had never been there."""
    edited, never = random_world(seed), random_world(seed, skip=gone)
    edited.remove(gone)
    for _ in range(3):
        hits, expected = edited.step(0.3), never.step(0.3)
        for name in ("a", "b"):  # the others' handles stay
            expected[name] += expected[name] >= gone
        assert same(hits, expected)
    assert same(edited.positions, never.positions)
    assert same(edited.velocities, never.velocities)


def test_handles_and_who_is_inside_a_sensor_outlive_a_removal() -> None:
    """The indices of later bodies went down by one."""
    world = World([FLOOR])
    sensor = world.add(Body(AxisAlignedRectangle(2, 2), (0, 5)), sensor=True)
    ball = world.add(Body(Particle(0.1), (0, 5), (1, 0), mass=1))
    assert world.step(0.5)["kind"].tolist() == [BEGIN]
    world.remove(0)
    (left,) = world.step(1.0)
    assert left["kind"] == END
    assert (left["a"], left["b"]) == (sensor, ball)
    assert left["time"] == pytest.approx(1.1, rel=1e-15)


def test_a_removed_guest_and_the_guests_of_a_removed_sensor_leave() -> None:
    """They were forgotten, without an event."""
    for gone, pairs in ((0, [(0, 1), (0, 2)]), (1, [(0, 1)])):
        world = World()
        world.add(Body(AxisAlignedRectangle(2, 2)), sensor=True)
        world.add(Body(Particle(0.1), (0, 0), (1, 0), mass=1))
        world.add(Body(Particle(0.1), (0.2, 0.5), (1, 0), mass=1))
        assert len(world.step(0.1)) == 2
        world.remove(gone)
        hits = world.step(5.0)
        ends = hits[: len(pairs)]
        assert hits["kind"].tolist() == [END] * (1 + (gone == 0) + (gone == 1))
        assert ends[["a", "b"]].tolist() == pairs
        assert (ends["time"] == 0.1).all()
        assert len(world) == 2


def test_editing_keeps_time_and_motion() -> None:
    world = World([Body(DISC, (0, 0), (1, 0.1), mass=1)])
    world.step(0.1, steps=7)
    before = world.positions, world.velocities, world.time
    wall = world.add(Body(AxisAlignedHalfPlane("-x"), (3, 0)))
    world.remove(wall)
    assert same(world.positions, before[0])
    assert same(world.velocities, before[1])
    assert world.time == before[2]
    world.step(0.1)
    assert world.time == float(Fraction(0.1) * 8)


# Placing bodies.


def test_a_moving_body_can_be_placed() -> None:
    world = World([FLOOR, Body(DISC, (0, 3), (0, -1), mass=1)])
    world.step(1.0)
    world.place(1, (2, 10))
    assert world.positions[1].tolist() == [2, 10]
    assert world.velocities[1].tolist() == [0, -1]
    world.place(1, velocity=(0, -5))
    assert world.positions[1].tolist() == [2, 10]
    (hit,) = world.step(2.0)
    assert hit["time"] == pytest.approx(1 + 9.5 / 5)
    world.place(1)
    assert world.positions[1] == pytest.approx([2, 1], abs=1e-14)


def test_a_static_body_can_be_placed() -> None:
    world = World([FLOOR, Body(DISC, (0, 3), (0, -1), mass=1)])
    assert len(world.step(1.0)) == 0
    world.place(0, (0, -5))
    (hit,) = world.step(10.0)
    assert hit["time"] == pytest.approx(7.5)
    assert world.time == 11


def test_a_static_body_with_a_velocity_begins_to_move() -> None:
    world = World([FLOOR, Body(DISC, (0, 3), mass=1)])
    assert len(world.step(5.0)) == 0
    world.place(0, velocity=(0, 1))
    (hit,) = world.step(4.0)
    assert hit["time"] == pytest.approx(7.5)
    assert world.velocities.tolist() == [[0, 1], [0, 2]]
    world.place(0, velocity=(0, 0))
    world.step(1.0)
    assert world.positions[0].tolist() == [0, 4]


def test_placing_at_any_moment_is_starting_there() -> None:
    started = World([FLOOR, Body(DISC, (1, 4), (1, -2), mass=2, restitution=0.5)])
    moved = World([FLOOR, Body(DISC, (9, 9), (0, -3), mass=2, restitution=0.5)])
    moved.step(20.0)
    moved.place(1, (1, 4), (1, -2))
    assert len(moved.step(5.0)) == len(started.step(5.0)) == 1
    np.testing.assert_allclose(moved.positions, started.positions, rtol=0, atol=1e-14)
    assert same(moved.velocities, started.velocities)


# Time and steps.


@given(st.floats(0, 1e6), st.integers(1, 300))
@settings(max_examples=50, deadline=None)
def test_time_is_the_exact_sum_of_the_steps(dt: float, steps: int) -> None:
    world = World([Body(DISC, (0, 0), mass=1)])
    world.step(dt, steps)
    assert world.time == float(Fraction(dt) * steps)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 12), st.booleans())
def test_several_steps_are_one_after_the_other(seed: int, steps: int, is_edited: bool) -> None:
    together, apart = random_world(seed), random_world(seed)
    if is_edited:
        for world in (together, apart):
            world.step(0.3)
            world.place(4, (3, 3), (1, 1))
    hits = together.step(0.17, steps)
    parts = np.concatenate([apart.step(0.17) for _ in range(steps)])
    assert same(hits, parts)
    assert same(together.positions, apart.positions)
    assert same(together.velocities, apart.velocities)
    assert together.time == apart.time
    assert together.snapshot() == apart.snapshot()


def test_a_step_of_no_time_changes_nothing() -> None:
    world = random_world(3)
    world.step(0.0)
    places, speeds = world.positions, world.velocities
    assert len(world.step(0.0, steps=5)) == 0
    assert same(world.positions, places)
    assert same(world.velocities, speeds)
    assert world.time == 0


def test_hits_belong_to_the_caller() -> None:
    world = World([FLOOR, Body(DISC, (0, 1), (0, -1), mass=1)])
    first = world.step(1.0)
    kept = first.copy()
    world.place(1, (4, 1), (0, -2))
    world.step(1.0)
    assert same(first, kept)
    assert first[0]["kind"] == HIT


# The restitution of a pair.


def test_a_pair_has_its_own_restitution_until_it_is_taken_back() -> None:
    world = World([FLOOR, Body(DISC, (0, 1.5), (0, -1), mass=1, restitution=0.5)])
    world.set_restitution(1, 0, 2.0)
    world.step(2.0)
    assert world.velocities[1, 1] == 2
    for override, expected in ((None, 0.5), (0.0, 0.0), (1.0, 1.0), (None, 0.5)):
        world.place(1, (0, 1.5), (0, -1))
        world.set_restitution(0, 1, override)
        world.step(2.0)
        assert world.velocities[1, 1] == expected


def test_several_bodies_are_asked_for_and_placed_as_each_alone() -> None:
    """To write the velocities of a crowd, one call for each body took longer than the step."""
    one, other = (World() for _ in range(2))
    for world in (one, other):
        for number in range(9):
            mass = None if number % 3 == 0 else 1.0
            world.add(Body(Particle(0.4), (float(number), 0.0), (0.0, 1.0 * (number == 0)), mass))
        world.remove(4)
        assert world.add(Body(Particle(0.4), (4.0, 0.0), mass=1.0)) not in range(9)
        world.step(0.1)
    chosen = one.handles[[7, 0, 3, 8, 4]]
    assert one.position(chosen).tolist() == [one.position(handle).tolist() for handle in chosen]
    assert one.velocity(chosen).tolist() == [one.velocity(handle).tolist() for handle in chosen]
    velocities = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 2.0], [3.0, 0.5], [0.0, 0.0]])
    one.place(chosen, velocity=velocities)
    one.place(chosen[:2], velocities[:2] + 20.0)
    one.place(chosen[2:4].tolist(), velocity=(0.5, 0.25))
    for handle, velocity in zip(chosen.tolist(), velocities.tolist(), strict=True):
        other.place(handle, velocity=velocity)
    for handle, velocity in zip(chosen[:2].tolist(), velocities[:2].tolist(), strict=True):
        other.place(handle, (velocity[0] + 20.0, velocity[1] + 20.0))
    for handle in chosen[2:4].tolist():
        other.place(handle, velocity=(0.5, 0.25))
    assert one.step(0.5).tobytes() == other.step(0.5).tobytes()
    assert one.snapshot() == other.snapshot()


@pytest.mark.parametrize(
    ("handles", "given", "error", "message"),
    [
        ([0, 5], {"velocity": (1.0, 0.0)}, NoBodyError, "no body 5"),
        ([-1, 0], {"velocity": (1.0, 0.0)}, NoBodyError, "no body -1"),
        ([0.0, 1.0], {"velocity": (1.0, 0.0)}, TypeError, "integers"),
        ([[0, 1]], {"velocity": (1.0, 0.0)}, TypeError, "integers"),
        ([0, 1], {"velocity": [(1.0, 0.0)] * 3}, ValueError, r"\[2, 2\]"),
        ([0, 1], {"position": (math.nan, 0.0)}, ValueError, "finite"),
        ([0, 1], {"position": (1.0, 0.0, 0.0)}, ValueError, "shape"),
    ],
)
def test_several_bodies_are_checked_before_any_is_placed(
    handles: Any, given: Any, error: type[Exception], message: str
) -> None:
    world = World([Body(Particle(1.0), (float(3 * number), 0.0), mass=1.0) for number in range(2)])
    before = world.snapshot()
    with pytest.raises(error, match=message):
        world.place(handles, **given)
    assert world.snapshot() == before
