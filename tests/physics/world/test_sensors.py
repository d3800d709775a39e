"""Sensors: which bodies enter and leave, at which exact time; no motion changes."""

import math
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
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
    World,
    WorldBatch,
    contact,
    detect,
    time_of_impact,
)
from helpers.bodies import DISC, OPEN_SHAPE
from hypothesis import assume, given, settings
from hypothesis import strategies as st

SQUARE = AxisAlignedRectangle(2, 2)

ZONES: tuple[Collider, ...] = (
    Particle(1.2),
    HalfPlane((1, 2), 0.25),
    AxisAlignedHalfPlane("-y", 0.5),
    SQUARE,
    Rectangle(2, 1, 0.5),
    Convex([(0, 0), (2, 0), (1, 1.5)]),
    OPEN_SHAPE,
)

GUESTS = (DISC, Particle(0), Rectangle(0.5, 0.7, 1), Convex([(0, 0), (1, 0), (0, 1)]))


def with_sensor(collider: Collider, *bodies: Body, **motion: Any) -> World:
    """Return a world with a sensor as its first body, and other bodies."""
    world = World()
    world.add(Body(collider, **motion), sensor=True)
    for body in bodies:
        world.add(body)
    return world


def run(world: World, duration: float, dt: float) -> Any:
    """Return all events within a duration, step by step."""
    return np.concatenate([world.step(dt) for _ in range(round(duration / dt))])


def story(hits: Any) -> list[tuple[int, int, int]]:
    return [(int(hit["kind"]), int(hit["a"]), int(hit["b"])) for hit in hits]


# Exact times.


@pytest.mark.parametrize("dt", [10.0, 1.25, 0.25, 0.01])
def test_a_passage_is_two_events(dt: float) -> None:
    world = with_sensor(SQUARE, Body(DISC, (-5, 0), (2, 0), mass=1))
    first, last = run(world, 10, dt)
    assert (first["kind"], last["kind"]) == (BEGIN, END)
    assert (first["time"], last["time"]) == pytest.approx((1.75, 3.25), rel=1e-13)
    for hit, x in ((first, -1), (last, 1)):
        assert (hit["a"], hit["b"], hit["impulse"]) == (0, 1, 0)
        assert hit["normal"].tolist() == [x, 0]
        assert hit["point"] == pytest.approx([x, 0], abs=1e-13)


@settings(max_examples=100, deadline=None)
@given(
    st.floats(-1.6, 1.6),
    st.floats(0, 2 * math.pi),
    st.floats(0.01, 1e3),
    st.floats(0.1, 1),
    st.integers(1, 20),
)
def test_a_disc_is_crossed_along_a_chord(
    miss: float, angle: float, speed: float, radius: float, steps: int
) -> None:
    half = radius + 1.2
    assume(abs(abs(miss) - half) > 1e-6)
    along = np.array([math.cos(angle), math.sin(angle)])
    across = np.array([-along[1], along[0]])
    ball = Body(Particle(radius), -5 * along + miss * across, speed * along, mass=1)
    hits = run(with_sensor(Particle(1.2), ball), 10 / speed, 10 / speed / steps)
    if abs(miss) > half:
        assert len(hits) == 0
        return
    chord = math.sqrt(half**2 - miss**2)
    assert hits["kind"].tolist() == [BEGIN, END]
    # The uncertainty of a grazing chord is the square root of that of the distance.
    error = 1e-14 * max(1.0, 5 / chord)
    assert hits["time"] * speed == pytest.approx([5 - chord, 5 + chord], abs=5 * error)
    for hit, sign in zip(hits, (-1, 1), strict=True):
        normal = (miss * across + sign * chord * along) / half
        assert hit["normal"] == pytest.approx(normal, abs=20 * error)
        assert hit["point"] == pytest.approx(1.2 * normal, abs=20 * error)


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(ZONES),
    st.sampled_from(GUESTS),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    st.floats(0, 2 * math.pi),
    st.sampled_from([100.0, 10.0, 2.5]),
)
def test_leaving_is_entering_in_reversed_time(
    zone: Collider, shape: Collider, aim: tuple[float, float], angle: float, dt: float
) -> None:
    velocity = np.array([math.cos(angle), math.sin(angle)])
    start = np.array(aim) - 50 * velocity
    there = time_of_impact(Body(zone), Body(shape, start, velocity), 100)
    back = time_of_impact(Body(zone), Body(shape, start + 100 * velocity, -velocity), 100)
    expected = [] if there is None else [(BEGIN, there.time)]
    # If the motion ends inside, the reversed one begins inside.
    expected += [] if back is None or back.time == 0 else [(END, 100 - back.time)]
    # A grazing passage is seen from one side only, or is no deeper than rounding.
    assume((there is None) == (back is None))
    if there is not None and back is not None:
        half_way = start + (there.time + 100 - back.time) / 2 * velocity
        overlap = contact(Body(zone), Body(shape, half_way))
        assume(overlap is not None and overlap.depth > 1e-9)
    assume(all(time == 0 or 1e-9 < time < 100 - 1e-9 for _, time in expected))
    hits = run(with_sensor(zone, Body(shape, start, velocity)), 100, dt)
    assert hits["kind"].tolist() == [kind for kind, _ in expected]
    assert hits["time"] == pytest.approx([time for _, time in expected], abs=1e-11)


