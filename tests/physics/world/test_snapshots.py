"""Worlds as data: from a snapshot, a pickle or a copy, a world continues bit for bit."""

import copy
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    BEGIN,
    END,
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Particle,
    World,
    WorldBatch,
)
from arkanoid.physics.world.lookup.inside import inside_block
from arkanoid.physics.world.state.records import Course
from helpers.bodies import SMALL_SHAPES, room
from helpers.processes import run_python
from hypothesis import given, settings
from hypothesis import strategies as st

FORGE = Path(__file__).parent / "forge_snapshots.py"


def make_world(seed: int, continuous: bool = True) -> World:
    """Return a room with twelve dynamic bodies, a kinematic one, and two sensors; one moves."""
    rng = np.random.default_rng(seed)
    world = World(
        [
            *room(6, 5),
            Body(AxisAlignedRectangle(1, 0.25), (3, 2.4), (0.1, 0)),
        ],
        continuous=continuous,
    )
    for index in range(12):
        place = (0.8 + index % 4 * 1.4, 0.6 + index // 4 * 1.5)
        world.add(
            Body(SMALL_SHAPES[index % 4], place, rng.normal(size=2) * 2, float(1 + index % 3), 0.9)
        )
    world.add(Body(AxisAlignedRectangle(2, 2), (2, 2)), sensor=True)
    world.add(Body(Particle(1), (4, 3), (-0.1, 0)), sensor=True)
    world.set_restitution(5, 6, 0.5)
    return world


def next_bits(world: World, steps: int = 5) -> list[bytes]:
    """Return all bits of the next steps."""
    bits = []
    for _ in range(steps):
        hits = world.step(0.25)
        bits += [hits.tobytes(), world.positions.tobytes(), world.velocities.tobytes()]
    return [*bits, str((world.time, world.capped)).encode()]


seeds = st.integers(0, 10**6)


@settings(max_examples=25, deadline=None)
@given(seeds, st.integers(0, 12), st.integers(0, 12), st.booleans())
def test_a_restored_world_continues_bit_for_bit(
    seed: int, before: int, between: int, continuous: bool
) -> None:
    world, fresh = make_world(seed, continuous), make_world(seed, continuous)
    for _ in range(before):
        world.step(0.25)
    kept = world.snapshot()
    assert world.snapshot() == kept
    expected = next_bits(world)
    for _ in range(between):
        world.step(0.3)
    for other in (world, fresh):
        other.restore(kept)
        assert other.snapshot() == kept
        assert next_bits(other) == expected


def test_snapshots_hold_which_bodies_are_inside_sensors() -> None:
    world = World()
    world.add(Body(AxisAlignedRectangle(2, 2)), sensor=True)
    world.add(Body(Particle(0.5), (-2, 0), (1, 0), mass=1))
    outside = world.snapshot()
    assert world.step(1.0)["kind"].tolist() == [BEGIN]
    inside = world.snapshot()
    assert world.step(3.0)["kind"].tolist() == [END]
    world.restore(inside)
    assert world.step(3.0)["kind"].tolist() == [END]
    world.restore(outside)
    assert world.step(4.0)["kind"].tolist() == [BEGIN, END]


def test_a_snapshot_after_many_hits_in_one_step() -> None:
    room = [Body(AxisAlignedHalfPlane("+x")), Body(AxisAlignedHalfPlane("-x"), (2, 0))]
    world = World([*room, Body(Particle(0.5), (1, 0), (1000, 1), mass=1)], max_hits=2000)
    kept = world.snapshot()
    first = world.step(1.0)
    assert len(first) == 1000
    world.restore(kept)
    assert world.step(1.0).tobytes() == first.tobytes()


def test_restoring_undoes_positions_and_time() -> None:
    world = make_world(1)
    world.step(0.5)
    kept, expected = world.snapshot(), next_bits(world)
    world.restore(kept)
    world.place(7, (3, 3), (9, 9))
    world.restore(kept)
    assert world.time == 0.5
    assert next_bits(world) == expected


# Refusals.


def changed(content: bytes, at: int) -> bytes:
    return content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :]


