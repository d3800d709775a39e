"""Bodies that lose speed at each hit: hits without end in a finite time, and what rests."""

import math
import pickle

import numpy as np
import pytest
from arkanoid.physics import Body, Particle, World, WorldBatch
from helpers.bodies import DISC, FLOOR, bodies_of, deepest_overlap, room

GRAVITY = 10.0
DT = 1 / 60


def pull(world: World, first: int, speed: float = GRAVITY * DT) -> None:
    """Let the bodies from the first one on fall by so much faster."""
    moving = world.handles[first:]
    world.place(moving, velocity=world.velocities[first:] - (0, speed))


@pytest.mark.parametrize("restitution", [0.01, 0.03, 0.05, 0.07, 0.075, 0.08, 0.1, 0.3])
def test_three_balls_collapse_as_theory_says(restitution: float) -> None:
    """McNamara & Young (1992): they hit each other without end if e < 7 - 4 * sqrt(3) = 0.0718.

    Then they move on together. If not, they part, at speeds that a loop of plain numbers gives.
    """
    places, speeds = [0.0, 1.01, 2.02], [1.0, 0.0, -0.75]
    world = World()
    for x, v in zip(places, speeds, strict=True):
        world.add(Body(DISC, (x, 0), (v, 0), 1, math.sqrt(restitution)))
    hits = world.step(1.0)
    assert world.capped == 0
    ends = world.velocities[:, 0]
    if restitution < 7 - 4 * math.sqrt(3):
        assert ends == pytest.approx([0.25 / 3] * 3, abs=1e-12)
        assert len(hits) < 64
        return
    gaps, number = np.diff(places) - 1.0, 0
    while True:
        closing = -np.diff(speeds)
        times = [gap / u if u > 0 else math.inf for gap, u in zip(gaps, closing, strict=True)]
        first = int(np.argmin(times))
        if times[first] == math.inf:
            break
        gaps = gaps - times[first] * closing
        gaps[first] = 0.0
        push = 0.5 * (1 + restitution) * closing[first]
        speeds[first] -= push
        speeds[first + 1] += push
        number += 1
    assert ends == pytest.approx(speeds, abs=1e-9)
    assert len(hits) == number