def test_bounces_in_between_do_not_count() -> None:
    """A ball crosses a strip, bouncing between floor and ceiling, and returns from the far wall."""
    strip = Convex.from_half_planes(AxisAlignedHalfPlane("+x", 3), AxisAlignedHalfPlane("-x", -1))
    world = with_sensor(strip, Body(AxisAlignedHalfPlane("+y")))
    world.add(Body(AxisAlignedHalfPlane("-y"), (0, 2)))
    world.add(Body(AxisAlignedHalfPlane("+x"), (-4, 0)))
    world.add(Body(AxisAlignedHalfPlane("-x"), (6, 0)))
    ball = world.add(Body(DISC, (0, 0.7), (1, 7), mass=1))
    hits = world.step(100.0)
    assert (hits["kind"] == HIT).sum() > 600
    assert (np.diff(hits["time"]) >= 0).all()
    events = hits[hits["kind"] != HIT]
    # The room for its centre is 9 wide: it is back after 18, and enters at 0.5 and at 3.5.
    expected = [
        (18 * lap + time, kind)
        for lap in range(6)
        for time, kind in ((0.5, BEGIN), (3.5, END), (7.5, BEGIN), (10.5, END))
        if 18 * lap + time < 100
    ]
    assert events["kind"].tolist() == [kind for _, kind in expected]
    assert events["time"] == pytest.approx([time for time, _ in expected], abs=1e-12)
    assert set(events["b"]) == {ball}


def test_a_ball_that_bounces_inside_leaves_where_it_entered() -> None:
    world = with_sensor(SQUARE, Body(DISC, (-4, 0), (1, 0), mass=1))
    world.add(Body(AxisAlignedHalfPlane("-x"), (1, 0)))
    hits = world.step(20.0)
    assert story(hits) == [(BEGIN, 0, 1), (HIT, 1, 2), (END, 0, 1)]
    assert hits["time"].tolist() == [2.5, 4.5, 6.5]


# Which bodies a sensor notices.


def test_sensors_ignore_sensors_and_static_bodies() -> None:
    world = with_sensor(SQUARE, Body(SQUARE, (1, 0)))
    world.add(Body(SQUARE, (5, 0), (-1, 0)), sensor=True)
    hits = world.step(10.0)
    # The moving sensor notices the static body; no sensor notices the other one.
    assert story(hits) == [(BEGIN, 1, 2), (END, 1, 2)]
    assert hits["time"].tolist() == [2, 6]


