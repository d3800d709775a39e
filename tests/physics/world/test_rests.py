"""Bodies that rest on each other: piles, presses and what has no room."""

import math
import warnings

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    HalfPlane,
    HitLimitWarning,
    Particle,
    Rectangle,
    World,
)
from helpers.bodies import DISC, FLOOR, bodies_of, deepest_overlap, room

BOX = AxisAlignedRectangle(1, 1)


def pull(world: World, first: int, speed: float = 0.1) -> None:
    """Let the bodies from the first one on fall by so much faster."""
    for index, velocity in enumerate(world.velocities[first:], first):
        world.place(index, velocity=velocity - (0, speed))


def test_two_crates_come_to_rest_on_a_floor() -> None:
    """They passed half of their speed to each other 10 000 times in every step, to no end."""
    crates = [Body(BOX, (0, y), (0, -1), 1, 0) for y in (1.5, 2.5)]
    world = World([FLOOR, *crates])
    hits = world.step(2.0)
    assert hits[["a", "b"]].tolist() == [(0, 1), (1, 2)]
    assert hits["time"].tolist() == [1, 1]
    assert hits["impulse"].tolist() == [-2, -1]
    for _ in range(3):  # nobody has written to them
        assert len(world.step(1.0)) == 0
    assert world.positions[1:].tolist() == [[0, 0.5], [0, 1.5]]
    assert world.velocities.tolist() == [[0, 0]] * 3
    assert world.capped == 0


@pytest.mark.parametrize("masses", [[1] * 10, [1] * 9 + [100], [100] + [1] * 9, [1, 100] * 5])
@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_a_pile_of_ten_rests(masses: list[float], slope: float) -> None:
    """Each carries the weight of those above, so the impulses are known; on a slope all slide."""
    normal = np.array([-math.sin(slope), math.cos(slope)])
    box = Rectangle(1, 1, slope)
    world = World([Body(HalfPlane(normal))])
    for index, mass in enumerate(masses):
        world.add(Body(box, (index + 0.5) * normal, mass=mass, restitution=0))
    weights = 0.1 * math.cos(slope) * np.cumsum(masses[::-1])[::-1]
    for _ in range(40):
        pull(world, 1)
        hits = np.sort(world.step(0.05), order=["a", "b"])
        assert hits[["a", "b"]].tolist() == [(index, index + 1) for index in range(10)]
        assert -hits["impulse"] == pytest.approx(weights, rel=1e-11)
    heights = world.positions[1:] @ normal
    assert heights == pytest.approx(np.arange(10) + 0.5, abs=1e-11)
    assert world.velocities[1:] @ normal == pytest.approx(np.zeros(10), abs=1e-12)
    assert world.capped == 0


def test_six_stacked_boxes_do_not_sink() -> None:
    """They overlapped by 0.011 as they fell onto each other, because hits ran out."""
    boxes = [Body(BOX, (0, 1.05 * y + 0.55), mass=1, restitution=0) for y in range(6)]
    world = World([FLOOR, *boxes])
    for _ in range(60):
        pull(world, 1, 0.16)
        assert len(world.step(1 / 60)) <= 21
        assert deepest_overlap(bodies_of(world)) == 0.0
    assert world.positions[1:, 1] == pytest.approx(np.arange(6) + 0.5, abs=1e-12)
    assert world.capped == 0


@pytest.mark.parametrize("rows", [3, 8])
def test_a_pyramid_rests(rows: int) -> None:
    """Every box lies on two. Nothing says how they share its weight, but none may move."""
    world = World([FLOOR])
    for row in range(rows):
        for place in range(rows - row):
            world.add(Body(BOX, (place + 0.5 * row, row + 0.5), mass=1, restitution=0))
    before = world.positions
    for _ in range(30):
        pull(world, 1)
        hits = world.step(0.05)
        assert len(hits) <= rows * rows
        assert -hits[hits["a"] == 0]["impulse"].sum() == pytest.approx(0.1 * (len(world) - 1))
    assert world.positions == pytest.approx(before, abs=1e-12)
    assert world.capped == 0


def test_a_ball_bounces_off_a_pile_as_off_the_floor() -> None:
    """The crates rest, so they cannot give way: the ball keeps its speed, not only a part of it."""
    crates = [Body(BOX, (0, y + 0.5), mass=1, restitution=0) for y in range(3)]
    world = World([FLOOR, *crates, Body(DISC, (0, 5), (0, -1), 5)])
    for index in (1, 2, 3):
        world.set_restitution(index, 4, 0.5)
    hits = world.step(2.0)
    assert hits["time"] == pytest.approx([1.5] * 4)
    assert hits["impulse"] == pytest.approx([-7.5] * 4)
    assert world.velocities[:4].tolist() == [[0, 0]] * 4
    assert world.velocities[4] == pytest.approx([0, 0.5], abs=1e-14)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("seed", range(3))
