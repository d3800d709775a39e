"""Batches of worlds, and determinism: the same bits in any batch, on any threads, interpreted."""

import hashlib
import math
import warnings
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
    HitLimitWarning,
    Particle,
    Rectangle,
    World,
    WorldBatch,
)
from helpers.processes import INTERPRETED, run_python
from helpers.repository import TESTS

# All angles are quarter turns: other cosines depend on the platform.
SHAPES: tuple[Collider, ...] = (
    Particle(0.3),
    AxisAlignedRectangle(0.6, 0.4),
    Rectangle(0.5, 0.3, math.pi / 2),
    Convex([(-0.3, -0.2), (0.4, 0), (-0.2, 0.4)]),
    Particle(0.15),
)


def make_world(continuous: bool = True, max_hits: int = 1000) -> World:
    """Return a room with bodies of every kind."""
    world = World(continuous=continuous, max_hits=max_hits)
    world.add(Body(HalfPlane((8, 1)), (0, 0)))
    world.add(Body(AxisAlignedHalfPlane("-x"), (9, 0)))
    world.add(Body(AxisAlignedHalfPlane("+y"), restitution=0.9))
    world.add(Body(AxisAlignedHalfPlane("-y"), (0, 7)))
    for x in range(8):  # bricks
        world.add(Body(AxisAlignedRectangle(1, 0.5), (1 + x, 6)), category=2)
    world.add(Body(Convex([(0, 0), (1, 0.2), (0.4, 1)]), (6, 3)))
    world.add(Body(Convex([(0, 0), (9, 0), (9, 9), (0, 9)], open_edges=[1, 2]), (8, 6.2)))
    world.add(Body(AxisAlignedRectangle(2, 0.25), (4, 0.5), (0.4, 0)))  # a paddle
    world.add(Body(AxisAlignedRectangle(3, 3), (3, 3)), sensor=True)
    world.add(Body(Particle(1), (6, 4), (-0.25, 0.125)), sensor=True, mask=~8)
    for index in range(11):
        place = (1.6 + index % 4 * 1.6, 1.4 + index // 4 * 1.5)
        speed = (1.5 - index * 0.3, 0.7 + index * 0.21)
        body = Body(SHAPES[index % 5], place, speed, 0.5 + index % 3, 1 - index % 2 * 0.1)
        world.add(body, category=4 if index % 4 else 12)
    world.add(Body(Rectangle(5, 0.25, math.pi / 2), (0.7, 3), (0.1, -0.2), mass=20))  # roams
    world.set_restitution(2, 18, 1.25)
    return world


def first_mover(world: World) -> int:
    return len(world) - 12


# Each world is as it would be alone.


@pytest.mark.parametrize("continuous", [True, False])
@pytest.mark.parametrize(
    ("size", "threads"), [(1, 1), (1, 3), (7, 1), (7, 2), (7, 3), (64, 1), (64, 3)]
)
def test_each_world_is_as_it_would_be_alone(size: int, threads: int, continuous: bool) -> None:
    original = make_world(continuous)
    original.step(0.25)
    batch = WorldBatch(original, size, threads=threads)
    alone = []
    ball = first_mover(original) + 3
    moving = batch.handles[0]
    slot = moving.tolist().index(ball)
    for number in range(size):
        single = make_world(continuous)
        single.step(0.25)
        speed = (math.sin(number), 1 + number / 8)
        single.place(ball, velocity=speed)
        batch.velocities[number, slot] = speed
        if number % 3 == 1:
            single.place(ball, (3 + number / 64, 4.6))
            batch.positions[number, slot] = (3 + number / 64, 4.6)
        alone.append(single)
    for steps in (1, 4, 2):
        hits = batch.step(0.3, steps)
        expected = [single.step(0.3, steps) for single in alone]
        for number, own in enumerate(expected):
            own["world"] = number
        assert hits.tobytes() == np.concatenate(expected).tobytes()
    for number, single in enumerate(alone):
        assert batch.positions[number].tobytes() == single.positions[moving].tobytes()
        assert batch.velocities[number].tobytes() == single.velocities[moving].tobytes()
        assert batch.times[number] == single.time
        assert batch.capped[number] == single.capped
    assert len({hits[hits["world"] == number].tobytes() for number in range(size)}) == size
    batch.close()


def test_views_are_live_and_static_bodies_are_not_in_them() -> None:
    floor = Body(AxisAlignedHalfPlane("+y"))
    world = World([floor, Body(Particle(0.5), (0, 2), (0, -1), mass=1), floor])
    world.add(Body(Particle(0.5), (5, 5), (1, 0)))
    batch = WorldBatch(world, 3)
    positions, velocities = batch.positions, batch.velocities
    assert len(batch) == 3
    assert batch.handles.tolist() == [[1, 3]] * 3
    assert positions.shape == velocities.shape == (3, 2, 2)
    positions[1, 0] = (0, 10)
    velocities[2] = 0
    hits = batch.step(2.0)
    assert hits[["world", "a", "b"]].tolist() == [(0, 0, 1)]
    assert hits["time"].tolist() == [1.5]
    assert positions[:, 0].tolist() == [[0, 1], [0, 8], [0, 2]]
    assert positions[:, 1].tolist() == [[7, 5], [7, 5], [5, 5]]
    assert velocities[:, 0, 1].tolist() == [1, -1, 0]
    assert batch.times.tolist() == [2, 2, 2]


def test_a_batch_and_its_world_are_independent() -> None:
    world, control = make_world(), make_world()
    batch = WorldBatch(world, 2)
    batch.step(1.0)
    assert world.time == 0
    assert world.step(0.5).tobytes() == control.step(0.5).tobytes()
    late = WorldBatch(world, 2)
    assert late.times.tolist() == [0.5, 0.5]
    world.add(Body(Particle(0.1), (4, 4)))
    world.step(0.5)
    control.step(0.5, steps=2)
    late.step(0.5, steps=2)
    assert late.positions[0].tobytes() == control.positions[late.handles[0]].tobytes()


@pytest.mark.parametrize("threads", [1, 3])
def test_one_world_may_have_many_hits(threads: int) -> None:
    """The room for hits grows in the middle of a batch, in the middle of a step, several times."""
    world = World([Body(AxisAlignedHalfPlane("+x")), Body(AxisAlignedHalfPlane("-x"), (2, 0))])
    world.add(Body(AxisAlignedRectangle(0.5, 1), (1, 0)), sensor=True)
    world.add(Body(Particle(0.5), (1, 0), (1, 0), mass=1))
    batch = WorldBatch(world, 5, threads=threads)
    batch.velocities[2, 0, 0] = 500.0
    batch.velocities[4, 0, 0] = 0.0
    hits = batch.step(1.0, steps=2)
    counts = np.bincount(hits["world"], minlength=5)
    for number, speed in enumerate((1, 1, 500, 1, 0)):
        single = World(world.body(index) for index in (0, 1))
        single.add(world.body(2), sensor=True)
        single.add(Body(Particle(0.5), (1, 0), (speed, 0), mass=1))
        own = single.step(1.0, steps=2)
        own["world"] = number
        assert hits[hits["world"] == number].tobytes() == own.tobytes()
        assert counts[number] == len(own)
    assert counts[2] == 1000 + 1
    assert (np.diff(hits["world"]) >= 0).all()
    batch.close()


@pytest.mark.parametrize("threads", [1, 2])
def test_a_batch_goes_back_to_its_snapshot(threads: int) -> None:
    batch = WorldBatch(make_world(), 4, threads=threads)
    batch.velocities[:, 2] += np.arange(4)[:, None] / 4
    batch.step(0.5)
    kept, places = batch.snapshot(), batch.positions.copy()
    first = batch.step(0.5, steps=3)
    batch.restore(kept)
    assert batch.positions.tobytes() == places.tobytes()
    assert batch.times.tolist() == [0.5] * 4
    assert batch.step(0.5, steps=3).tobytes() == first.tobytes()
    after = batch.snapshot()
    for wrong in (kept[:-3], b"", WorldBatch(make_world(), 3).snapshot()):
        with pytest.raises(ValueError, match="snapshot"):
            batch.restore(wrong)
    assert batch.snapshot() == after
    batch.close()


def test_closing_ends_the_threads_and_may_be_done_twice() -> None:
    for threads in (1, 3):
        batch = WorldBatch(make_world(), 4, threads=threads)
        batch.step(0.1)
        batch.close()
        batch.close()
        assert batch.positions.shape[0] == 4
    with pytest.raises(RuntimeError, match="shutdown"):
        batch.step(0.1)


@pytest.mark.parametrize("threads", [1, 3])
def test_a_number_that_is_not_finite_is_an_error_and_can_be_corrected(threads: int) -> None:
    """When the first part raised at once, the other threads continued after the call had ended."""
    batch = WorldBatch(make_world(), 6, threads=threads)
    batch.step(0.25)
    before = batch.positions.copy()
    batch.positions[0, 4, 1] = math.nan
    with pytest.raises(ValueError, match="not finite"):
        batch.step(0.25, steps=2000)
    if threads > 1:
        assert batch.times[2:].tolist() == [0.25 * 2001] * 4
    assert batch.times[0] == 0.25
    batch.positions[0] = before[0]
    assert len(batch.step(0.25)) > 0
    assert np.isfinite(batch.positions).all()
    batch.close()


# Compiled or interpreted, now or later.


def digest() -> str:
    """Return a hash of all numbers of a long run in which everything happens."""
    total = hashlib.sha256()

    def note(*numbers: Any) -> None:
        for values in numbers:
            total.update(np.ascontiguousarray(values).astype("<f8").tobytes())

    kinds: list[int] = []
    for continuous in (True, False):
        world = make_world(continuous, max_hits=10)
        for number in range(9):
            if number == 3:
                world.place(first_mover(world), (3, 6), (90, -300))  # into the bricks, and too fast
            if number == 5:
                kept = world.snapshot()
            if number == 7:
                world.restore(kept)
                world.set_restitution(3, 20, 0.0)
                world.remove(7)
            hits = world.step(0.2, steps=1 + number % 2)
            kinds += hits["kind"].tolist()
            for name in ("kind", "time", "a", "b", "normal", "point", "impulse"):
                note(hits[name])
            note(world.positions, world.velocities, world.time, world.capped)
            note(world.query_point((3, 3)), world.query_box((2, 2), (5, 5)))
            ray = world.query_ray((4.5, 1.5), (8, 7), 0.125)
            note(*(ray or ()))
        assert continuous == (world.capped > 0)
    assert {kinds.count(kind) > 10 for kind in (HIT, BEGIN, END)} == {True}
    return total.hexdigest()


def quiet_digest() -> str:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HitLimitWarning)
        return digest()


# The hash of this run. If it changes although no result should change, something is wrong.
GOLDEN = "4dce4046ade4a87bb40fe73d11d5db1787ae51fe80d5e79b3a0b1acb912dd84d"


def test_the_golden_hash() -> None:
    assert quiet_digest() == GOLDEN


def test_interpreted_and_compiled_give_the_same_bits() -> None:
    changes = INTERPRETED | {"PYTHONPATH": str(TESTS)}
    assert run_python(__file__, changes=changes).stdout.strip() == quiet_digest()


if __name__ == "__main__":
    print(quiet_digest())