def test_a_corrupt_snapshot_is_refused() -> None:
    world = make_world(1)
    world.step(0.5)
    kept = world.snapshot()
    wrong: list[tuple[Any, type[Exception], str]] = [
        (b"", ValueError, "no snapshot of worlds"),
        (b"arkanoid-world", ValueError, "no snapshot of worlds"),
        (b"x" * len(kept), ValueError, "no snapshot of worlds"),
        (changed(kept, 3), ValueError, "no snapshot of worlds"),
        (changed(kept, 8), ValueError, "of format 5, and this release reads format 4"),
        (changed(kept, 10), ValueError, "corrupt: some of its bytes have changed"),
        (changed(kept, 14), ValueError, "corrupt: .* bytes of .* are there"),
        (kept[:-1], ValueError, "corrupt: .* bytes of .* are there"),
        (kept[:60], ValueError, "corrupt"),
        (kept + b"\0", ValueError, "corrupt"),
        (changed(kept, 33), ValueError, "corrupt"),
        (changed(kept, 40), ValueError, "corrupt"),
        (changed(kept, 100), ValueError, "corrupt"),
        (changed(kept, len(kept) - 1), ValueError, "corrupt"),
        ("snapshot", TypeError, "is bytes; got str"),
        (None, TypeError, "is bytes; got NoneType"),
    ]
    for content, error, message in wrong:
        with pytest.raises(error, match=message):
            world.restore(content)
    assert world.snapshot() == kept


@pytest.mark.parametrize(
    "edit",
    [
        lambda w: w.add(Body(Particle(1))),
        lambda w: [w.remove(handle) for handle in (3, 17, 9)],
        lambda w: w.place(0, (0.1, 0)),
        lambda w: w.place(4, velocity=(0, 0)),
        lambda w: w.set_restitution(5, 7, 0.5),
        lambda w: w.set_restitution(5, 6, None),
        lambda w: w.change(8, mass=None, restitution=0.25, category=2, mask=5),
        lambda w: w.change(18, active=False),
        lambda w: [w.add(Body(Particle(0.1), (3, 3), (1, i), 1), mask=0) for i in range(40)],
    ],
)
@pytest.mark.parametrize("steps", [0, 3])
def test_a_snapshot_undoes_edits(edit: Callable[[World], Any], steps: int) -> None:
    """A snapshot held no bodies, and was refused after an edit."""
    world = make_world(1)
    for _ in range(steps):
        world.step(0.25)
    kept = world.snapshot()
    expected = next_bits(world)
    world.restore(kept)
    edit(world)
    edited = world.snapshot()
    assert edited != kept
    world.step(0.1)
    world.restore(kept)
    assert world.snapshot() == kept
    assert next_bits(world) == expected
    world.restore(edited)
    assert world.snapshot() == edited
    world.step(0.1)


def test_worlds_that_differ_in_rules_or_shapes_refuse_each_others_snapshots() -> None:
    disc = Particle(0.5)
    variants = [
        World([Body(disc, (0, 0), (1, 0), mass=1)]),
        World([Body(Particle(0.25), (0, 0), (1, 0), mass=1)]),
        World([Body(disc, (0, 0), (1, 0), mass=1)], max_hits=5),
        World([Body(disc, (0, 0), (1, 0), mass=1)], rest_speed=0.5),
        World([Body(disc, (0, 0), (1, 0), mass=1)], continuous=False),
    ]
    for number, world in enumerate(variants):
        for index, other in enumerate(variants):
            if index != number:
                with pytest.raises(ValueError, match="another world"):
                    world.restore(other.snapshot())


def test_batches_and_worlds_share_snapshots_if_there_is_one_world() -> None:
    world = make_world(2)
    batch = WorldBatch(world, 1)
    world.step(0.5)
    batch.restore(world.snapshot())
    assert batch.snapshot() == world.snapshot()
    batch.step(0.5)
    world.step(0.5)
    assert batch.snapshot() == world.snapshot()
    with pytest.raises(ValueError, match="another number of worlds"):
        WorldBatch(world, 2).restore(world.snapshot())


