"""Worlds that live: bodies come, go and change, and all is as in a world that was built so."""

import pickle
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
    NoBodyError,
    Particle,
    World,
    WorldBatch,
)
from arkanoid.physics.world.state.records import Course
from helpers.bodies import DISC, FLOOR, SMALL_SHAPES, room
from hypothesis import given, settings
from hypothesis import strategies as st

SQUARE = AxisAlignedRectangle(2, 2)
ZONE = AxisAlignedRectangle(2.5, 1.5)


def story(hits: Any) -> list[tuple[int, int, int]]:
    return [(int(hit["kind"]), int(hit["a"]), int(hit["b"])) for hit in hits]


# Handles.


def test_handles_count_from_zero_and_are_never_used_twice() -> None:
    world = World([FLOOR, Body(DISC, (1, 2)), Body(DISC, (3, 2))])
    assert world.handles.tolist() == [0, 1, 2]
    world.remove(1)
    assert world.handles.tolist() == [0, 2]
    again = world.add(Body(DISC, (5, 5)))
    assert again == (1 << 32) + 1
    assert again in world
    assert 1 not in world
    assert world.handles.tolist() == [0, again, 2]
    assert world.positions.tolist() == [[0, 0], [5, 5], [3, 2]]
    assert world.body(again).position.tolist() == [5, 5]
    world.remove(again)
    assert world.add(Body(DISC)) == (2 << 32) + 1
    assert world.add(Body(DISC)) == 3


@pytest.mark.parametrize(
    "call",
    [
        lambda w: w.remove(1),
        lambda w: w.body(1),
        lambda w: w.place(1, (0, 0)),
        lambda w: w.change(1, mass=2.0),
        lambda w: w.set_restitution(0, 1, 0.5),
    ],
)
@pytest.mark.parametrize("is_used_again", [False, True])
def test_a_dead_handle_is_an_error_that_says_what_to_do(call: Any, is_used_again: bool) -> None:
    world = World([FLOOR, Body(DISC, (1, 2))])
    world.remove(1)
    if is_used_again:
        world.add(Body(DISC, (4, 4), mass=1))
    kept = world.snapshot()
    with pytest.raises(NoBodyError, match=r"body 1 was removed\. Forget") as caught:
        call(world)
    assert isinstance(caught.value, KeyError)
    assert world.snapshot() == kept


def test_hits_and_queries_name_handles() -> None:
    world = World([FLOOR, FLOOR, Body(DISC, (0, 3), (0, -1), mass=1)])
    world.remove(0)
    floor = world.add(Body(AxisAlignedRectangle(4, 1), (0, 0.5)))
    world.remove(1)
    (hit,) = world.step(2.5)
    assert (hit["a"], hit["b"]) == (floor, 2)
    assert world.query_point((0, 0.5)).tolist() == [floor]
    ray = world.query_ray((-5, 0.5), (5, 0.5))
    assert ray is not None
    assert ray.body == floor
    assert world.query_rays([(-5, 0.5)], [(5, 0.5)]).bodies.tolist() == [floor]


def test_a_world_is_edited_while_its_hits_are_read() -> None:
    """A removal changed the indices that the other hits named."""
    world = World(Body(AxisAlignedRectangle(1, 1), (3 * x, 2)) for x in range(6))
    for x in range(6):
        world.add(Body(Particle(0.25), (3 * x, 0), (0, 1 + x / 8), mass=1))
    hits = world.step(2.0)
    assert len(hits) == 6
    for hit in hits:
        world.remove(int(hit["a"]))
        world.add(Body(AxisAlignedRectangle(1, 1), (0, 99)))
    assert world.handles.tolist() == [*(index | 1 << 32 for index in range(6)), *range(6, 12)]


# Sensors.


