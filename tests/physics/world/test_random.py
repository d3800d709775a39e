"""Random worlds compared with a brute-force simulation, and the laws that hold for all.

The simulation has no grid, no plans and no order of events. It asks every pair for its time of
impact, moves all bodies to the first of these times, bounces that pair, and repeats.
"""

import math
from itertools import combinations
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
    bounce,
    detect,
    time_of_impact,
)
from arkanoid.physics.tolerances import LONGEST_SERIES
from arkanoid.physics.world.memory import setup
from helpers.bodies import bodies_of, deepest_overlap
from hypothesis import assume, given, settings
from hypothesis import strategies as st

Rng = np.random.Generator


def random_shape(rng: Rng, size: float) -> Collider:
    """Return a shape of any bounded kind, with a radius of about the given size."""
    kind, angle = rng.integers(4), rng.uniform(0, math.tau)
    if kind == 0:
        return Particle(size)
    if kind == 1:
        return AxisAlignedRectangle(size * 1.5, size)
    if kind == 2:
        return Rectangle(size * 1.5, size, angle)
    corners = np.sort(rng.uniform(0, 0.8, 5)) + np.arange(5)
    turned = angle + corners * math.tau / 5
    return Convex(size * np.column_stack([np.cos(turned), np.sin(turned)]))


def scattered(rng: Rng, count: int, width: float, others: list[Body]) -> list[Body]:
    """Return moving bodies of all sizes that overlap neither each other nor the others."""
    bodies: list[Body] = []
    while len(bodies) < count:
        size = 0.1 * 6 ** rng.uniform()
        body = Body(
            random_shape(rng, size),
            rng.uniform(0.5, width - 0.5, 2),
            rng.normal(size=2),
            mass=size**2 * rng.uniform(0.5, 2),
            restitution=float(rng.choice([1.0, 1.0, 0.8])),
        )
        if not any(detect(body, other) for other in [*others, *bodies]):
            bodies.append(body)
    return bodies


def walls(width: float) -> list[Body]:
    """Return four walls of three unbounded kinds around a room."""
    return [
        Body(AxisAlignedHalfPlane("+x")),
        Body(HalfPlane((-1, 0.02), -width)),
        Body(Convex.from_half_planes(HalfPlane((-0.05, 1)), HalfPlane((0.03, 1), 0.1))),
        Body(AxisAlignedHalfPlane("-y"), (0, width)),
    ]


