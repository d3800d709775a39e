"""Measures how long a program waits for its first step, with and without compiled kernels on disk.

Run: python tests/benchmarks/startup.py [--warm 5]

Every line is a new process. At a cold start the folder of compiled kernels is empty, as after an
installation or an edit of a kernel; every later start is warm. The goals are 12 s and 0.6 s on two
cores.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

GOALS = {"cold": 12.0, "warm": 0.6}  # seconds
PHASES = ("import", "make", "reset", "step")
PROGRAM = """
import json, sys, time
times = [time.perf_counter()]
def done(): times.append(time.perf_counter())
import gymnasium as gym
import arkanoid
done()
env = gym.make("arkanoid:Arkanoid-v0")
done()
env.reset(seed=0)
done()
env.step(env.action_space.sample())
done()
env.close()
print(json.dumps([after - before for before, after in zip(times, times[1:])]))
"""


def measure(cache: str) -> list[float]:
    """Return the seconds of each phase, in a new process that keeps its kernels in ``cache``."""
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        # Python keeps its bytecode, as it does for users.
        env={**os.environ, "ARKANOID_CACHE_DIR": cache, "PYTHONDONTWRITEBYTECODE": ""},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    seconds: list[float] = json.loads(done.stdout)
    return seconds


def show(start: str, seconds: list[float]) -> None:
    columns = "".join(f"{value:9.3f}" for value in (*seconds, sum(seconds)))
    print(f"{start:8}{columns}{GOALS[start]:9.1f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--warm", type=int, default=5, help="number of warm starts (default: 5)")
    warm_starts = parser.parse_args().warm
    print(f"{'seconds':8}{''.join(f'{name:>9}' for name in (*PHASES, 'total', 'goal'))}")
    with tempfile.TemporaryDirectory() as cache:
        show("cold", measure(cache))
        for _ in range(warm_starts):
            show("warm", measure(cache))


if __name__ == "__main__":
    main()