def test_sensors_notice_kinematic_bodies_and_may_be_kinematic() -> None:
    world = with_sensor(SQUARE, Body(SQUARE, (0, 7)), velocity=(0, 1))
    world.add(Body(DISC, (5, 4), (-1, 0)))
    world.add(Body(DISC, (0, -4), (0, 3), mass=1), mask=0)
    hits = world.step(20.0)
    # Seen from the sensor, the disc moves diagonally, in at the right and out at the bottom.
    assert story(hits) == [(BEGIN, 0, 2), (BEGIN, 0, 1), (END, 0, 2), (END, 0, 1)]
    assert hits["time"] == pytest.approx([3.5, 5, 5.5, 9], rel=1e-15)
    assert hits["normal"].tolist() == [[1, 0], [0, 1], [0, -1], [0, -1]]
    assert world.velocities.tolist() == [[0, 1], [0, 0], [-1, 0], [0, 3]]


def test_one_entry_where_sensor_and_body_both_move() -> None:
    """Both had planned the same entry, after a bounce, and it was reported twice."""
    world = with_sensor(
        AxisAlignedRectangle(2, 20), Body(DISC, (5, 2), (-1, -1), mass=1), velocity=(0.1, 0)
    )
    world.add(Body(AxisAlignedHalfPlane("+y")), mask=2)
    floor = world.add(Body(AxisAlignedRectangle(4, 1), (4, -0.5)))
    hits = world.step(20.0)
    ball = hits[hits["b"] != floor]
    assert ball["kind"].tolist() == [BEGIN, END]
    assert ball["time"] == pytest.approx([3.5 / 1.1, 6.5 / 1.1], rel=1e-14)


def test_masks_decide_what_a_sensor_notices() -> None:
    for category, mask, noticed in ((1, 2, False), (2, 1, False), (3, 2, True), (2, 3, True)):
        world = World()
        world.add(Body(SQUARE), sensor=True, category=2, mask=2)
        world.add(Body(DISC, (-3, 0), (1, 0), mass=1), category=category, mask=mask)
        assert len(world.step(10.0)) == 2 * noticed


def test_touching_is_not_entering() -> None:
    slides = with_sensor(SQUARE, Body(DISC, (-5, 1.5), (1, 0), mass=1))
    assert len(slides.step(20.0)) == 0
    # One corner passes another, along a diagonal.
    grazes = with_sensor(SQUARE, Body(AxisAlignedRectangle(1, 1), (-3.5, -0.5), (1, 1), mass=1))
    assert len(grazes.step(20.0)) == 0
    turned = World([Body(AxisAlignedHalfPlane("+x"), (1, 0))])
    turned.add(Body(SQUARE), sensor=True)
    turned.add(Body(DISC, (4, 0), (-1, 0), mass=1))
    assert story(turned.step(20.0)) == [(HIT, 0, 2)]
    stays = with_sensor(SQUARE, Body(DISC, (1.5, 0), mass=1))
    assert len(stays.step(20.0)) == 0


def test_events_of_several_sensors_are_in_the_order_of_time() -> None:
    world = World()
    for width in (6, 2, 4):
        world.add(Body(AxisAlignedRectangle(width, 2)), sensor=True)
    world.add(Body(DISC, (-6, 0), (1, 0), mass=1))
    hits = world.step(20.0)
    opens = [(BEGIN, 0, 3), (BEGIN, 2, 3), (BEGIN, 1, 3)]
    closes = [(END, 1, 3), (END, 2, 3), (END, 0, 3)]
    assert story(hits) == opens + closes
    assert hits["time"].tolist() == [2.5, 3.5, 4.5, 7.5, 8.5, 9.5]


# Placed bodies.


