"""Bodies that meet at the same time: one answer, whatever their order."""

import math
from itertools import permutations
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from arkanoid.physics import AxisAlignedRectangle, Body, HalfPlane, Particle, World
from arkanoid.physics.world.memory import setup
from helpers.bodies import DISC, FLOOR
from hypothesis import given, settings
from hypothesis import strategies as st

Array = npt.NDArray[np.float64]
BOX = AxisAlignedRectangle(1, 1)


def stepped(bodies: list[Body], order: Any, dt: float, fixed: int = 0) -> tuple[Array, int]:
    """Add bodies to a world in an order and step it; return their velocities, and the hits.

    Velocities are in the order of the list. The first ``fixed`` bodies stay the first ones.
    """
    places = [*range(fixed), *(fixed + index for index in order)]
    world = World(bodies[index] for index in places)
    hits = world.step(dt)
    velocities = np.empty((len(bodies), 2))
    velocities[places] = world.velocities
    return velocities, len(hits)


@pytest.mark.parametrize("order", list(permutations(range(3))))
@pytest.mark.parametrize("distance", [3.0, 300.0])
def test_a_ball_breaks_two_as_the_mirror_says(order: Any, distance: float) -> None:
    """One was hit before the other, by the order of the bodies: the ball left with (-1/8, 0.217).

    It meets both along normals at 30 degrees to its way. Each gets the speed u along its normal;
    momentum and energy give u = 4 cos(30) / 5.
    """
    bodies = [Body(DISC, (-distance, 0), (1, 0), 1), Body(DISC, (0, 0.5), mass=1)]
    bodies.append(Body(DISC, (0, -0.5), mass=1))
    velocities, hits = stepped(bodies, order, distance + 5)
    height = 0.4 * math.sqrt(0.75)
    expected = [[-0.2, 0], [0.6, height], [0.6, -height]]
    assert hits == 2
    assert velocities == pytest.approx(np.array(expected), abs=1e-13)


def rack() -> list[Body]:
    """Return a ball that flies towards fifteen, which touch each other in a triangle."""
    bodies = [Body(DISC, (-3, 0), (1, 0), 1)]
    for row in range(5):
        bodies += [
            Body(DISC, (row * math.sqrt(0.75), place - row / 2), mass=1) for place in range(row + 1)
        ]
    return bodies


@settings(max_examples=25, deadline=None)
@given(st.permutations(range(16)), st.sampled_from([1.0, 0.9, 0.0]))
def test_a_rack_breaks_as_the_mirror_says(order: list[int], restitution: float) -> None:
    bodies = rack()
    for body in bodies:
        body.restitution = math.sqrt(restitution)
    velocities, _ = stepped(bodies, order, 2.5)
    expected, _ = stepped(bodies, range(16), 2.5)
    places = np.array([body.position for body in bodies])
    mirrored = [int(np.hypot(*(places - place * (1, -1)).T).argmin()) for place in places]
    assert velocities == pytest.approx(velocities[mirrored] * (1, -1), abs=1e-13)
    assert velocities == pytest.approx(expected, abs=1e-13)
    assert velocities.sum(axis=0) == pytest.approx([1, 0], abs=1e-13)
    energy = (velocities**2).sum()
    assert energy == pytest.approx(1, abs=1e-13) if restitution == 1 else energy < 1


@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.0])
def test_a_box_lands_on_two_boxes(restitution: float) -> None:
    """In every order: first on both, then these on the floor, then they on it."""
    e = restitution
    bodies = [FLOOR, Body(BOX, (0, 3.5), (0, -1), 1)]
    bodies += [Body(BOX, (x, 0.5), mass=1) for x in (-0.6, 0.6)]
    for body in bodies[1:]:
        body.restitution = e
    for order in permutations(range(3)):
        velocities, _ = stepped(bodies, order, 2.5, fixed=1)
        assert velocities[:, 0].tolist() == [0, 0, 0, 0]
        assert velocities[2, 1] == pytest.approx(velocities[3, 1], abs=1e-14)
        if e == 1:
            # -1 and 0, 0; 1/3 and -2/3; 1/3 and 2/3 after the floor; 7/9 and 4/9.
            assert velocities[1:, 1] == pytest.approx([7 / 9, 4 / 9, 4 / 9], abs=1e-14)
        if e == 0:
            assert velocities.tolist() == [[0, 0]] * 4


