"""Steps a second of the game, lite and full, by threads and observations, and by `gym.make`.

Run: python tests/benchmarks/throughput.py [--worlds 1024] [--seconds 2]
"""

import argparse
import os
import time
from collections.abc import Callable
from typing import Any

import arkanoid  # noqa: F401
import gymnasium as gym
import numpy as np


def rate(step: Callable[[], Any], seconds: float) -> float:
    """Return calls a second, after a warm-up, as the best of five slices of the time."""
    for _ in range(20):
        step()
    best = 0.0
    for _ in range(5):
        calls, start = 0, time.perf_counter()
        while time.perf_counter() - start < seconds / 5:
            step()
            calls += 1
        best = max(best, calls / (time.perf_counter() - start))
    return best


GAMES = ("ArkanoidLite-v0", "Arkanoid-v0")
# With the goals in steps a second, of one core at a frame skip of 4.
OBSERVATIONS: list[tuple[dict[str, Any], int | None]] = [
    ({"observation": "vector"}, None),
    ({"observation": "grid"}, None),
    ({"observation": "rgb", "grey": True}, 225_000),
    ({"observation": "rgb", "grey": True, "stack": 4}, 100_000),
    ({"observation": "rgb"}, None),
]


def native_rate(game: str, worlds: int, seconds: float, **keywords: Any) -> float:
    """Return the steps a second of all worlds of the native vector env, random actions."""
    env = gym.make_vec(
        game, worlds, "vector_entry_point", actions="discrete3", copy=False, **keywords
    )
    env.reset(seed=0)
    actions = np.random.default_rng(0).integers(0, 3, (64, worlds))
    turn = iter(range(10**12))
    result = rate(lambda: env.step(actions[next(turn) % 64]), seconds) * worlds
    env.close()
    return result


def single_rate(game: str, seconds: float) -> float:
    """Return the steps a second of one env with the default wrappers, resets included."""
    env = gym.make(game)
    env.reset(seed=0)
    actions = np.random.default_rng(0).integers(0, env.action_space.n, 64).tolist()
    turn = iter(range(10**12))

    def step() -> None:
        _, _, terminated, truncated, _ = env.step(actions[next(turn) % 64])
        if terminated or truncated:
            env.reset()

    return rate(step, seconds)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=1024)
    parser.add_argument("--seconds", type=float, default=2.0, help="for each row")
    options = parser.parse_args()
    print(f"{options.worlds} worlds, vector observations but where it says so, random actions\n")
    print(f"{'':58}{'steps/s':>14}{'ticks/s':>14}")
    for game in GAMES:
        one = 0.0
        for frame_skip in (1, 4):
            for threads in sorted({1, os.cpu_count() or 1}):
                steps = native_rate(
                    game, options.worlds, options.seconds, frame_skip=frame_skip, threads=threads
                )
                one = steps if threads == 1 else one
                name = f"{game}, native, frame_skip={frame_skip}, threads={threads}"
                ratio = "" if threads == 1 else f"   {steps / one:.2f} x one thread"
                print(f"{name:58}{steps:14,.0f}{steps * frame_skip:14,.0f}{ratio}", flush=True)
        steps = single_rate(game, options.seconds)
        name = f"{game}, one gym.make env, default wrappers"
        print(f"{name:58}{steps:14,.0f}{steps * 4:14,.0f}", flush=True)
    for keywords, goal in OBSERVATIONS:
        steps = native_rate("Arkanoid-v0", options.worlds, options.seconds, threads=1, **keywords)
        name = "Arkanoid-v0, native, " + ", ".join(f"{k}={v}" for k, v in keywords.items())
        ratio = "" if goal is None else f"   {steps / goal:.2f} x the goal"
        print(f"{name:58}{steps:14,.0f}{steps * 4:14,.0f}{ratio}", flush=True)


if __name__ == "__main__":
    main()
