"""Compares the environments' steps per second with MinAtar, ale-py and a native Breakout.

Run: python tests/benchmarks/throughput.py [--quick] [--only-ours]

One run measures everything, with random actions, after the games have drifted apart, and the games
of a section take turns. `pip install -e ".[bench]"` installs the peers; rows say which are missing.
docs/performance.md explains the rows.
"""

import argparse
import os
import platform
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from types import ModuleType

from games import PEERS, Game, arkanoid_games, peer

WORLDS, FEW, MANY, MOST = 1024, 128, 4096, 65536
SLOWER = 1.3  # the most that a decision of `MOST` worlds may cost, in those of `WORLDS`
# The time of an emulator's step depends neither on the situation nor on the number of worlds.
EMULATORS = 16
LITE, FULL = "ArkanoidLite-v0", "Arkanoid-v0"
TURBO = "env-breakoutatari2600-turbo-native"
PICTURES = {"observation": "rgb", "grey": True}
WARM_UP = 500  # decisions: some episodes of random actions, so that all of their stages occur
GAIN = 1.7  # the goal of two threads
SHORTER = 40  # other programs rarely leave both cores alone for more than some milliseconds
LABEL = 62  # characters
Clock = Callable[[], float]
Peers = dict[str, ModuleType | None]


@dataclass(frozen=True)
class Effort:
    """How long to measure."""

    warm_up: int  # decisions
    turns: int
    turn: float  # seconds

    def shorter(self, times: int) -> "Effort":
        """Return an effort with more turns, each shorter by the same factor."""
        return replace(self, turns=self.turns * times, turn=self.turn / times)


THOROUGH = Effort(WARM_UP, turns=7, turn=0.4)
QUICK = Effort(WARM_UP // 10, turns=2, turn=0.05)


@dataclass(frozen=True)
class Row:
    """One measurement.

    Args:
        label: the name of what is measured.
        make: makes the game; None if its package is not installed.
        mark: a letter by which other rows refer to this one, if it is ours.
        beside: the mark of our row that this one is compared with.
        goal: the steps per second to reach.
        part: the share of the rate of the row ``beside`` to reach.
    """

    label: str
    make: Callable[[], Game] | None
    mark: str = ""
    beside: str = ""
    goal: float | None = None
    part: float | None = None


class Turns:
    """Measures the best rate of a game among several turns."""

    def __init__(self, game: Game, effort: Effort, clock: Clock) -> None:
        self.game = game
        self.clock = clock
        game.play(effort.warm_up)
        self.rate = 0.0
        self.decisions = 1
        while self.measure() < effort.turn / 2:
            self.decisions *= 2
        self.rate = 0.0

    def measure(self) -> float:
        """Take a turn; return its seconds."""
        start = self.clock()
        self.game.play(self.decisions)
        seconds = self.clock() - start
        if seconds > 0:
            self.rate = max(self.rate, self.decisions * self.game.worlds / seconds)
        return seconds


def rates(games: Sequence[Game], effort: Effort, clock: Clock) -> list[float]:
    """Return the steps per second of each game; the games take turns."""
    all_turns = [Turns(game, effort, clock) for game in games]
    for _ in range(effort.turns):
        for turns in all_turns:
            turns.measure()
    for game in games:
        game.close()
    return [turns.rate for turns in all_turns]


def show_section(title: str, rows: Sequence[Row], effort: Effort) -> None:
    """Measure rows on one core, in processor time, and print them."""
    print(f"\n{title}", flush=True)
    present = [row for row in rows if row.make is not None]
    games = [row.make() for row in present if row.make is not None]
    # The time of the whole process: a peer's own threads count.
    results = dict(zip(present, rates(games, effort, time.process_time), strict=True))
    marked = {row.mark: rate for row, rate in results.items() if row.mark}
    for row in rows:
        if row in results:
            show(row.mark, row.label, results[row], verdict(row, results[row], marked))
        else:
            print(f"     {row.label:{LABEL}}{'not installed':>12}", flush=True)


def verdict(row: Row, rate: float, marked: dict[str, float]) -> str:
    """Return the last column of a row."""
    if row.goal is not None:
        return f"goal {row.goal:,.0f}: {met(rate >= row.goal)}"
    if row.part is not None:
        share = rate / marked[row.beside]
        return f"{share:.2f} x {row.beside}, goal {row.part:.2g}: {met(share >= row.part)}"
    if row.beside:
        return f"{row.beside} is {marked[row.beside] / rate:,.1f} x as fast"
    return ""


def met(good: bool) -> str:
    return "met" if good else "MISSED"


def show(mark: str, label: str, rate: float, said: str) -> None:
    print(f"  {mark:2} {label:{LABEL}}{rate:12,.0f}   {said}".rstrip(), flush=True)


@contextmanager
def one_core() -> Iterator[str]:
    """Keep this process on one core, if the system can; give a note about it."""
    if not hasattr(os, "sched_setaffinity"):
        yield "not pinned to a core"
        return
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(cores)})
    try:
        yield "one core"
    finally:
        os.sched_setaffinity(0, cores)


def made(module: ModuleType | None, function: str, *values: int) -> Callable[[], Game] | None:
    """Return a function that makes a peer's game; None if the peer is not installed."""
    return None if module is None else partial(getattr(module, function), *values)


