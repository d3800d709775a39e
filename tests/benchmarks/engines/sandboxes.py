"""Compares the engine with Chipmunk and Box2D in what games do besides bouncing balls.

Called by ``engine.py``, which prints the table. docs/performance.md explains the rows.
"""

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from . import installed_sandboxes
from .arkanoid_sandbox import ArkanoidSandbox
from .sandbox import STEP, Sandbox

GRAVITY = 10.0  # metres a second squared
WALKERS = 40
WALK = 6.0  # metres a second
CRATE = 0.8  # metres
RADIUS = 0.5  # metres: of the discs of a crowd
FLIGHT = 300  # steps in which a crowd flies away
FIELDS = 3  # so many field sizes
MOST_FLYING = 1000  # discs; pymunk would need minutes for more
MOST_BODIES = {"pymunk": 10_000}  # it would need minutes for more
STATICS = 10_000
Makers = dict[str, type[Sandbox] | None]
Engines = dict[str, type[Sandbox]]


def compare(table: Any, quick: bool, only_ours: bool) -> None:
    """Measure all rows, and print them in the columns of ``table``."""
    makers: Makers = {table.ours: ArkanoidSandbox}
    if not only_ours:
        makers |= installed_sandboxes()
    engines = {name: maker for name, maker in makers.items() if maker is not None}
    part = 10 if quick else 1
    warm_up()
    tile_walk(table, engines, 600 // part)
    for count in (1000, 10_000, 100_000):
        wandering_crowd(table, engines, count, max(3, 60_000 // part // count))
    for count, flight in ((1000, 0.6), (10_000, 2.0)):
        flying_crowd(table, engines, count, flight, max(5, 60_000 // part // count))
    two_sizes(table, engines, 60 // part)
    pyramid(table, engines, 10, 600 // part)
    pyramid(table, engines, 31, 60 // part)
    changes(table, engines, 2000 // part)
    rays(table, engines, 20_000 // part)


def warm_up() -> None:
    """Compile the kernels, or load them."""
    world = ArkanoidSandbox(GRAVITY, 0.0)
    world.tile((0.0, -1.0), (4.0, 1.0))
    world.disc((0.0, 0.0), (0.0, 0.0), 0.4)
    crate = world.crate((1.0, 0.0), (0.0, 0.0), (0.5, 0.5))
    world.push(crate, (1.0, 0.0))
    world.step()
    world.rays([((-3.0, 0.0), (3.0, 0.0))])
    world.remove(crate)
    world.step()


def seconds(work: Callable[[], object]) -> float:
    """Return the processor time of this thread, in which all engines work."""
    start = time.thread_time()
    work()
    return time.thread_time() - start


def per_step(world: Sandbox, steps: int, pushed: Any = None) -> float:
    """Return the milliseconds of a step; the velocity of a body is written before each."""

    def work() -> None:
        for _ in range(steps):
            if pushed is not None:
                world.push(pushed, world.velocity(pushed))
            world.step()

    return 1000 * seconds(work) / steps


def costs_row(table: Any, costs: dict[str, float], label: str, reason: str) -> None:
    """Print milliseconds, and how many times as fast we are."""
    table.row(label, costs, ".3f")
    rates = {name: 1 / cost for name, cost in costs.items()}
    table.ratios(rates, rates[table.ours], reason=reason)


def tile_walk(table: Any, engines: Engines, frames: int) -> None:
    """Let crates walk over tiles: a game sets their speed in every frame, and none may get stuck.

    Every walker has a floor of its own, whose tiles and heights have one decimal, as in an editor.
    """
    length = round(WALK * frames * STEP) + 4
    lost, shaken, costs = {}, {}, {}
    for name, maker in engines.items():
        world = maker(GRAVITY, 0.0)
        walkers = []
        for number in range(WALKERS):
            height, width = 8.0 * number + 0.1 * (number % 10), 1.0 + 0.1 * (number % 7)
            for tile in range(math.ceil(length / width)):
                world.tile((tile * width, height), (width, 0.4))
            place = (0.1 * number % 1.0, height + 0.2 + CRATE / 2)
            walkers.append((world.crate(place, (WALK, 0.0), (CRATE, CRATE)), place[1]))
        places = [world.position(walker)[0] for walker, _ in walkers]
        missed, worst, spent = 0, 0.0, 0.0
        for frame in range(frames):
            for walker, _ in walkers:
                world.push(walker, (WALK, world.velocity(walker)[1]))
            spent += seconds(world.step)
            for index, (walker, due) in enumerate(walkers):
                x, y = world.position(walker)
                missed += x - places[index] < 0.99 * WALK * STEP
                places[index] = x
                # Peers let bodies sink in a little at first.
                worst = max(worst, y - due) if frame > 20 else worst
        lost[name], shaken[name] = missed, 1000 * worst
        costs[name] = 1000 * spent / frames
    table.title(f"Tiles: {WALKERS} crates walk {frames} frames over floors of boxes")
    table.row("frames in which one got stuck", lost)
    table.row("highest hop, mm", shaken, ".3f")
    costs_row(
        table,
        costs,
        "ms a step",
        "a third of it is Python that writes gravity; and each floor is met at its exact time",
    )


def scattered(
    world: Sandbox, count: int, side: float, radius: float, drift: float
) -> tuple[list[Any], list[tuple[float, float]]]:
    """Put discs into a square, none of which overlap.

    Returns:
        Their handles, and their velocities without the drift (along both axes) that they have.
    """
    rng = np.random.default_rng(0)
    columns = math.ceil(math.sqrt(count))
    cell = side / columns
    handles, velocities = [], []
    for index in range(count):
        x, y = (np.array(divmod(index, columns)) + 0.5) * cell
        x, y = (x, y) + rng.uniform(-1, 1, 2) * (cell / 2 - radius) * 0.9
        vx, vy = rng.normal(0.0, 1.0, 2).tolist()
        handles.append(world.disc((float(x), float(y)), (vx + drift, vy + drift), radius))
        velocities.append((vx, vy))
    return handles, velocities


def wandering_crowd(table: Any, engines: Engines, count: int, steps: int) -> None:
    """Let discs fly away together, then wander there, and write one velocity before each step."""
    side, costs = 2.0 * math.sqrt(count), {}
    flight = FLIGHT if count <= MOST_FLYING else 0
    drift = FIELDS * side / (FLIGHT * STEP) if flight else 0.0
    for name, maker in engines.items():
        if count > MOST_BODIES.get(name, count):
            continue
        world = maker()
        handles, velocities = scattered(world, count, side, RADIUS, drift)
        for _ in range(flight):
            world.step()
        for handle, velocity in zip(handles, velocities, strict=True):
            world.push(handle, velocity)
        world.step()
        costs[name] = per_step(world, steps, handles[count // 2])
    away = f", {FIELDS} field sizes from where they were" if flight else ""
    table.title(f"A crowd: {count:,} discs wander at about 1 m/s{away}")
    costs_row(table, costs, "ms a step, one velocity written before each", "")


def flying_crowd(table: Any, engines: Engines, count: int, way: float, steps: int) -> None:
    """Let discs without walls fly away together, and write one velocity before each step.

    way: metres that they fly along each axis in a step.
    """
    costs = {}
    for name, maker in engines.items():
        world = maker()
        handles, _ = scattered(world, count, 2.0 * math.sqrt(count), RADIUS, way / STEP)
        for _ in range(20):
            world.step()
        costs[name] = per_step(world, steps, handles[count // 2])
    table.title(f"A crowd in flight: {count:,} discs of 0.5 m, {way:g} m a step along each axis")
    costs_row(
        table,
        costs,
        "ms a step, one velocity written before each",
        "each disc leaves the box in which it is looked up once or more in a step",
    )


def two_sizes(table: Any, engines: Engines, steps: int) -> None:
    """Mix 4000 small discs with 40 of twenty times their size."""
    costs = {}
    for name, maker in engines.items():
        world = maker()
        small, _ = scattered(world, 3960, 90.0, 0.2, 0.0)
        for index in range(40):
            world.disc((5.0 + 11.0 * (index % 8), -6.0 - 11.0 * (index // 8)), (0.0, 1.0), 4.0)
        world.step()
        costs[name] = per_step(world, steps, small[0])
    table.title("4,000 discs of two sizes, 1 : 20")
    costs_row(table, costs, "ms a step, one velocity written before each", "")


def pyramid(table: Any, engines: Engines, rows: int, steps: int) -> None:
    """Pile crates up under gravity, none of which bounces: do they stand?"""
    sunk, costs = {}, {}
    for name, maker in engines.items():
        world = maker(GRAVITY, 0.0)
        world.tile((0.0, -1.0), (100.0, 2.0))
        crates = []
        for row in range(rows):
            for number in range(rows - row):
                place = (1.1 * (number - (rows - row - 1) / 2), row + 0.5)
                crates.append((world.crate(place, (0.0, 0.0), (1.0, 1.0)), place[1]))
        costs[name] = per_step(world, steps)
        sunk[name] = max(1000 * abs(world.position(crate)[1] - due) for crate, due in crates)
    table.title(f"A pyramid of {len(crates)} crates of 1 m, {steps} steps")
    table.row("farthest from its place, mm", sunk, ".2g")
    costs_row(
        table,
        costs,
        "ms a step",
        "each step resolves the whole pile to the last digits, so that nothing sinks",
    )


def changes(table: Any, engines: Engines, pairs: int) -> None:
    """Remove and add tiles of a map while ten discs fly over it."""
    rates = {}
    columns = round(math.sqrt(STATICS))
    for name, maker in engines.items():
        world = maker()
        tiles = [
            world.tile((2.0 * (index % columns), 2.0 * (index // columns)), (1.0, 1.0))
            for index in range(STATICS)
        ]
        for number in range(10):
            world.disc((20.0 * number + 1.0, 1.0), (1.0, 2.0), 0.3)
        world.step()
        rng = np.random.default_rng(0)
        chosen = rng.integers(0, STATICS, pairs).tolist()

        def change(world: Sandbox = world, tiles: list[Any] = tiles, picks: Any = chosen) -> None:
            for index in picks:
                x, y = world.position(tiles[index])
                world.remove(tiles[index])
                tiles[index] = world.tile((x, y), (1.0, 1.0))
                world.step()

        rates[name] = pairs / seconds(change)
    table.title(f"A map of {STATICS:,} tiles: one removed and one added before each step")
    table.row("changes with their step, a second", rates)
    table.ratios(rates, rates[table.ours], reason="every argument of an edit is checked")


def rays(table: Any, engines: Engines, count: int) -> None:
    """Cast rays into 1000 boxes; engines with single precision may miss a corner."""
    rng = np.random.default_rng(0)
    boxes = np.concatenate([rng.uniform(0, 100, (1000, 2)), rng.uniform(0.2, 2, (1000, 2))], 1)
    ends = rng.uniform(0, 100, (count, 2, 2)).tolist()
    cast = [(tuple(start), tuple(end)) for start, end in ends]
    rates, answers = {}, {}
    for name, maker in engines.items():
        world = maker()
        for x, y, width, height in boxes.tolist():
            world.tile((x, y), (width, height))
        world.step()
        results: list[Any] = []
        rates[name] = count / seconds(lambda r=results, w=world: r.extend(w.rays(cast)))
        answers[name] = sum(result < math.inf for result in results)
    table.title(f"{count:,} rays among 1,000 boxes")
    table.row("rays that hit", answers)
    table.row("rays a second", rates)
    table.ratios(
        rates,
        rates[table.ours],
        reason="a quarter of it turns pairs into arrays; half of it is the walk through the tree",
    )
