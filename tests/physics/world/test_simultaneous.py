"""What happens at one time: in the order of the bodies, and what bounces before what is noticed."""

import itertools

import numpy as np
import pytest
from arkanoid.physics import BEGIN, END, HIT, AxisAlignedRectangle, Body, Particle, Rectangle, World
from helpers.bodies import DISC


@pytest.mark.parametrize("count", [3, 20])
def test_a_sensor_that_is_put_about_bodies_notices_them_in_order(count: int) -> None:
    """It began in the order of its list, which depends on history; after a restore in another."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        places = rng.uniform(-3, 3, (count, 2))
        shapes = [Particle(0.1), AxisAlignedRectangle(0.1, 0.1), Rectangle(0.1, 0.1, 1.0)]
        bodies = zip(itertools.cycle(shapes), places, strict=False)
        world = World([Body(shape, place, (0.1, 0), 1) for shape, place in bodies])
        for handle in rng.permutation(count).tolist():
            world.place(handle, places[rng.integers(count)] + 9)
            world.step(0.01)
            world.place(handle, places[handle])
        world.step(0.01)
        area = world.add(Body(AxisAlignedRectangle(9, 9), (0, 0), (0, 0.1)), sensor=True)
        before = world.snapshot()
        begins = world.step(0.0)
        begins = begins[begins["kind"] == BEGIN]
        assert begins[["a", "b"]].tolist() == [(handle, area) for handle in range(count)]
        world.restore(before)
        again = world.step(0.0)
        assert again[again["kind"] == BEGIN].tobytes() == begins.tobytes()


def test_what_a_wall_turns_away_does_not_enter_the_sensor_behind_its_face() -> None:
    """Whether it entered for no time at all depended on the order of the bodies."""
    wall = Body(AxisAlignedRectangle(1, 4), (3, 0))
    for order, drift in itertools.product(itertools.permutations(range(3)), (0.0, -0.5)):
        area = Body(AxisAlignedRectangle(1, 2), (3 + drift, 0), (-drift, 0))
        bodies = [(wall, False), (area, True), (Body(Particle(0.5), (0, 0), (2, 0), 1), False)]
        world = World()
        for index in order:
            world.add(bodies[index][0], sensor=bodies[index][1])
        ball = order.index(2)
        hits = world.step(1.5)
        hits = hits[(hits["a"] == ball) | (hits["b"] == ball)]
        assert hits["kind"].tolist() == [HIT]
        deeper = world.add(Body(AxisAlignedRectangle(1, 2), (2.5, 0)), sensor=True)
        world.place(ball, (0, 0), (2, 0))
        hits = world.step(1.5)
        hits = hits[(hits["a"] == deeper) | (hits["b"] == deeper) | (hits["kind"] == HIT)]
        assert hits["kind"].tolist() == [BEGIN, HIT, END]


def test_relaxation_does_not_depend_on_what_happens_elsewhere() -> None:
    """Two that overlap and fly apart were only moved apart if any two others touched."""
    pair = [Body(DISC, (0, 0), (-1, 0), 1), Body(DISC, (0.5, 0), (1, 0), 1)]
    others = [Body(DISC, (9, 0), (0, 0), 1), Body(DISC, (10, 0), (-1, 0), 1)]
    alone, among = World(pair), World([*pair, *others])
    alone.step(0.5)
    among.step(0.5)
    assert alone.positions.tolist() == [[-0.75, 0], [1.25, 0]]
    assert among.positions[:2].tolist() == alone.positions.tolist()
