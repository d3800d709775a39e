"""Measures how long it takes to save, restore, copy, record and replay games.

Run: python tests/benchmarks/saving.py [--seconds 1]
"""

import argparse
import copy
import pickle
import time
from collections.abc import Callable
from typing import Any

from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv, play_replay

WORLDS = 1024
DECISIONS = 9000  # ten minutes of play


def seconds_each(act: Callable[[], Any], seconds: float) -> float:
    """Return the seconds per call: the best of five slices of the time."""
    act()
    best = float("inf")
    for _ in range(5):
        calls, start = 0, time.perf_counter()
        while time.perf_counter() - start < seconds / 5:
            act()
            calls += 1
        best = min(best, (time.perf_counter() - start) / calls)
    return best


def begun(**keywords: Any) -> ArkanoidEnv:
    """Return an environment in the middle of a game."""
    env = ArkanoidEnv(**keywords)
    env.reset(seed=0)
    for _ in range(100):
        step(env, 3)
    return env


def step(env: ArkanoidEnv, action: int) -> None:
    """Play a decision; after a game's end begin the next one."""
    _, _, terminated, truncated, _ = env.step(action)
    if terminated or truncated:
        env.reset()


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=1.0, help="time per row")
    seconds = parser.parse_args().seconds
    env = begun()
    pictures = begun(observation="rgb", grey=True, stack=4)
    futures = ArkanoidVectorEnv(WORLDS)
    snapshot, picture_snapshot = env.snapshot(), pictures.snapshot()
    futures.spread(snapshot)
    all_worlds = futures.snapshot()
    rows: dict[str, Callable[[], Any]] = {
        "step": lambda: step(env, 0),
        f"snapshot ({len(snapshot):,} bytes)": env.snapshot,
        "restore": lambda: env.restore(snapshot),
        "clone": env.clone,
        "copy.deepcopy": lambda: copy.deepcopy(env),
        "pickle, and back": lambda: pickle.loads(pickle.dumps(env)),
        f"snapshot of four pictures ({len(picture_snapshot):,} bytes)": pictures.snapshot,
        "restore of four pictures": lambda: pictures.restore(picture_snapshot),
        "clone with four pictures": pictures.clone,
        f"spread over {WORLDS} worlds": lambda: futures.spread(snapshot),
        f"snapshot of {WORLDS} worlds ({len(all_worlds):,} bytes)": futures.snapshot,
        f"restore of {WORLDS} worlds": lambda: futures.restore(all_worlds),
    }
    for name, act in rows.items():
        print(f"{name:48}{seconds_each(act, seconds) * 1e6:12,.1f} µs")

    player = ArkanoidEnv(lives=1000)
    player.action_space.seed(0)
    actions = [player.action_space.sample() for _ in range(DECISIONS)]
    recorder = player.record()
    player.reset(seed=0)
    start = time.perf_counter()
    for action in actions:
        player.step(action)
    print(f"{'recorded step':48}{(time.perf_counter() - start) / DECISIONS * 1e6:12,.1f} µs")
    replay = recorder.replay()
    took = seconds_each(lambda: play_replay(replay), seconds)
    name = f"replay of {DECISIONS} decisions ({len(replay.to_bytes()):,} bytes)"
    print(f"{name:48}{took * 1e3:12,.1f} ms")


if __name__ == "__main__":
    main()