@pytest.mark.parametrize("is_static", [False, True])
@pytest.mark.parametrize(
    "edit",
    [
        lambda w, which: w.remove(which),
        lambda w, which: w.place(which, (50, 50)),
        lambda w, which: w.change(which, active=False),
        lambda w, which: w.change(which, mask=0),
        lambda w, which: w.change(which, category=4),
    ],
)
@pytest.mark.parametrize("which", [0, 1])
def test_what_leaves_a_sensor_by_an_edit_ends_there(edit: Any, is_static: bool, which: int) -> None:
    """It was forgotten, without an event."""
    world = World()
    world.add(Body(SQUARE, velocity=(0.125 * is_static, 0)), sensor=True, mask=1)
    world.add(Body(DISC, (0.5, 0), mass=None if is_static else 1), mask=1)
    assert story(world.step(0.5)) == [(BEGIN, 0, 1)]
    edit(world, which)
    hits = world.step(0.5)
    assert story(hits) == [(END, 0, 1)]
    assert hits["time"].tolist() == [0.5]
    assert len(world.step(0.5)) == 0


def test_ends_come_in_the_order_of_bodies() -> None:
    world = World([Body(DISC, (x / 8, 0), mass=1) for x in range(5)])
    for handle in range(5):
        world.change(handle, category=2, mask=1)
    zones = [world.add(Body(SQUARE), sensor=True, mask=2) for _ in range(3)]
    assert len(world.step(0.1)) == 15
    world.remove(3)
    world.remove(zones[1])
    world.remove(0)
    ends = [(END, body, zone) for body in (0, 3) for zone in zones]
    ends += [(END, body, zones[1]) for body in (1, 2, 4)]
    assert story(world.step(0.1)) == sorted(ends, key=lambda end: end[1:])


def test_a_static_body_or_sensor_placed_inside_every_frame_begins_once() -> None:
    for which in (0, 1):
        world = World()
        world.add(Body(ZONE, velocity=(0.01, 0) if which else (0, 0)), sensor=True)
        mass = None if which else 1.0
        world.add(Body(DISC, mass=mass))
        kinds = []
        for frame in range(8):
            world.place(which, (-0.4 + frame / 10, 0))
            kinds += world.step(0.125)["kind"].tolist()
        assert kinds == [BEGIN]


def test_what_is_solid_and_becomes_a_sensor_and_solid_again() -> None:
    world = World([Body(SQUARE), Body(DISC, (-4, 0), (1, 0), mass=1)])
    world.change(0, sensor=True)
    assert story(world.step(3.0)) == [(BEGIN, 0, 1)]
    world.change(0, sensor=False)
    assert story(world.step(0.25)) == [(END, 0, 1), (HIT, 0, 1)]  # it was pushed out
    assert abs(world.positions[1]).max() >= 1.5


# Changes.


def test_a_body_that_is_off_meets_nothing_and_keeps_place_velocity_and_handle() -> None:
    world = World([Body(DISC, (0, 0), (1, 0), mass=1), Body(SQUARE, (5, 0))])
    world.change(0, active=False)
    assert len(world.step(9.0)) == 0
    assert world.positions[0].tolist() == [0, 0]
    assert world.velocities[0].tolist() == [1, 0]
    assert len(world.query_point((0, 0))) == 0
    world.place(0, (1, 0))
    twin = pickle.loads(pickle.dumps(world))
    for each in (world, twin):
        each.change(0, active=True)
        (hit,) = each.step(9.0)
        assert hit["time"] == 9.0 + 2.5


def test_mass_restitution_category_and_mask_can_change() -> None:
    world = World([FLOOR, Body(DISC, (0, 1.5), (0, -1), mass=1)])
    world.change(1, restitution=0.5)
    world.step(2.0)
    assert world.velocities[1].tolist() == [0, 0.5]
    world.place(1, (0, 1.5), (0, -1))
    world.change(0, category=2)
    world.change(1, mask=1)
    assert len(world.step(1.0)) == 0
    world.change(1, mass=None, mask=-1)
    assert world.body(1).mass is None
    assert len(world.step(1.0)) == 0  # kinematic: it flies on
    assert world.velocities[1].tolist() == [0, -1]
    world.place(1, velocity=(0, 0))
    world.change(1, mass=3.0)
    assert world.body(1).mass == 3.0


# Random edits against a world that was built so.


