"""Hits and what they do: speeds in closed form, which bodies meet, the lecture's procedure."""

from itertools import combinations
from typing import Any

import numpy as np
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
    bounce,
    contact,
    detect,
    relax,
)
from helpers.bodies import DISC, FLOOR, SHAPES
from hypothesis import example, given, settings
from hypothesis import strategies as st


def moving_scene(seed: int) -> list[Body]:
    """Return walls, two obstacles, a kinematic body and twelve dynamic ones, all apart."""
    rng = np.random.default_rng(seed)
    bodies = [
        Body(HalfPlane((1, 0.1)), (0, 0)),
        Body(HalfPlane((-1, 0.05)), (9, 0)),
        Body(AxisAlignedHalfPlane("+y")),
        Body(AxisAlignedHalfPlane("-y"), (0, 7)),
        Body(Rectangle(1, 2, 0.3), (3, 3.4)),
        Body(Convex([(0, 0), (1, 0.2), (0.4, 1)]), (6.2, 3.2)),
        Body(AxisAlignedRectangle(0.5, 0.5), (4.7, 3.4), (0.1, 0)),
    ]
    for index in range(12):
        place = (1.6 + index % 6 * 1.2, (0.9, 5.9)[index // 6])
        bodies.append(
            Body(
                SHAPES[index % 4],
                place,
                rng.normal(size=2) * 1.5,
                mass=float(rng.uniform(0.2, 5)),
                restitution=float(rng.choice([0.5, 1.0])),
            )
        )
    return bodies


# The fields of a hit.


@pytest.mark.parametrize("seed", range(6))
def test_hits_explain_every_change_of_velocity(seed: int) -> None:
    """Bodies move straight from hit to hit, and only the impulses of hits change velocities.

    At each hit the two touch: at its point, along its normal, after they approached. Hits at one
    time follow each other, or are one event.
    """
    bodies = moving_scene(seed)
    world = World(bodies)
    hits = np.concatenate([world.step(0.5) for _ in range(6)])
    assert len(hits) > 15
    assert (np.diff(hits["time"]) >= 0).all()
    assert (hits["kind"] == HIT).all()
    assert (hits["a"] < hits["b"]).all()
    now = 0.0
    for time in np.unique(hits["time"]):
        for body in bodies:
            body.position = body.position + body.velocity * (time - now)
        now = time
        together = hits[hits["time"] == time]
        for hit in together:
            check_touch(bodies[hit["a"]], bodies[hit["b"]], hit["normal"], hit["point"])
        before = [body.velocity for body in bodies]
        if not all(is_a_bounce(bodies, [hit]) for hit in together):
            for body, velocity in zip(bodies, before, strict=True):
                body.velocity = velocity
            assert is_a_bounce(bodies, together)
    places = [body.position + body.velocity * (3.0 - now) for body in bodies]
    np.testing.assert_allclose(world.positions, places, rtol=0, atol=1e-11)
    velocities = [body.velocity for body in bodies]
    np.testing.assert_allclose(world.velocities, velocities, rtol=0, atol=1e-11)


def is_a_bounce(bodies: list[Body], hits: Any) -> bool:
    """Apply the impulses of hits that are one event; return whether they explain it."""

    def approaches() -> Any:
        pairs = [(bodies[hit["a"]], bodies[hit["b"]], hit["normal"]) for hit in hits]
        return np.array([(a.velocity - b.velocity) @ normal for a, b, normal in pairs])

    before = approaches()
    for hit in hits:
        for body, sign in ((bodies[hit["a"]], 1), (bodies[hit["b"]], -1)):
            if body.mass is not None:
                change = sign * hit["impulse"] / body.mass * hit["normal"]
                body.velocity = body.velocity + change
    e = [bodies[hit["a"]].restitution * bodies[hit["b"]].restitution for hit in hits]
    return bool((before > 0).all() and (abs(approaches() + e * before) < 1e-12).all())


def check_touch(a: Body, b: Body, normal: Any, point: Any) -> None:
    """Check that two bodies touch at a point, along a normal from a to b."""
    near = 1e-8
    overlap = contact(a, b)
    assert overlap is None or overlap.depth < 1e-9
    assert np.hypot(*normal) == pytest.approx(1, abs=1e-15)
    assert detect(a, Body(b.collider, b.position - near * normal))
    assert not detect(a, Body(b.collider, b.position + near * normal))
    for body in (a, b):
        # It is on the surface: a small disc there reaches in, a point is not deep inside.
        assert detect(Body(Particle(near), point), body)
        depth = contact(Body(Particle(0), point), body)
        assert depth is None or depth.depth < near


def test_each_pair_hits_once_and_static_pairs_never() -> None:
    overlapping = [Body(AxisAlignedRectangle(2, 2), (x, 0)) for x in (0, 0.5)]
    world = World([*overlapping, FLOOR, Body(DISC, (0.25, 5), (0, -1), mass=1)])
    hits = world.step(4.0)
    # The disc meets both boxes at once. The first reverses it: it moves away from the other.
    assert hits[["a", "b"]].tolist() == [(0, 3)]
    assert hits["time"].tolist() == [3.5]


@pytest.mark.parametrize("swapped", [False, True])
def test_the_normal_goes_from_the_lower_index_to_the_higher(swapped: bool) -> None:
    pair = [Body(DISC, (0, 0), (1, 0), mass=1), Body(AxisAlignedHalfPlane("-x"), (2, 0))]
    (hit,) = World(pair[::-1] if swapped else pair).step(2.0)
    assert (hit["a"], hit["b"]) == (0, 1)
    assert hit["normal"].tolist() == ([-1, 0] if swapped else [1, 0])
    assert hit["point"].tolist() == [2, 0]
    assert hit["impulse"] == -2


def test_a_cradle_passes_the_speed_on() -> None:
    """Touching discs hit each other at the same time, one after the other."""
    world = World(Body(DISC, (x, 0), mass=1) for x in range(1, 6))
    first = world.add(Body(DISC, (-3, 0), (2, 0), mass=1))
    hits = world.step(3.0)
    assert hits["time"] == pytest.approx([1.5] * 5, rel=1e-13)
    assert hits[["a", "b"]].tolist() == [(0, first), (0, 1), (1, 2), (2, 3), (3, 4)]
    assert world.velocities[:, 0].tolist() == [0, 0, 0, 0, 2, 0]


# Speeds after a hit.


@given(
    st.floats(0.1, 10),
    st.floats(0.1, 10),
    st.floats(-5, 5),
    st.floats(0.01, 5),
    st.sampled_from([0.0, 0.5, 1.0, 1.5]),
    st.booleans(),
)
@settings(max_examples=100, deadline=None)
def test_two_discs_head_on(
    m1: float, m2: float, v2: float, approach: float, e: float, is_override: bool
) -> None:
    own = (0.3, 0.7) if is_override else (e, 1.0)
    v1 = v2 + approach
    world = World(
        [
            Body(DISC, (0, 0), (v1, 0.25), m1, own[0]),
            Body(DISC, (3, 0), (v2, 0.25), m2, own[1]),
        ]
    )
    if is_override:
        world.set_restitution(0, 1, e)
    duration = 2 * 2 / approach
    hit, *others = world.step(duration)
    assert not others  # also if their speeds are equal only up to rounding
    centre = (m1 * v1 + m2 * v2) / (m1 + m2)
    expected = [centre - e * m2 * approach / (m1 + m2), centre + e * m1 * approach / (m1 + m2)]
    assert hit["time"] == pytest.approx(duration / 2, rel=1e-12)
    assert world.velocities[:, 0] == pytest.approx(expected, rel=1e-13, abs=1e-13)
    assert world.velocities[:, 1].tolist() == [0.25, 0.25]
    assert hit["impulse"] == pytest.approx(-(1 + e) * approach * m1 * m2 / (m1 + m2), rel=1e-12)


@pytest.mark.parametrize(
    ("e", "times"),
    [
        (0.0, [1]),
        (0.5, [1, 3, 7, 15]),
        (1.0, [1, 2, 3, 4, 5]),
        (2.0, [1, 1.5, 1.75, 1.875, 1.9375]),
    ],
)
def test_each_hit_changes_the_next_flight(e: float, times: list[float]) -> None:
    """Between floor and ceiling each flight takes 1 / e times as long as the last one."""
    world = World([FLOOR, Body(AxisAlignedHalfPlane("-y"), (0, 2))])
    world.add(Body(DISC, (0, 0.5), (0, 1), mass=1, restitution=e))
    hits = world.step(times[-1])
    assert hits["time"].tolist() == times
    assert world.velocities[2, 1] == (-e) ** len(times)


# Bodies that collisions do not move.


@given(
    st.floats(-3, 3),
    st.floats(0.1, 5),
    st.sampled_from([0.0, 0.5, 1.0, 1.5]),
    st.sampled_from([1e-9, 1.0, 1e9]),
)
@settings(max_examples=60, deadline=None)
@example(-1.7368674520671905, 5.0, 0.0, 1.0)
@example(1.73144711541883e-14, 2.0, 0.0, 1e-9)
def test_a_paddle_hits_a_ball_and_keeps_its_motion(
    paddle: float, approach: float, e: float, mass: float
) -> None:
    world = World([Body(AxisAlignedRectangle(1, 4), (0, 0), (paddle, 0.5))])
    world.add(Body(DISC, (4, 0), (paddle - approach, 0.5), mass, e))
    (hit,) = world.step(6 / approach)
    assert hit["time"] == pytest.approx(3 / approach, rel=1e-13)
    assert hit["normal"].tolist() == [1, 0]
    assert world.velocities[0].tolist() == [paddle, 0.5]
    assert world.velocities[1] == pytest.approx([paddle + e * approach, 0.5], rel=1e-14, abs=1e-14)
    assert world.positions[0] == pytest.approx([paddle * 6 / approach, 3 / approach], rel=1e-13)
    assert hit["impulse"] == pytest.approx(-(1 + e) * approach * mass, rel=1e-13)


def test_kinematic_bodies_pass_through_each_other_and_through_walls() -> None:
    world = World([FLOOR, Body(DISC, (0, 2), (1, 0)), Body(DISC, (4, 2), (-1, -1))])
    assert len(world.step(5.0)) == 0
    assert world.positions[1:].tolist() == [[5, 2], [-1, -3]]


# Masks.

bits = st.integers(-1, 7)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(bits, bits), min_size=2, max_size=5))
def test_two_bodies_meet_if_each_mask_has_the_other_category(
    filters: list[tuple[int, int]],
) -> None:
    """Every pair alone, and all at one position, where those that meet push each other."""
    for (number, one), (index, other) in combinations(enumerate(filters), 2):
        world = World()
        world.add(Body(DISC, (0, 0), (1, 0), mass=1), category=one[0], mask=one[1])
        world.add(Body(DISC, (3, 0), mass=1), category=other[0], mask=other[1])
        meets = one[0] & other[1] and other[0] & one[1]
        assert number < index
        assert len(world.step(4.0)) == bool(meets)
        world.place(0, (0, 0))
        world.place(1, (0.5, 0))
        world.step(0.0)
        assert (world.positions[:, 0].tolist() == [-0.25, 0.75]) == bool(meets)