# Pickles and copies.


def pickled(world: World) -> World:
    twin: World = pickle.loads(pickle.dumps(world))
    return twin


@settings(max_examples=20, deadline=None)
@given(seeds, st.integers(0, 8), st.sampled_from([pickled, copy.deepcopy, copy.copy]))
def test_a_copy_continues_bit_for_bit_and_leaves_the_original_alone(
    seed: int, steps: int, duplicate: Callable[[World], World]
) -> None:
    world, control = make_world(seed), make_world(seed)
    for each in (world, control):
        for _ in range(steps):
            each.step(0.25)
    twin = duplicate(world)
    assert twin.snapshot() == world.snapshot()
    expected = next_bits(control)
    assert next_bits(twin) == expected
    assert next_bits(world) == expected


@pytest.mark.parametrize("duplicate", [pickled, copy.deepcopy, copy.copy])
@pytest.mark.parametrize("is_stepped", [False, True])
def test_a_copy_is_edited_alone(duplicate: Callable[[World], World], is_stepped: bool) -> None:
    world, control = make_world(3), make_world(3)
    if is_stepped:
        world.step(0.25)
        control.step(0.25)
    twin = duplicate(world)
    twin.place(6, (3, 3), (4, 4))
    twin.set_restitution(5, 6, None)
    twin.remove(0)
    twin.add(Body(Particle(0.25), (1, 1), (1, 0), mass=1))
    twin.step(0.5)
    assert len(world) == len(control)
    assert next_bits(world) == next_bits(control)


def test_a_copy_of_an_edited_world_holds_the_edits() -> None:
    world = make_world(4)
    world.step(0.25, steps=3)
    world.add(Body(Particle(0.25), (1, 1), (1, 0), mass=1))
    world.place(0, (-0.5, 0))
    twin = pickled(world)
    assert twin.time == world.time == 0.75
    assert next_bits(twin) == next_bits(world)


def test_forged_snapshots_do_no_harm() -> None:
    """Their checksums are right. Of 1806 that were tried, 175 crashed the process."""
    run_python(FORGE, "1000", "0", warnings="default", changes={"NUMBA_BOUNDSCHECK": "1"})


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_a_hundred_thousand_forged_snapshots_do_no_harm(seed: int) -> None:
    changes = {"NUMBA_BOUNDSCHECK": "1"}
    run_python(FORGE, "20000", str(seed), warnings="default", changes=changes, timeout=3600.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [("at", 1000.0), ("at_low", 1.0), ("at", math.nan), ("fresh", 2), ("fresh", -1)],
)
def test_what_no_step_leaves_is_refused_and_changes_nothing(name: str, value: float) -> None:
    world = make_world(0)
    world.step(0.25)
    before = world.snapshot()
    # Far from what it may be.
    world.site.setup.records(world.site.state, "motions", Course)[name] = value
    forged = world.snapshot()
    world.restore(before)
    with pytest.raises(ValueError, match="no world can have such courses"):
        world.restore(forged)
    assert world.snapshot() == before


@pytest.mark.parametrize("pair", [(5, 6), (17, 17), (17, 18), (18, 17)])
def test_pairs_inside_sensors_that_cannot_be_are_refused(pair: tuple[int, int]) -> None:
    """Only 17 and 18 are sensors, and they do not notice each other."""
    world = make_world(0)
    before = world.snapshot()
    world.site.inside = inside_block(np.array([(*pair, 0)]), world.site.heads(), 8)
    forged = world.snapshot()
    world.restore(before)
    with pytest.raises(ValueError, match="no world can have such bodies inside sensors"):
        world.restore(forged)
    assert world.snapshot() == before


def test_time_too_large_for_a_number_is_an_error() -> None:
    """No plan was later than a time of nan: bodies left the grid, and wrote beyond its lists."""
    calm = World([Body(Particle(1), (0, 0), (1e-300, 0), 1)])
    calm.step(1e308)
    with pytest.raises(ValueError, match="or the time has"):
        calm.step(1e308)