class Double:
    """A world that is edited, and all that is needed to build it anew."""

    def __init__(self, seed: int, continuous: bool) -> None:
        self.rng = np.random.default_rng(seed)
        self.world = World(room(9, 7), continuous=continuous)
        self.continuous = continuous
        self.options: dict[int, dict[str, Any]] = {handle: {} for handle in range(4)}
        self.off: set[int] = set()
        self.pairs: dict[tuple[int, int], float] = {}
        for _ in range(14):
            self.add()

    def some(self) -> int:
        return int(self.rng.choice(self.world.handles[4:]))

    def add(self) -> None:
        rng = self.rng
        options = {"sensor": bool(rng.random() < 0.25), "category": int(rng.integers(1, 4))}
        moves = rng.random() < 0.7
        mass = float(rng.uniform(0.5, 2)) if moves and not options["sensor"] else None
        velocity = rng.normal(size=2) if moves else (0, 0)
        place = rng.uniform((0.5, 0.5), (8.5, 6.5))
        shape = SMALL_SHAPES[int(rng.integers(len(SMALL_SHAPES)))]
        handle = self.world.add(Body(shape, place, velocity, mass, 0.9), **options)
        self.options[handle] = options

    def edit(self) -> None:
        rng, world = self.rng, self.world
        way = int(rng.integers(9))
        handle = self.some()
        if way == 0:
            self.add()
        elif way == 1 and len(world) > 10:
            world.remove(handle)
            self.off.discard(handle)
            self.pairs = {pair: e for pair, e in self.pairs.items() if handle not in pair}
        elif way == 2:
            world.place(handle, rng.uniform((0.5, 0.5), (8.5, 6.5)))
        elif way == 3:
            world.place(handle, velocity=rng.normal(size=2) * float(rng.integers(2)))
        elif way == 4:
            mass = None if rng.random() < 0.4 else float(rng.uniform(0.5, 2))
            world.change(handle, mass=mass, restitution=float(rng.choice([0.5, 0.9])))
        elif way == 5:
            self.options[handle] |= {"category": int(rng.integers(1, 4))}
            self.options[handle] |= {"mask": int(rng.choice([-1, 1, 2]))}
            options = self.options[handle]
            world.change(handle, category=options["category"], mask=options["mask"])
        elif way == 6:
            self.options[handle]["sensor"] = bool(rng.random() < 0.3)
            world.change(handle, sensor=self.options[handle]["sensor"])
        elif way == 7:
            (self.off.discard if handle in self.off else self.off.add)(handle)
            world.change(handle, active=handle not in self.off)
        else:
            other = self.some()
            if other != handle:
                self.pairs[min(handle, other), max(handle, other)] = 0.25
                world.set_restitution(handle, other, 0.25)

    def built_anew(self) -> tuple[World, dict[int, int]]:
        """Return a world with the same bodies now, and the handles that they have there."""
        world = World(continuous=self.continuous)
        names = {}
        for handle in self.world.handles.tolist():
            names[handle] = world.add(self.world.body(handle), **self.options[handle])
        for handle in self.off:
            world.change(names[handle], active=False)
        for (a, b), restitution in self.pairs.items():
            world.set_restitution(names[a], names[b], restitution)
        return world, names


def told(hits: Any, names: dict[int, int] | None = None) -> dict[tuple[int, int, int], list[float]]:
    """Return the times of hits by kind and bodies."""
    found: dict[tuple[int, int, int], list[float]] = {}
    for hit in hits:
        pair = [int(hit["a"]), int(hit["b"])]
        pair = [names[handle] for handle in pair] if names else pair
        found.setdefault((int(hit["kind"]), *sorted(pair)), []).append(float(hit["time"]))
    return found


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.booleans())
@pytest.mark.filterwarnings("ignore::arkanoid.physics.HitLimitWarning")
def test_an_edited_world_is_one_that_was_built_so(seed: int, continuous: bool) -> None:
    """After any edits, and a snapshot of them: the same hits, times and places."""
    double = Double(seed, continuous)
    inside: set[tuple[int, int]] = set()
    for _ in range(6):
        for _ in range(int(double.rng.integers(1, 8))):
            double.edit()
        anew, names = double.built_anew()
        begin = double.world.time
        hits = double.world.step(0.02)
        expected = anew.step(0.02)
        if anew.capped:  # Something has no room: there is no right answer, see the limits.
            return
        solid = hits[hits["kind"] == 0]  # what was inside before does not begin again
        ours, theirs = told(solid, names), told(expected[expected["kind"] == 0])
        assert ours.keys() == theirs.keys()
        for pair, times in ours.items():
            assert np.array(times) - begin == pytest.approx(theirs[pair], abs=1e-12)
        assert double.world.positions == pytest.approx(anew.positions, abs=1e-11)
        assert double.world.velocities == pytest.approx(anew.velocities, abs=1e-10)
        for hit in hits[hits["kind"] != 0]:  # each pair begins and ends in turn
            pair = (int(hit["a"]), int(hit["b"]))
            assert (pair in inside) == (hit["kind"] == END)
            (inside.remove if hit["kind"] == END else inside.add)(pair)
        kept = double.world.snapshot()
        follows = double.world.step(0.3)
        double.world.restore(kept)
        again = double.world.step(0.3)
        assert again.tobytes() == follows.tobytes()
        other = pickle.loads(pickle.dumps(double.world))
        assert other.snapshot() == double.world.snapshot()
        for hit in again[again["kind"] != 0]:
            pair = (int(hit["a"]), int(hit["b"]))
            assert (pair in inside) == (hit["kind"] == END)
            (inside.remove if hit["kind"] == END else inside.add)(pair)