def test_crates_that_fall_come_to_rest(seed: int, restitution: float) -> None:
    """Twelve in three towers: bounded hits, no energy gained, and no sinking that stays."""
    rng = np.random.default_rng(seed)
    masses = rng.uniform(0.5, 2, 12)
    world = World([FLOOR])
    for index, mass in enumerate(masses):
        place = (index % 3 * 1.05 + rng.uniform(-0.3, 0.3), index // 3 * 1.5 + 2)
        world.add(Body(BOX, place, mass=float(mass), restitution=restitution))
    counts = []
    for _ in range(120):
        pull(world, 1, 0.16)
        before = masses @ (world.velocities[1:] ** 2).sum(axis=1)
        counts.append(len(world.step(0.016)))
        after = masses @ (world.velocities[1:] ** 2).sum(axis=1)
        assert after <= before * (1 + 1e-12)
        # What slides sinks in by a hundredth of its size at most, until the next step.
        assert deepest_overlap(bodies_of(world)) < 0.01
    assert max(counts) < 2000
    if restitution == 0:
        assert max(counts) < 60
        assert world.velocities.tolist() == [[0, 0]] * 13
        assert deepest_overlap(bodies_of(world)) < 1e-12
    assert world.positions[1:, 1].min() > 0.5 - 1e-3


def test_inelastic_discs_settle_in_a_box() -> None:
    """As they slide the directions turn, and they hit each other sooner and sooner."""
    rng = np.random.default_rng(0)
    world = World(room(6, 20))
    for index in range(30):
        place = (0.6 + index % 5 * 1.1 + rng.uniform(-0.05, 0.05), 1 + index // 5 * 1.2)
        world.add(Body(DISC, place, mass=1, restitution=0))
    for _ in range(200):
        pull(world, 4, 0.16)
        before = (world.velocities**2).sum()
        assert len(world.step(0.016)) < 1000
        assert (world.velocities**2).sum() <= before * (1 + 1e-12)
        assert deepest_overlap(bodies_of(world)) < 0.01
    assert world.capped == 0


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_a_wall_presses_discs_together(restitution: float) -> None:
    """There is room for all, so none is pushed out; they give way to the sides."""
    world = World([*room(30, 5), Body(AxisAlignedRectangle(1, 20), (12, 0), (-1, 0))])
    rng = np.random.default_rng(1)
    for index in range(20):
        place = (1 + index // 4 * 2 + rng.uniform(-0.3, 0.3), 0.6 + index % 4 * 1.1)
        world.add(Body(DISC, place, rng.normal(size=2) * 0.1, 1, restitution))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HitLimitWarning)
        for _ in range(62):
            assert len(world.step(0.1)) < 20_000
            assert deepest_overlap(bodies_of(world)) < 0.01
    assert world.positions[5:, 0].max() < world.positions[4, 0] - 0.99
    if restitution == 0:
        assert world.capped == 0
        assert abs(world.velocities[5:]).max() < 2


def test_boxes_in_a_closing_vice_are_crushed() -> None:
    """Between two walls there is room for two boxes, then for less: no hit can help.

    The impulse would be infinite. So the wall moves into them until the step ends, and a warning
    says it.
    """
    world = World([Body(AxisAlignedHalfPlane("-x"), (3, 0))])
    wall = world.add(Body(AxisAlignedRectangle(1, 4), (-3, 0), (1, 0)))
    boxes = [world.add(Body(BOX, (x, 0), mass=1, restitution=0)) for x in (0, 1.2)]
    hits = world.step(3.25)
    assert hits[["a", "b"]].tolist() == [(1, 2), (2, 3), (1, 2)]
    assert world.positions[boxes, 0] == pytest.approx([1.25, 2.25], abs=1e-14)
    with pytest.warns(HitLimitWarning, match="no room"):
        hits = world.step(0.5)
    assert len(hits) <= 3
    assert world.capped == 2
    assert abs(world.velocities[boxes]).max() <= 1
    assert world.positions[wall].tolist() == [0.75, 0]
    assert deepest_overlap(bodies_of(world)) <= 0.25 + 1e-12
    world.place(wall, (-9, 0), (0, 0))
    world.place(boxes[0], velocity=(0, 0))
    world.place(boxes[1], velocity=(0, 0))
    world.step(1.0)
    assert deepest_overlap(bodies_of(world)) < 1e-9


def test_what_slides_still_meets_walls() -> None:
    """A disc comes to rest on one wall after another in one long step, and passes through none."""
    count = 40
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False) + 0.1
    walls = [Body(HalfPlane((-math.cos(a), -math.sin(a)), -5)) for a in angles]
    world = World([*walls, Body(Particle(0.5), (0, 0), (1, 0.2), 1, restitution=0)])
    world.step(100.0)
    assert deepest_overlap(bodies_of(world)) < 0.01
    assert np.hypot(*world.positions[-1]) < 4.6


@pytest.mark.parametrize("max_hits", [1, 2, 5, 1000])
def test_however_few_hits_nothing_tunnels(max_hits: int) -> None:
    """Fast discs among boxes, all inelastic or not: none leaves the room."""
    rng = np.random.default_rng(max_hits)
    world = World(room(10, 8), max_hits=max_hits)
    for index in range(6):
        world.add(Body(BOX, (1.5 + index * 1.4, 0.5), mass=2, restitution=0.5))
    for index in range(20):
        place = (0.7 + index % 10 * 0.9, 3 + index // 10 * 2)
        world.add(Body(Particle(0.3), place, rng.normal(size=2) * 30, 1, float(index % 3) / 2))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HitLimitWarning)
        for _ in range(10):
            before = (world.velocities[4:10] ** 2).sum() * 2 + (world.velocities[10:] ** 2).sum()
            world.step(0.5)
            after = (world.velocities[4:10] ** 2).sum() * 2 + (world.velocities[10:] ** 2).sum()
            assert after <= before * (1 + 1e-12)
            assert deepest_overlap(bodies_of(world)) < 0.01


def test_light_crates_under_heavy_ones_have_room() -> None:
    """In steps of the solver it is far: after a few too many, these counted as crushed, and sank.

    There are two towers, and in this order of their bodies it takes 140 steps.
    """
    crates = [(0, 0, 0.01), (4, 1, 1), (4, 0, 0.01), (4, 2, 0.01), (0, 1, 100)]  # x, level, mass
    places = [(x, level + 0.5) for x, level, _ in crates]
    bodies = [
        Body(BOX, place, mass=mass, restitution=0)
        for place, (_, _, mass) in zip(places, crates, strict=True)
    ]
    world = World([FLOOR, *bodies])
    weights = [
        sum(mass for x, level, mass in crates if x == there and level >= lowest)
        for there, lowest, _ in crates
    ]
    for _ in range(5):
        pull(world, 1)
        hits = world.step(0.05)
        pushes = {(hit["a"], hit["b"]): -hit["impulse"] for hit in hits}
        on = {(0, 1): 1, (0, 3): 3, (2, 3): 2, (2, 4): 4, (1, 5): 5}  # who each crate is
        assert pushes.keys() == on.keys()
        for pair, body in on.items():
            assert pushes[pair] == pytest.approx(0.1 * weights[body - 1], rel=1e-9)
    assert world.capped == 0
    assert world.positions[1:] == pytest.approx(np.array(places), abs=1e-11)


CORNERS = {
    "half-planes": [Body(HalfPlane((0, 1)), restitution=0), Body(HalfPlane((1, 0)), restitution=0)],
    "a wedge": [
        Body(HalfPlane((0, 1)), restitution=0),
        Body(HalfPlane((0.8, 0.6)), (0.25, 0), restitution=0),
    ],
    "tiles": [
        Body(AxisAlignedRectangle(1, 1), place, restitution=0)
        for place in ((0.5, -0.5), (1.5, -0.5), (-0.5, -0.5), (-0.5, 0.5), (-0.5, 1.5))
    ],
}


@pytest.mark.parametrize("corner", CORNERS)
@pytest.mark.parametrize("mass", [0.01, 1.0, 100.0])
def test_what_lies_in_a_corner_is_pressed_against_both_sides(corner: str, mass: float) -> None:
    """A heavy disc threw a light one to and fro between them, 2000 times at one time.

    Floor and wall counted as one wall with a seam, since it did not slide from the one into the
    other: before the hit it did not move. But the hit drives it there.
    """
    world = World(CORNERS[corner])
    lower = world.add(Body(Particle(0.5), (0.5, 0.5), mass=mass, restitution=0))
    upper = world.add(Body(Particle(0.5), (1.1, 2.3), (0, -8), mass=10, restitution=0))
    hits = world.step(0.2)
    assert world.capped == 0
    assert len(set(hits["time"])) == 1
    sides = [hit["impulse"] * hit["normal"] for hit in hits if hit["a"] != lower]
    (push,) = (hit["impulse"] * hit["normal"] for hit in hits if hit["a"] == lower)
    assert len(sides) == 2
    assert np.sum(sides, axis=0) == pytest.approx(push, rel=1e-12)
    assert world.velocity(lower).tolist() == [0, 0]
    # The heavy one keeps what was along the light one, as if that were fixed.
    assert world.velocity(upper) == pytest.approx([3.84, -2.88], rel=1e-12)