@pytest.mark.parametrize("dt", [0.0, 1.0])
def test_a_body_put_inside_enters_once_as_the_step_begins(dt: float) -> None:
    world = with_sensor(SQUARE, Body(DISC, (0.3, 0), (0.1, 0), mass=1))
    (hit,) = world.step(dt)
    assert (hit["kind"], hit["time"]) == (BEGIN, 0)
    assert len(world.step(dt)) == 0


def test_a_body_placed_elsewhere_leaves_as_the_next_step_begins() -> None:
    """It was forgotten, without an event."""
    world = with_sensor(SQUARE, Body(DISC, (0, 0), (1, 0), mass=1))
    assert len(world.step(0.25)) == 1
    world.place(1, (9, 9))
    (left,) = world.step(0.25)
    assert (left["kind"], left["time"], left["a"], left["b"]) == (END, 0.25, 0, 1)
    assert left["normal"].tolist() == [0, 0]
    assert left["point"].tolist() == [9, 9]
    world.place(1, (0, 0))
    assert story(world.step(0.25)) == [(BEGIN, 0, 1)]
    world.place(0, (5, 5))  # the sensor, which is static
    assert story(world.step(0.25)) == [(END, 0, 1)]
    world.place(0, (0, 0))
    assert story(world.step(0.25)) == [(BEGIN, 0, 1)]


@pytest.mark.parametrize("continuous", [True, False])
def test_a_body_placed_inside_in_every_frame_enters_once(continuous: bool) -> None:
    """It entered in each frame: it counted as outside each time that its position was written."""
    world = World(continuous=continuous)
    world.add(Body(SQUARE), sensor=True)
    world.add(Body(DISC, (-3, 0), (1, 0), mass=1))
    kinds = []
    for frame in range(13):
        world.place(1, (-3 + frame / 2, 0))
        kinds += [(frame, int(hit["kind"])) for hit in world.step(0.125)]
    # It is inside between -1.5 and 1.5, and moves by 1/8 after it was placed.
    assert kinds == [(3, BEGIN), (9, END)]


def test_a_ball_that_is_served_again_is_noticed_again() -> None:
    """The sensor still counted it as inside after its position was written into the batch's state.

    There was no event when it entered again. If it was placed beyond the sensor, it was reported to
    have left long before the step: when it would have left, had it moved there by itself.
    """
    batch = WorldBatch(with_sensor(SQUARE, Body(DISC, (-2, 0), (1, 0), mass=1)), 3)
    batch.step(2.0)
    batch.positions[1, 0] = (-9, 0)
    batch.positions[2, 0] = (90, 0)
    hits = batch.step(10.0)
    assert hits["world"].tolist() == [0, 1, 1, 2]
    assert hits["kind"].tolist() == [END, END, BEGIN, END]
    assert hits["time"] == pytest.approx([3.5, 2.0, 9.5, 2.0])


@pytest.mark.parametrize("velocity", [(0, 1), (0, -1), (1, 0), (0, 0)])
def test_a_body_relaxed_out_of_a_sensor_leaves_at_once(velocity: tuple[float, float]) -> None:
    """The time was before the step: when it would have left, had it moved there by itself.

    If the sensor came after it, it still counted as inside, and did not enter again.
    """
    world = with_sensor(SQUARE, Body(DISC, (-0.5, 1), (1, 0), mass=1))
    world.step(1.0)
    world.add(Body(AxisAlignedRectangle(8, 1), (0, 0.8)))
    world.place(0, velocity=velocity)
    hits = world.step(0.5)
    assert world.positions[1].tolist() == [1, 1.8]
    hits, comes_after = hits[hits["b"] == 1], velocity == (0, 1)
    assert hits["kind"].tolist() == ([END, BEGIN] if comes_after else [END])
    assert hits["time"] == pytest.approx([1.0, 1.3] if comes_after else [1.0])


# Many sensors, and random ones.