# Batches.


@pytest.mark.parametrize("threads", [1, 3])
def test_the_worlds_of_a_batch_are_edited_alone(threads: int) -> None:
    world = World(room(9, 7))
    for index in range(12):
        world.add(Body(Particle(0.3), (1 + index % 6, 1 + index // 6), (1, index / 8), mass=1))
    world.add(Body(ZONE, (4, 4)), sensor=True)
    batch = WorldBatch(world, 7, threads=threads)
    alone = [pickle.loads(pickle.dumps(world)) for _ in range(7)]
    for turn in range(6):
        for number, single in enumerate(alone):
            for each in (batch[number], single):
                if number % 3 == 0:
                    each.remove(int(each.handles[5]))
                    each.add(Body(AxisAlignedRectangle(0.2 + number / 10, 0.2), (8, 6)))
                    each.place(2, (0.1 * number, -0.1))
                elif number % 3 == 1:
                    each.add(Body(Particle(0.1), (4, 4), (turn, number), mass=1))
        hits = batch.step(0.25)
        for number, single in enumerate(alone):
            expected = single.step(0.25)
            expected["world"] = number
            assert hits[hits["world"] == number].tobytes() == expected.tobytes()
            assert batch[number].positions.tobytes() == single.positions.tobytes()
            rows = batch.handles[number]
            assert set(rows[rows >= 0].tolist()) <= set(single.handles.tolist())
        kept = batch.snapshot()
        first = batch.step(0.5).tobytes()
        batch.restore(kept)
        assert batch.step(0.5).tobytes() == first
        for single in alone:
            single.step(0.5)
    batch.close()


def test_batches_of_edited_worlds_keep_one_world_as_one() -> None:
    batch = WorldBatch(World([FLOOR, Body(DISC, (0, 2), mass=1)]), 2)
    assert batch[1] is batch[-1]
    with pytest.raises(IndexError):
        batch[2]
    with pytest.raises(ValueError, match="part of a batch"):
        batch[0].restore(batch[0].snapshot())
    batch[0].step(1.0)
    assert batch.times.tolist() == [1, 0]
    assert pickle.loads(pickle.dumps(batch[1])).positions.tolist() == [[0, 0], [0, 2]]


# Cost.


def test_edits_make_no_plans_but_those_around() -> None:
    """Each edit built the whole world again."""
    world = World(Body(DISC, (3 * (x % 50), 3 * (x // 50))) for x in range(2000))
    for x in range(200):
        world.add(Body(Particle(0.3), (3 * (x % 50) + 1.5, 3 * (x // 50) + 1.5), (0, 1e-3), 1))
    world.step(0.1)
    workspace = world.site.setup.workspace
    wall = world.add(Body(AxisAlignedHalfPlane("+y"), (0, -9)))
    world.remove(wall)
    world.step(0.0)
    world.place(777, (1.5, 1.5))
    world.place(777, (-7, 99))
    world.change(33, mass=1.0)
    world.change(33, mass=None)
    world.change(34, active=False)
    world.remove(35)
    fresh = world.site.setup.records(world.site.state, "motions", Course)["fresh"]
    assert world.site.setup.workspace is workspace
    assert 1 <= fresh.sum() <= 20