def numbers(peers: Peers) -> list[Row]:
    """Return the rows of observations that are numbers."""
    many = partial(partial, arkanoid_games.many)
    minatar = peers["MinAtar"]
    return [
        Row(f"{LITE}, vector, frame skip 1", many(LITE, WORLDS, frame_skip=1), "a", goal=6e6),
        Row(f"{LITE}, vector", many(LITE, WORLDS), "b", goal=2.7e6),
        Row(f"{FULL}, vector, frame skip 1", many(FULL, WORLDS, frame_skip=1), "c", "a", part=0.5),
        Row(f"{FULL}, vector", many(FULL, WORLDS), "d", "b", part=0.5),
        Row(f"{LITE}, grid", many(LITE, WORLDS, observation="grid"), "e"),
        Row(f"{FULL}, grid", many(FULL, WORLDS, observation="grid"), "f"),
        Row(f"{LITE}, vector, {MOST} worlds", many(LITE, MOST), "n", "b", part=1 / SLOWER),
        Row(f"{FULL}, vector, {MOST} worlds", many(FULL, MOST), "o", "d", part=1 / SLOWER),
        Row(f"{LITE}, vector, landing=True", many(LITE, WORLDS, landing=True), "p", "b"),
        Row(f"{FULL}, vector, landing=True", many(FULL, WORLDS, landing=True), "q", "d"),
        Row("MinAtar's own class, one world", made(minatar, "own"), beside="b"),
    ]


def pictures(peers: Peers) -> list[Row]:
    """Return the rows of pictures."""
    many = partial(partial, arkanoid_games.many, FULL, **PICTURES)
    ale, turbo = peers["ale-py"], peers[TURBO]
    return [
        Row(f"{FULL}", many(WORLDS), "g", goal=225e3),
        Row(f"{FULL}, stack of 4", many(WORLDS, stack=4), "h", goal=100e3),
        Row(f"{FULL}, {FEW} worlds", many(FEW), "i"),
        Row(f"{FULL}, {FEW} worlds, stack of 4", many(FEW, stack=4), "j"),
        Row(TURBO, made(turbo, "many", WORLDS, 1), beside="g"),
        Row(f"{TURBO}, stack of 4", made(turbo, "many", WORLDS, 4), beside="h"),
        Row(f"{TURBO}, {FEW} worlds", made(turbo, "many", FEW, 1), beside="i"),
        Row(f"{TURBO}, {FEW} worlds, stack of 4", made(turbo, "many", FEW, 4), beside="j"),
        Row(f"ale-py, {EMULATORS} worlds", made(ale, "many", EMULATORS, 1), beside="g"),
        Row(f"ale-py, {EMULATORS} worlds, stack of 4", made(ale, "many", EMULATORS, 4), beside="h"),
    ]


def single(peers: Peers) -> list[Row]:
    """Return the rows of one world."""
    one = partial(partial, arkanoid_games.one)
    return [
        Row(f"{LITE}, vector", one(LITE), "k", goal=200e3),
        Row(f"{FULL}, vector", one(FULL), "l", goal=200e3),
        Row(f"{FULL}, rgb in grey", one(FULL, **PICTURES), "m"),
        Row("MinAtar", made(peers["MinAtar"], "one"), beside="k"),
        Row("ale-py, AtariPreprocessing", made(peers["ale-py"], "one"), beside="m"),
        Row(f"{TURBO}, gym.make_vec", made(peers[TURBO], "many", 1, 1), beside="m"),
    ]


def show_threads(effort: Effort) -> None:
    """Measure one and two threads, in wall-clock time, and print how much two gain."""
    print(
        f"\nTwo threads, {WORLDS} worlds, frame skip 4, two cores, seconds of the clock", flush=True
    )
    for label, worlds, keywords in (
        ("vector", WORLDS, {}),
        (f"vector, {MANY} worlds", MANY, {}),
        ("rgb in grey", WORLDS, PICTURES),
    ):
        for name in (LITE, FULL):
            games = [arkanoid_games.many(name, worlds, threads, **keywords) for threads in (1, 2)]
            one, two = rates(games, effort, time.perf_counter)
            said = f"{two / one:.2f} x one thread"
            if worlds == WORLDS:
                said += f", goal {GAIN}: {met(two / one >= GAIN)}"
            show("", f"{name}, {label}", two, said)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="in a tenth of the time")
    parser.add_argument("--only-ours", action="store_true", help="without the peers")
    options = parser.parse_args()
    effort = QUICK if options.quick else THOROUGH
    peers = {name: None if options.only_ours else peer(name) for name in PEERS}
    packages = ["numba", "gymnasium", *(name for name, module in peers.items() if module)]
    versions = (f"{package} {version(package)}" for package in packages)
    print(platform.machine(), f"Python {platform.python_version()}", *versions, sep=", ")
    if hasattr(os, "getloadavg"):
        print(f"load of the {os.cpu_count()} cores by other programs: {os.getloadavg()[0]:.1f}")
    print(f"{'':{LABEL + 5}}{'steps/s':>12}")
    sections = {
        f"Numbers, {WORLDS} worlds, frame skip 4, unless a row says otherwise": numbers(peers),
        f"Pictures, 84 x 84 in grey, {WORLDS} worlds, frame skip 4": pictures(peers),
        "One world, gym.make, frame skip 4": single(peers),
    }
    with one_core() as core:
        for title, rows in sections.items():
            shown = [row for row in rows if row.mark or not options.only_ours]
            show_section(f"{title}, {core}", shown, effort)
    show_threads(effort.shorter(SHORTER))


if __name__ == "__main__":
    main()