@pytest.mark.parametrize("continuous", [True, False])
def test_more_events_than_there_was_room_for(continuous: bool) -> None:
    """Three hundred sensors in a row, a bounce, and all of them again."""
    world = World(continuous=continuous)
    for index in range(300):
        world.add(Body(AxisAlignedRectangle(0.5, 1), (index, 0)), sensor=True)
    world.add(Body(AxisAlignedHalfPlane("-x"), (302, 0)))
    world.add(Body(Particle(0.1), (-2, 0), (1, 0), mass=1))
    hits = world.step(1000.0) if continuous else world.step(0.25, steps=4000)
    assert len(hits) == 2 * 600 + 1
    assert (np.diff(hits["time"]) >= 0).all()
    there, back = hits[:600], hits[601:]
    assert hits["kind"][600] == HIT
    assert there["a"].tolist() == [index for index in range(300) for _ in range(2)]
    assert back["a"].tolist() == there["a"].tolist()[::-1]
    for half in (there, back):
        assert half["kind"].tolist() == [BEGIN, END] * 300
    if continuous:
        entered = there["time"][::2]
        assert entered == pytest.approx(np.arange(300) + 2 - 0.35, rel=1e-13)
        assert there["time"][1::2] == pytest.approx(entered + 0.7, rel=1e-13)


def random_scene(seed: int, has_sensors: bool) -> tuple[World, list[int], list[int]]:
    """Return a room with balls and zones, some of which move, and the indices of both."""
    rng = np.random.default_rng(seed)
    world = World(
        Body(AxisAlignedHalfPlane(direction), place)
        for direction, place in (("+x", (0, 0)), ("-x", (6, 0)), ("+y", (0, 0)), ("-y", (0, 5)))
    )
    for index in range(5):
        world.add(Body(Particle(0.3), (1 + index, 1 + index * 0.7), rng.normal(size=2), mass=1))
    for index in range(6):
        place, velocity = rng.uniform((0, 0), (6, 5)), rng.normal(size=2) * 0.3 * (index % 2)
        zone = Body(ZONES[rng.integers(len(ZONES))], place, velocity)
        world.add(zone, sensor=has_sensors, mask=-1 if has_sensors else 0)
    return world, list(range(4, 9)), list(range(9, 15))


@pytest.mark.parametrize("seed", range(4))
def test_events_agree_with_detection_at_a_thousand_moments(seed: int) -> None:
    world, balls, zones = random_scene(seed, has_sensors=True)
    hits = world.step(4.0)
    watched, _, _ = random_scene(seed, has_sensors=False)
    events = {
        (zone, ball): hits[(hits["kind"] != HIT) & (hits["b"] == zone) & (hits["a"] == ball)]
        for zone in zones
        for ball in balls
    }
    assert sum(map(len, events.values())) > 15
    for own in events.values():
        assert own["kind"].tolist() == [BEGIN, END] * (len(own) // 2) + [BEGIN] * (len(own) % 2)
        assert (np.diff(own["time"]) >= 0).all()
    for _ in range(1000):
        now = watched.time
        bodies = [watched.body(index) for index in range(len(watched))]
        for (zone, ball), own in events.items():
            if len(own) and abs(own["time"] - now).min() < 1e-9:
                continue
            inside = (own["time"] < now).sum() % 2 == 1
            assert detect(bodies[zone], bodies[ball]) == inside
        watched.step(0.004)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6))
def test_sensors_change_no_motion(seed: int) -> None:
    sensed, _, _ = random_scene(seed, has_sensors=True)
    alone, _, _ = random_scene(seed, has_sensors=False)
    hits, plain = sensed.step(3.0), alone.step(3.0)
    hits = hits[hits["kind"] == HIT]
    assert hits[["a", "b"]].tolist() == plain[["a", "b"]].tolist()
    # The position where it enters is rounded once more.
    for ours, theirs in (
        (hits["time"], plain["time"]),
        (sensed.positions, alone.positions),
        (sensed.velocities, alone.velocities),
    ):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)
