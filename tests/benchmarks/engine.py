"""Compares the engine with Chipmunk (pymunk) and Box2D: bounces, tiles, crowds, piles, rays, ...

Run: python tests/benchmarks/engine.py [--quick] [--only-ours]

One run measures everything on one core, in processor time, and the engines take turns.
`pip install -e ".[bench]"` installs the peers; the column of a missing peer is empty.
docs/performance.md explains the rows.
"""

import argparse
import os
import platform
import time
from collections.abc import Callable, Iterable, Sequence
from importlib.metadata import version

import numpy as np
from engines import PEERS, Engine, installed_peers, sandboxes
from engines.arkanoid_engine import Arkanoid, Batch, ManySteps
from engines.scene import (
    BALL_SPEED,
    FloatArray,
    Scene,
    billiards,
    bounces_due,
    breakout,
    corridor,
    headings,
    reflected,
    volley,
)

LABEL, COLUMN = 44, 15  # characters
BATCH = 1024  # worlds
STARTS = 8  # headings of the ball among bricks
PATHS = (0.1, 0.5)  # billiards: radii that a disc moves per step
CORRIDOR_SPEEDS = (0.8, 8.0, 80.0)  # units per step
Columns = dict[str, type[Engine] | None]


class Clock:
    """The processor time that each engine needs for each task: the least of several rounds."""

    def __init__(self) -> None:
        self.seconds: dict[str, dict[int, float]] = {}

    def time(self, name: str, task: int, work: Callable[[], object]) -> None:
        """Do ``work``, one round of a task, by the engine called ``name``."""
        start = time.thread_time()  # all engines work in the thread that calls them
        work()
        taken = time.thread_time() - start
        least = self.seconds.setdefault(name, {})
        least[task] = min(taken, least.get(task, taken))

    def total(self, name: str) -> float:
        """Return the seconds for all tasks together."""
        return sum(self.seconds[name].values())


class Table:
    """Prints rows as they are measured: a label, our column, and one column per peer."""

    def __init__(self, columns: Columns) -> None:
        self.columns = columns
        self.ours = next(iter(columns))
        print(f"{'':{LABEL}}{''.join(f'{name:>{COLUMN}}' for name in columns)}")

    def title(self, text: str) -> None:
        print(f"\n{text}", flush=True)

    def row(self, label: str, values: dict[str, float], form: str = ",.0f") -> None:
        cells = (
            "not installed"
            if engine is None
            else format(values[name], form)
            if name in values
            else ""
            for name, engine in self.columns.items()
        )
        line = f"  {label:{LABEL - 2}}{''.join(f'{cell:>{COLUMN}}' for cell in cells)}"
        print(line.rstrip(), flush=True)

    def ratios(
        self, values: dict[str, float], ours: float, target: float | None = None, reason: str = ""
    ) -> None:
        """Print our rate divided by each peer's, and whether that for pymunk reaches the target.

        reason: why a peer may be faster, or the target be missed; it is printed if so.
        """
        ratios = {name: ours / value for name, value in values.items() if name != self.ours}
        label, met = "  ours / theirs", True
        if target is not None and "pymunk" in ratios:
            met = ratios["pymunk"] >= target
            label += f" (target: {target:g} x pymunk, {'met' if met else 'MISSED'})"
        if ratios:
            self.row(label, ratios, ".2f")
            if not met or min(ratios.values()) < 1:
                print(f"    {'below 1' if met else 'missed'}: {reason or 'WHY?'}", flush=True)

    def target(self, text: str, met: bool) -> None:
        print(f"    target: {text}: {'met' if met else 'MISSED'}", flush=True)


def present(columns: Columns) -> dict[str, type[Engine]]:
    return {name: engine for name, engine in columns.items() if engine is not None}