def test_the_highest_bit_is_a_category_and_all_bits_are_a_mask() -> None:
    """``1 << 63`` and ``2**64 - 1`` "must fit into 64 bits", although they do."""
    world = World()
    for x, speed, mask in ((0, 1, 2**64 - 1), (3, 0, 1 << 63), (9, 0, (1 << 63) - 1)):
        world.add(Body(DISC, (x, 0), (speed, 0), mass=1), category=1 << 63, mask=mask)
    (hit,) = world.step(9.0)
    assert (hit["a"], hit["b"]) == (0, 1)
    assert world.query_point((9, 0), 1 << 63).tolist() == [2]
    assert world.query_point((9, 0), 2**63 - 1).tolist() == []


# The procedure of the lecture on collisions in games: detection, relaxation, bounce.


def by_hand(bodies: list[Body], dt: float) -> list[tuple[int, int]]:
    """Move all, then detect, relax and bounce pair by pair; return the pairs that overlapped.

    Every moving body, in order, meets unbounded walls, then other static bodies, then later
    moving ones.
    """
    moving = [i for i, body in enumerate(bodies) if body.mass or body.velocity.any()]
    static = [i for i in range(len(bodies)) if i not in moving]
    walls = [i for i in static if isinstance(bodies[i].collider, HalfPlane | AxisAlignedHalfPlane)]
    static = walls + [i for i in static if i not in walls]
    for i in moving:
        bodies[i].position = bodies[i].position + dt * bodies[i].velocity
    met = []
    for i in moving:
        for j in static + [j for j in moving if j > i]:
            a, b = bodies[i], bodies[j]
            overlap = contact(a, b) if a.mass or b.mass else None
            if overlap is not None:
                relax(a, b, overlap)
                bounce(a, b, overlap.normal)
                met.append((min(i, j), max(i, j)))
    return met


