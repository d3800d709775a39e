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
from arkanoid.physics.world.records import Clock
from arkanoid.physics.world.states import Kept
from helpers.bodies import SMALL_SHAPES, room
from helpers.forging import forge, opened, sealed_again

DIGEST = 16  # bytes before the states
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


def tables(world: World, content: bytearray, worlds: int) -> list[Any]:
    """Return the parts of a snapshot's content as writable arrays of records, [n]."""
    movers = int(world.built().setup.header.movers)
    index = np.dtype([("count", np.int64)])
    pair = np.dtype([("sensor", np.int64), ("body", np.int64)])
    parts: list[Any] = []
    at = DIGEST
    for dtype, count in ((Clock, worlds), (Kept, worlds * movers), (index, worlds)):
        parts.append(np.frombuffer(content, dtype, count, at))
        at += dtype.itemsize * count
    pairs = np.frombuffer(content, pair, -1, at)
    kept = parts[1]
    flat = [kept[name] for name in ("shown", "after_step", "motion")]
    rest = kept[["at", "at_low", "fresh"]]
    return [part for part in (parts[0], *flat, rest, parts[2], pairs) if len(part)]


def main() -> None:
    """Forge so many snapshots."""
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    rng = np.random.default_rng(seed)
    warnings.simplefilter("ignore", HitLimitWarning)
    refused = accepted = stopped = 0
    makers = [make_world(4), make_world(24), make_world(24, False), WorldBatch(make_world(12), 3)]
    template = make_world(12)
    for maker in makers:
        batch = isinstance(maker, WorldBatch)
        world, worlds = (template, 3) if batch else (maker, 1)
        snapshots = []
        for _ in range(30):
            maker.step(0.25, int(rng.integers(1, 4)))
            snapshots.append(maker.snapshot())
            maker.restore(snapshots[-1])
        for _ in range(count // len(makers)):
            faulthandler.dump_traceback_later(SECONDS, exit=True)
            snapshot = snapshots[rng.integers(len(snapshots))]
            content = opened(snapshot)
            parts = tables(world, content, worlds)
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
    faulthandler.cancel_dump_traceback_later()
    print(f"{refused} refused, {accepted} accepted, of which {stopped} became too large")


if __name__ == "__main__":
    main()