def breakout_speed(table: Table, ticks: int, rounds: int) -> None:
    """Measure a ball among bricks: one call per tick, many ticks per call, many worlds."""
    scenes = [breakout(heading) for heading in headings(STARTS)]
    engines = {**present(table.columns), "many": ManySteps}
    clock = Clock()
    for _ in range(rounds):
        for number, scene in enumerate(scenes):
            for name, engine in engines.items():
                world = engine(scene)
                clock.time(name, number, lambda world=world: world.run(ticks))
    contacts, lost = {}, {}
    for name, engine in present(table.columns).items():
        worlds = [engine(scene, count=True) for scene in scenes]
        contacts[name] = sum(world.run(ticks) for world in worlds) / (STARTS * ticks / 1000)
        lost[name] = sum(scenes[0].lost(world.state()[0]) for world in worlds)

    table.title(f"Breakout: one ball among 100 bricks, {STARTS} starts of {ticks:,} ticks")
    rates = {name: STARTS * ticks / clock.total(name) for name in engines}
    many = rates.pop("many")
    table.row("contacts in 1000 ticks", contacts)
    table.row("balls that left the field", lost)
    table.row("ticks/s, a call each", rates)
    table.ratios(rates, rates[table.ours], target=1.5)
    table.row(f"ticks/s, {ManySteps.steps_per_call} ticks a call", {table.ours: many})
    table.ratios(rates, many, target=5)
    batch = batch_rate(ticks // 100, rounds)
    table.row(f"world-ticks/s, {BATCH} worlds a call", {table.ours: batch})
    reason = "most of it is planning after each contact: when each brick around is met"
    table.ratios(rates, batch, target=15, reason=reason)


def batch_rate(ticks: int, rounds: int) -> float:
    """Return the ticks per second that all worlds of a batch make together."""
    scene = breakout(0.5)
    angles = headings(BATCH)
    velocities = BALL_SPEED * np.stack([np.sin(angles), np.cos(angles)], axis=1)
    clock = Clock()
    for _ in range(rounds):
        batch = Batch(scene, velocities)
        clock.time("batch", 0, lambda batch=batch: batch.run(ticks))
        if scene.lost(batch.state()[0]):
            raise RuntimeError("a ball of the batch has left the field")
    return BATCH * ticks / clock.total("batch")


def breakout_energy(table: Table, ticks: int) -> None:
    """Measure how the ball's speed drifts among bricks, with the peers' most accurate settings."""
    drifts = {}
    for name, engine in present(table.columns).items():
        worlds = [engine(breakout(heading), accurate=True) for heading in headings(STARTS)]
        for world in worlds:
            world.run(ticks)
        speeds = [float(np.hypot(*world.state()[1][0])) for world in worlds]
        drifts[name] = np.abs(np.array(speeds) / BALL_SPEED - 1)
    table.title(f"Energy: the same ball after {ticks:,} ticks, |speed / speed at first - 1|")
    table.row(
        "median of the starts", {name: np.median(drift) for name, drift in drifts.items()}, ".1e"
    )
    table.row("worst of the starts", {name: drift.max() for name, drift in drifts.items()}, ".1e")


def billiards_all(table: Table, steps: int, rounds: int, path: float) -> None:
    """Measure a thousand discs: contacts per second, energy, discs lost."""
    scene = billiards(path=path)
    clock, contacts, drift, lost = Clock(), {}, {}, {}
    for _ in range(rounds):
        for name, engine in present(table.columns).items():
            world = engine(scene)
            clock.time(name, 0, lambda world=world: world.run(steps))
            lost[name] = scene.lost(world.state()[0])
    for name, engine in present(table.columns).items():
        contacts[name] = engine(scene, count=True).run(steps)
        world = engine(scene, accurate=True)
        world.run(steps)
        drift[name] = abs(energy(world.state()[1]) / energy(scene.velocities) - 1)

    table.title(
        f"Billiards: {len(scene.positions):,} elastic discs fill 0.22 of a box, {steps:,} steps, "
        f"a disc moves {path:g} of its radius a step"
    )
    rates = {name: contacts[name] / clock.total(name) for name in contacts}
    table.row("contacts", contacts)
    table.row("contacts/s", rates)
    table.ratios(
        rates,
        rates[table.ours],
        target=1.5 if path == PATHS[0] else None,
        reason="pymunk misses contacts, and its energy is wrong: see the rows around this one",
    )
    table.row("energy drift, |E / E at first - 1|", drift, ".1e")
    table.row("discs that left the box", lost)
    table.target("drift < 1e-9, none lost", drift[table.ours] < 1e-9 and lost[table.ours] == 0)


def energy(velocities: FloatArray) -> float:
    return float((velocities**2).sum())


def tunnelling(table: Table, steps: int) -> None:
    """Measure balls that are fast enough to cross a wall within one step."""
    scene = volley()
    through, kept, right = {}, {}, {}
    for name, engine in present(table.columns).items():
        world = engine(scene, accurate=True)
        world.run(steps)
        positions, velocities = world.state()
        speeds = scene.velocities[:, 0]
        through[name] = int((positions[:, 0] > 0).sum())
        kept[name] = int((np.abs(velocities[:, 0] + speeds) < 1e-6 * speeds).sum())
        away = np.abs(positions[:, 0] - reflected(scene, steps))
        right[name] = int((away < 0.01 * speeds).sum())
    table.title(
        f"Tunnelling: {len(scene.positions)} balls of 1 to 50 units a step before a wall 0.5 thick"
    )
    table.row("got through the wall", through)
    table.row("came back as fast as before", kept)
    table.row("are where they are due, to 1 % of a step", right)


def bounces(table: Table, steps: int) -> None:
    """Compare the bounces that a ball makes between two walls with those that are due."""
    table.title(f"Bounces of a ball between two walls 9.6 units of flight apart, {steps:,} steps")
    for speed in CORRIDOR_SPEEDS:
        made = {
            name: engine(corridor(speed), accurate=True, count=True).run(steps)
            for name, engine in present(table.columns).items()
        }
        due = bounces_due(speed, steps)
        table.row(f"at {speed:g} units a step, due: {due:,}", made)


def warm_up(engines: Iterable[type[Engine]]) -> None:
    """Compile the kernels, or load them."""
    scenes: Sequence[Scene] = (breakout(0.5), billiards(16), volley(4), corridor(1.0))
    for engine in engines:
        for scene in scenes:
            engine(scene, count=True).run(2)
    Batch(breakout(0.5), np.ones((2, 2))).run(2)


def one_core() -> str:
    """Keep this process on one core, if the system can; return a note about it."""
    if not hasattr(os, "sched_setaffinity"):
        return "not pinned to a core"
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    return "one core"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="a tenth of the steps, one round")
    parser.add_argument("--only-ours", action="store_true", help="without the peers")
    options = parser.parse_args()
    quick = options.quick
    part, rounds = (10, 1) if quick else (1, 3)

    columns: Columns = {"arkanoid": Arkanoid, **({} if options.only_ours else installed_peers())}
    packages = ["numba", *(package for name, (package, _) in PEERS.items() if columns.get(name))]
    versions = (f"{package} {version(package)}" for package in packages)
    print(
        platform.machine(), one_core(), f"Python {platform.python_version()}", *versions, sep=", "
    )
    table = Table(columns)
    warm_up([*present(columns).values(), ManySteps])
    breakout_speed(table, 50_000 // part, rounds)
    breakout_energy(table, 10_000 // part)
    for path in PATHS:  # the same flight in more or in fewer steps
        billiards_all(table, round(1_000 / path) // part, rounds, path)
    tunnelling(table, 60)
    bounces(table, 1_000)
    sandboxes.compare(table, quick, options.only_ours)


if __name__ == "__main__":
    main()