@pytest.mark.parametrize("restitution", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("ratio", [1.0, 100.0])
def test_a_pile_that_bounces_a_little_ends_its_steps(ratio: float, restitution: float) -> None:
    """Thirty discs: in many steps some used up their 10 000 hits, in series that went nowhere.

    With the ratio 1 they sink by a hundredth of their size at most, what slides by (`SLIDE`).
    """
    rng = np.random.default_rng(1)
    world, masses = World(room(6.3, 40)), []
    for index in range(30):
        place = (0.6 + index % 5 * 1.1 + rng.uniform(-0.05, 0.05), 1 + index // 5 * 1.2)
        masses.append(math.exp(rng.uniform(0, math.log(ratio))) if ratio > 1 else 1.0)
        disc = Particle(rng.uniform(0.3, 0.5))
        world.add(Body(disc, place, mass=masses[-1], restitution=math.sqrt(restitution)))
    for _ in range(120):
        pull(world, 4)
        before = masses @ (world.velocities[4:] ** 2).sum(axis=1)
        assert len(world.step(DT)) < 4000
        assert masses @ (world.velocities[4:] ** 2).sum(axis=1) <= before * (1 + 1e-12)
        assert world.capped == 0
        if ratio == 1:
            assert deepest_overlap(bodies_of(world)) < 0.01


@pytest.mark.parametrize("restitution", [0.3, 0.5, 0.9])
def test_a_ball_bounces_less_and_less_and_lies(restitution: float) -> None:
    """From 1 it rises to e^2, e^4 ..., and lies after sqrt(2 / g) (1 + e) / (1 - e).

    A step adds g dt to the speed, so each return is off by that, and all of them together by
    g dt / (1 - e): as much as `rest_speed` has to be.
    """
    dt = 1e-3
    off = GRAVITY * dt / (1 - restitution)
    world = World([FLOOR], rest_speed=off)
    ball = world.add(Body(DISC, (0, 1.5), mass=1, restitution=restitution))
    fastest = math.sqrt(2 * GRAVITY)
    peaks, top, bounces = [], 0.0, 0
    while bounces == 0 or world.velocity(ball)[1] != 0.0:
        pull(world, 1, GRAVITY * dt)
        bounced = len(world.step(dt)) > 0
        bounces += bounced
        if bounced:
            peaks.append(top)
            top = 0.0
        top = max(top, float(world.position(ball)[1]) - 0.5)
        assert world.time < 10
    for number, peak in enumerate(peaks[1:], 1):
        speed = fastest * restitution**number + off
        assert peak == pytest.approx(restitution ** (2 * number), abs=speed * off / GRAVITY)
    total = math.sqrt(2 / GRAVITY) * (1 + restitution) / (1 - restitution)
    assert world.time == pytest.approx(total, abs=2 * (bounces + 1) * off / GRAVITY)
    assert world.position(ball).tolist() == [0, 0.5]
    for _ in range(10):
        pull(world, 1, GRAVITY * dt)
        world.step(dt)
        assert world.position(ball).tolist() == [0, 0.5]


@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_a_stack_of_discs_comes_to_rest(restitution: float) -> None:
    """It trembled for ever. At rest, a step costs one hit for each touch."""
    world = World([FLOOR], rest_speed=GRAVITY * DT / (1 - restitution))
    for level in range(6):
        place = (0, 0.5 + 1.1 * level)
        world.add(Body(DISC, place, mass=1 + level, restitution=math.sqrt(restitution)))
    world.set_restitution(0, 1, restitution)
    for _ in range(600):
        pull(world, 1)
        world.step(DT)
    for _ in range(5):
        pull(world, 1)
        hits = np.sort(world.step(DT), order=["a", "b"])
        assert hits[["a", "b"]].tolist() == [(index, index + 1) for index in range(6)]
        assert abs(world.velocities).max() < 1e-12
    assert world.positions[1:, 1] == pytest.approx(np.arange(6) + 0.5, abs=1e-11)
    assert len(world.step(1.0)) == 0
    assert world.capped == 0


@pytest.mark.parametrize("continuous", [True, False])
def test_only_what_is_slow_and_loses_speed_rests(continuous: bool) -> None:
    """The speed of approach decides, not how fast two bodies are; e = 1 bounces at any speed."""
    world = World(rest_speed=0.5, continuous=continuous)
    for row, (speed, restitution) in enumerate([(0.5, 0.9), (0.51, 0.9), (0.1, 1.0)]):
        world.add(Body(DISC, (0, 3 * row), (8 + speed, 3), 1, restitution))
        world.add(Body(DISC, (1.001, 3 * row), (8, 3), 1, 1))
    world.step(0.1)
    parting = world.velocities[1::2, 0] - world.velocities[::2, 0]
    assert parting == pytest.approx([0, 0.9 * 0.51, 0.1], abs=1e-14)


def test_bodies_that_lose_nothing_never_rest() -> None:
    """With e = 1 the bits are the same whatever `rest_speed` is."""
    rng = np.random.default_rng(3)
    discs = [
        Body(Particle(0.3), place, rng.normal(size=2), 1)
        for place in rng.permutation([(x + 0.5, y + 0.5) for x in range(6) for y in range(6)])
    ]
    worlds = [World([*room(6, 6), *discs], rest_speed=speed) for speed in (0.0, 9.0)]
    hits = [world.step(3.0) for world in worlds]
    assert len(hits[0]) > 100
    assert hits[0].tobytes() == hits[1].tobytes()
    assert worlds[0].positions.tobytes() == worlds[1].positions.tobytes()


def test_copies_have_the_same_rest_speed() -> None:
    """A pickle and a batch take it along; a snapshot is for a world that has it, too."""
    bodies = [FLOOR, Body(DISC, (0, 0.7), (0, -1), 1, 0.5)]
    world = World(bodies, rest_speed=1.0)
    batch = WorldBatch(world, 2)
    for twin in (pickle.loads(pickle.dumps(world)), batch[1]):
        twin.step(1.0)
        assert twin.velocities[1].tolist() == [0, 0]
    other = World(bodies)
    with pytest.raises(ValueError, match="rest_speed"):
        other.restore(world.snapshot())
    other.step(1.0)
    assert other.velocities[1].tolist() == [0, 0.5]