@pytest.mark.parametrize("angle", [0.3, 0.8, 1.2, math.pi / 2])
@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.0])
def test_a_disc_in_a_wedge_turns_back(angle: float, restitution: float) -> None:
    """Along the middle of two walls: whichever wall was first turned it aside."""
    walls = [Body(HalfPlane((side * math.cos(angle / 2), math.sin(angle / 2)))) for side in (1, -1)]
    disc = Body(Particle(0.25), (0, 2), (0, -1), 2, restitution)
    velocities, hits = stepped([*walls, disc], [0], 3.0, fixed=2)
    assert hits == 2
    assert velocities[2] == pytest.approx([0, restitution], abs=1e-13)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 6), st.sampled_from([0.0, 0.5, 1.0]))
def test_a_simultaneous_bounce_obeys_its_laws(seed: int, count: int, restitution: float) -> None:
    """Discs lie around a ball's end and touch nothing else; it hits all of them at once.

    Each recedes at e times the speed of its approach, or faster, and then has no impulse. This
    system of inequalities has one answer for the velocities.
    """
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(-1.4, 1.4, count))
    radius = min(0.2 * np.diff(angles).min(), 0.4)  # so they are apart
    target = Particle(radius)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    masses = rng.uniform(0.2, 5, count)
    bodies = [Body(DISC, (-2, 0), (1, 0), 1, restitution)]
    bodies += [
        Body(target, (0.5 + radius) * normal, mass=float(mass))
        for normal, mass in zip(normals, masses, strict=True)
    ]
    world = World(bodies)
    hits = world.step(2.0 + 1e-9)
    impulses = np.zeros(count)
    impulses[hits["b"] - 1] = -hits["impulse"]
    assert len(np.unique(hits["time"])) == 1
    velocities = world.velocities
    assert velocities[1:] == pytest.approx((impulses / masses)[:, None] * normals, abs=1e-13)
    recede = ((velocities[1:] - velocities[0]) * normals).sum(axis=1)
    more = recede - restitution * normals[:, 0]
    assert more.min() > -1e-13
    assert (impulses * more) == pytest.approx(np.zeros(count), abs=1e-13)
    before, after = 1.0, velocities[0] @ velocities[0] + masses @ (velocities[1:] ** 2).sum(axis=1)
    assert after <= before + 1e-13
    if restitution == 1:
        assert after == pytest.approx(before, abs=1e-13)


@pytest.mark.parametrize("restitution", [0.0, 1.0])
@pytest.mark.parametrize("seed", range(6))
def test_what_meets_at_once_is_the_same_whoever_planned_it(
    seed: int, restitution: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The broad phase, and a restore, changed the order in which a group was resolved.

    Which of two bodies plans that they meet depends on their plans before.
    """
    rng = np.random.default_rng(seed)
    bodies = [Body(FLOOR.collider, restitution=restitution)]
    for index in range(30):
        shape = DISC if rng.random() < 0.5 else BOX
        place = (index % 6 * 1.0, index // 6 + 0.5 + seed % 3 * 0.1)
        velocity = (rng.choice([-1, 0, 1]), rng.choice([-1, 0, -2]))
        bodies.append(Body(shape, place, velocity, 1, restitution))
    bodies.append(Body(Particle(0.5), (-5, 0.5), (3, 0), 2, restitution))
    followed, restored = World(bodies), World(bodies)
    hits = [followed.step(0.25) for _ in range(8)]
    monkeypatch.setattr(setup, "have_bounds", lambda shapes: np.zeros(len(shapes), bool))
    tested = World(bodies)
    expected = np.concatenate([tested.step(0.25) for _ in range(8)])
    monkeypatch.undo()
    again = []
    for _ in range(8):
        again.append(restored.step(0.25))
        restored.restore(restored.snapshot())
    assert len(expected) > 30
    assert np.concatenate(hits).tobytes() == expected.tobytes()
    assert np.concatenate(again).tobytes() == expected.tobytes()


def test_a_ball_in_a_corner_bounces_off_each_wall_to_the_bit() -> None:
    """The two hits at one time were one system, whose solution rounded 1000/3 in its last digit."""
    velocity = np.array([1000.0 / 3.0, 200.0])
    for corner in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        walls = [
            Body(HalfPlane((-corner[0], 0)), (corner[0] * 2, 0)),
            Body(HalfPlane((0, -corner[1])), (0, corner[1] * 2)),
        ]
        place = np.multiply(corner, 1.5 - velocity)
        world = World([*walls, Body(Particle(0.5), place, corner * velocity, mass=1)])
        assert len(world.step(2.0)) == 2
        assert world.velocities[-1].tolist() == (-(corner * velocity)).tolist()
