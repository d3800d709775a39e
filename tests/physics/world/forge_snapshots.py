"""Restores forged snapshots of worlds, and steps on where they are accepted.

Run: NUMBA_BOUNDSCHECK=1 python tests/physics/world/forge_snapshots.py COUNT SEED
It prints how many were refused and accepted. It fails if anything but a ValueError is raised, or a
position is not finite; the caller sees crashes and hangs.
"""

import faulthandler
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from arkanoid.physics import (
    AxisAlignedRectangle,
    Body,
    HitLimitWarning,
    Particle,
    World,
    WorldBatch,
)
from arkanoid.physics.world.memory.snapshots import Head, Kept
from arkanoid.physics.world.state.records import Clock, Entry, Hit, Override, Trait
from helpers.bodies import SMALL_SHAPES, room
from helpers.forging import forge, opened, sealed_again

DIGEST = 16  # bytes
SECONDS = 60  # in which one of them is stepped, or it hangs


def make_world(bodies: int, continuous: bool = True) -> World:
    """Return a room with bodies, two sensors, and a few large ones."""
    rng = np.random.default_rng(bodies)
    world = World(
        [*room(12, 10), Body(AxisAlignedRectangle(1, 0.25), (3, 4.4), (0.1, 0))],
        continuous=continuous,
        max_hits=200,
    )
    for index in range(bodies):
        place = (0.8 + index % 8 * 1.4, 0.6 + index // 8 * 1.5)
        velocity = rng.normal(size=2) * 2
        world.add(Body(SMALL_SHAPES[index % 4], place, velocity, float(1 + index % 3), 0.9))
    world.add(Body(AxisAlignedRectangle(2, 2), (2, 2)), sensor=True)
    world.add(Body(Particle(1), (4, 3), (-0.1, 0)), sensor=True)
    if bodies > 8:
        world.add(Body(AxisAlignedRectangle(6, 0.5), (6, 9), (0.3, 0), 5.0))
    return world


def tables(content: bytearray) -> list[Any]:
    """Return the parts of a snapshot's content as writable arrays of records, [n]."""
    parts: list[Any] = []
    at = 0

    def take(dtype: Any, count: Any) -> Any:
        nonlocal at
        part = np.frombuffer(content, dtype, int(count), at)
        at += part.nbytes
        parts.append(part)
        return part

    index = np.dtype([("count", np.int64)])
    pair = np.dtype([("sensor", np.int64), ("body", np.int64), ("moved", np.int64)])
    worlds, setups = take(index, 2)["count"].tolist()
    movers = []
    for _ in range(setups):
        head = take(Head, 1)[0]
        at += DIGEST
        take(Trait, head["bodies"])
        take(Entry, head["bodies"])
        take(Override, head["overrides"])
        movers.append(head["movers"])
    which = take(index, worlds)["count"]
    take(Clock, worlds)
    for number in which:
        kept = take(Kept, movers[number])
        parts += [kept[name] for name in ("shown", "shown_after_step", "motions")]
        del parts[-4]  # the records of records
    counts = take(index, 2 * worlds)["count"].reshape(-1, 2)
    for count in counts[:, 0]:
        take(pair, count)
    for count in counts[:, 1]:
        take(Hit, count)
    return [part for part in parts if len(part)]


def edit(world: World, rng: np.random.Generator) -> None:
    """Remove a body, change one, and add one."""
    world.remove(int(rng.choice(world.handles[4:])))
    handle = int(rng.choice(world.handles[4:]))
    world.change(handle, mass=2.0, active=bool(rng.random() < 0.7), category=3)
    world.set_restitution(handle, int(world.handles[0]), 0.5)
    world.add(Body(SMALL_SHAPES[0], rng.uniform(1, 9, 2), rng.normal(size=2), 1.0))


def main() -> None:
    """Forge so many snapshots."""
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    rng = np.random.default_rng(seed)
    warnings.simplefilter("ignore", HitLimitWarning)
    refused = accepted = stopped = 0
    makers = [make_world(4), make_world(24), make_world(24, False), WorldBatch(make_world(12), 3)]
    for maker in makers:
        worlds = list(maker) if isinstance(maker, WorldBatch) else [maker]
        snapshots = []
        for _ in range(30):
            edit(worlds[rng.integers(len(worlds))], rng)
            maker.step(0.25, int(rng.integers(1, 4)))
            if rng.random() < 0.5:
                edit(worlds[0], rng)
            snapshots.append(maker.snapshot())
            maker.restore(snapshots[-1])
        for _ in range(count // len(makers)):
            faulthandler.dump_traceback_later(SECONDS, exit=True)
            snapshot = snapshots[rng.integers(len(snapshots))]
            content = opened(snapshot)
            parts = tables(content)
            names = []
            for _ in range(int(rng.choice([1, 1, 2, 4]))):
                part = parts[rng.integers(len(parts))]
                small = dict.fromkeys(part.dtype.names, (-1, 30))
                names.append(forge(rng, part, small))
            before = maker.snapshot()
            try:
                maker.restore(sealed_again(snapshot, bytes(content)))
            except ValueError:
                refused += 1
                assert maker.snapshot() == before
                continue
            accepted += 1
            try:
                for _ in range(4):
                    maker.step(0.2)
                    assert np.isfinite(maker.positions).all()
                maker.restore(maker.snapshot())
            except ValueError as error:
                if "not finite" not in str(error):
                    raise
                stopped += 1
            except BaseException:
                print(names, flush=True)
                raise
            maker.restore(snapshots[0])
        # What is made next may have to be compiled, for longer than that.
        faulthandler.cancel_dump_traceback_later()
    print(f"{refused} refused, {accepted} accepted, of which {stopped} became too large")


if __name__ == "__main__":
    main()