@pytest.mark.parametrize("seed", range(8))
def test_discrete_steps_equal_the_procedure_by_hand(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bodies = [
        Body(HalfPlane((1, 0.1))),
        Body(AxisAlignedHalfPlane("-x"), (4, 0)),
        Body(AxisAlignedHalfPlane("+y")),
        Body(AxisAlignedHalfPlane("-y"), (0, 4)),
        Body(Rectangle(1, 1, 0.4), (2, 2)),
        Body(AxisAlignedRectangle(0.8, 0.3), (2, 0.5), (0.3, 0.1)),
    ]
    for index in range(5):
        place, velocity = rng.uniform(0.5, 3.5, 2), rng.normal(size=2)
        mass, e = float(rng.uniform(0.3, 3)), float(rng.uniform(0.5, 1))
        bodies.append(Body(SHAPES[index % 4], place, velocity, mass, e))
    world = World(bodies, continuous=False)
    total = 0
    for step in range(40):
        hits = world.step(0.125)
        met = by_hand(bodies, 0.125)
        assert hits[["a", "b"]].tolist() == met
        assert (hits["time"] == 0.125 * (step + 1)).all()
        total += len(met)
        places = [body.position for body in bodies]
        np.testing.assert_allclose(world.positions, places, rtol=0, atol=1e-9)
        velocities = [body.velocity for body in bodies]
        np.testing.assert_allclose(world.velocities, velocities, rtol=0, atol=1e-9)
    assert total > 15


def test_discrete_steps_tunnel_and_continuous_ones_do_not() -> None:
    wall, ball = Body(AxisAlignedRectangle(0.1, 4)), Body(DISC, (-5, 0), (10, 0), mass=1)
    assert len(World([wall, ball], continuous=False).step(1.0)) == 0
    (hit,) = World([wall, ball]).step(1.0)
    assert hit["time"] == pytest.approx(0.445, rel=1e-15)