def crowd(seed: int, width: float = 9.0, count: int = 14) -> list[Body]:
    """Return a room with obstacles, a giant, a kinematic body, and many dynamic bodies."""
    rng = np.random.default_rng(seed)
    fixed = walls(width)
    fixed.append(Body(Rectangle(6, 0.5, 0.1), (4, 7.5), (0, -0.3), mass=20))  # the giant
    fixed.append(Body(AxisAlignedRectangle(0.6, 0.6), (0.8, 2), (0.4, 0.1)))
    for index in range(8):
        shape = random_shape(rng, float(rng.uniform(0.1, 0.4)))
        fixed.append(Body(shape, (1.5 + index % 4 * 2, 3.2 + index // 4 * 2)))
    return fixed + scattered(rng, count, width, fixed)


def brute_force(bodies: list[Body], duration: float) -> list[tuple[Any, ...]]:
    """Simulate; return (time, a, b, normal, impulse) of every hit. The bodies are changed."""
    now, hits = 0.0, []
    pairs = [
        (i, j)
        for i, j in combinations(range(len(bodies)), 2)
        if bodies[i].mass is not None or bodies[j].mass is not None
    ]
    while True:
        best, pair, normal = duration - now, None, np.zeros(2)
        for i, j in pairs:
            a, b = bodies[i], bodies[j]
            impact = time_of_impact(a, b, best)
            if impact is None or (pair is not None and impact.time >= best):
                continue
            # Two that have just bounced may still overlap, by rounding.
            if impact.time > 0 or (a.velocity - b.velocity) @ impact.normal > 1e-12:
                best, pair, normal = impact.time, (i, j), impact.normal
        for body in bodies:
            body.position = body.position + body.velocity * best
        now += best
        if pair is None:
            return hits
        impulse = bounce(bodies[pair[0]], bodies[pair[1]], normal)
        hits.append((now, *pair, normal, impulse))


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**9), st.integers(1, 5))
def test_the_hits_are_those_of_brute_force(seed: int, steps: int) -> None:
    bodies = crowd(seed)
    world = World(bodies)
    hits = np.concatenate([world.step(1.5 / steps) for _ in range(steps)])
    expected = brute_force(bodies, 1.5)
    assert hits[["a", "b"]].tolist() == [row[1:3] for row in expected]
    np.testing.assert_allclose(hits["time"], [row[0] for row in expected], rtol=0, atol=1e-9)
    np.testing.assert_allclose(hits["normal"], [row[3] for row in expected], rtol=0, atol=1e-8)
    np.testing.assert_allclose(hits["impulse"], [row[4] for row in expected], rtol=0, atol=1e-8)
    places = [body.position for body in bodies]
    np.testing.assert_allclose(world.positions, places, rtol=0, atol=1e-9)
    assert deepest_overlap(bodies_of(world)) < 1e-9


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("parts", [1, 7])
def test_the_broad_phase_changes_no_bit(
    seed: int, parts: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each crossing of a cell computed all times again, and rounded them differently.

    Here every body is tested against every other one, in one step; and the broad phase is used, in
    several steps. Sizes differ by a factor of 300, and the crowd flies far away.
    """
    rng = np.random.default_rng(seed)
    bodies = crowd(seed, width=14.0, count=40)[4:]
    bodies += [
        Body(Particle(0.02), rng.uniform(16, 20, 2), rng.normal(size=2), mass=1) for _ in range(60)
    ]
    bodies.append(Body(AxisAlignedRectangle(300, 6), (0, -30), (0, 4), mass=1e3))
    followed = World(bodies)
    hits = [followed.step(28.0 / parts) for _ in range(parts)]
    monkeypatch.setattr(setup, "have_bounds", lambda shapes: np.zeros(len(shapes), bool))
    tested = World(bodies)
    expected = tested.step(28.0)
    assert followed.site.setup.traits["boundless"].sum() == 0
    assert tested.site.setup.traits["boundless"][: len(bodies)].all()
    assert len(expected) > 50
    assert np.concatenate(hits).tobytes() == expected.tobytes()
    if parts == 1:
        assert followed.positions.tobytes() == tested.positions.tobytes()


def is_squeezed(hits: Any) -> bool:
    """Return whether a body has many hits at practically one time."""
    times = np.concatenate([hits["time"], hits["time"]]).round(6)
    bodies = np.concatenate([hits["a"], hits["b"]])
    _, counts = np.unique(np.column_stack([times, bodies]), axis=0, return_counts=True)
    return bool(counts.max(initial=0) > LONGEST_SERIES // 2)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**9), st.sampled_from(["moved", "padded", "reversed"]))
def test_neither_position_nor_grid_nor_order_matters(seed: int, change: str) -> None:
    plain = World(crowd(seed))
    bodies = crowd(seed)
    number = len(bodies)
    names = list(range(number))
    if change == "moved":
        for body in bodies:
            body.position = np.add(body.position, (1e3, -1e3))
    elif change == "padded":
        bodies += [Body(AxisAlignedRectangle(1, 1), (x, -50)) for x in range(-300, 300, 5)]
    else:
        bodies.reverse()
        names.reverse()
    other = World(bodies)
    expected, hits = plain.step(1.5), other.step(1.5)
    # Where a body is squeezed, rounding decides when its last bounce is.
    assume(not is_squeezed(expected))
    pairs = [tuple(sorted((names[a], names[b]))) for a, b in hits[["a", "b"]].tolist()]
    assert pairs == expected[["a", "b"]].tolist()
    np.testing.assert_allclose(hits["time"], expected["time"], rtol=0, atol=1e-8)
    places = other.positions[:number]
    if change == "moved":
        places = places - (1e3, -1e3)
    np.testing.assert_allclose(places[names], plain.positions, rtol=0, atol=1e-8)


@pytest.mark.parametrize("seed", range(3))
def test_bodies_never_overlap_and_never_leave(seed: int) -> None:
    world = World(crowd(seed, width=14, count=60))
    total = 0
    for _ in range(12):
        total += len(world.step(0.5))
        places = bodies_of(world)
        del places[5]  # the kinematic body may squeeze others, and leaves through the wall
        assert deepest_overlap(places) < 1e-9
    assert total > 150
    assert world.positions[14:].min() > -0.5
    assert world.positions[14:].max() < 15


@pytest.mark.parametrize("seed", range(3))
def test_energy_and_momentum_are_kept(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bodies = scattered(rng, 60, 9.0, [])
    for body in bodies:
        body.restitution = 1.0
        # Toward the middle, so that they meet.
        body.velocity = body.velocity + 0.3 * (np.array((4.5, 4.5)) - body.position)
    world = World(bodies)
    masses = np.array([body.mass for body in bodies])
    velocities = world.velocities
    momentum, energy = masses @ velocities, masses @ (velocities**2).sum(axis=1)
    moment = masses @ world.positions
    hits = world.step(3.0)
    assert len(hits) > 60
    assert masses @ world.velocities == pytest.approx(momentum, abs=1e-12)
    assert masses @ (world.velocities**2).sum(axis=1) == pytest.approx(energy, rel=1e-12)
    # So the centre of mass moves in a straight line.
    assert masses @ world.positions == pytest.approx(moment + 3.0 * momentum, abs=1e-11)
    assert deepest_overlap(bodies_of(world)) < 1e-9


def test_energy_is_lost_as_restitution_says() -> None:
    """Each hit loses (1 - e^2) of the energy of the approach, seen from the centre of mass."""
    bodies = crowd(7, count=30)
    del bodies[5]  # the kinematic body, which adds energy
    world = World(bodies)
    masses = np.array([body.mass or 0.0 for body in bodies])
    before = masses @ (world.velocities**2).sum(axis=1) / 2
    lost = 0.0
    hits = world.step(4.0)
    assert len(hits) > 60
    for hit in hits:
        a, b = bodies[hit["a"]], bodies[hit["b"]]
        e = a.restitution * b.restitution
        inverse = sum(1 / body.mass for body in (a, b) if body.mass)
        # The impulse J = (1 + e) u / inverse, u the speed of the approach.
        approach = -hit["impulse"] * inverse / (1 + e)
        lost += (1 - e * e) * approach**2 / inverse / 2
    after = masses @ (world.velocities**2).sum(axis=1) / 2
    assert before - after == pytest.approx(lost, rel=1e-9)
    assert lost > 0.1 * before
