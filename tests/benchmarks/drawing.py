"""Measures the microseconds per picture, of games that go on between the pictures.

Run: python tests/benchmarks/drawing.py [--worlds 256] [--steps 400]
"""

import argparse
import time
from typing import Any

import numpy as np
from arkanoid.envs.batch.batch import Autoreset, Batch
from arkanoid.envs.config import Config
from arkanoid.envs.draw.canvas import Drawn
from arkanoid.envs.draw.frame import draw_frame
from arkanoid.envs.draw.scenery import make_scenery
from arkanoid.physics.kernels import kernel

SIZES = [(84, 84, 1), (84, 84, 3), (210, 160, 3), (512, 384, 3)]


@kernel
def draw_worlds(
    pictures: Any, lines: Any, drawn: Any, sheets: Any, worlds: Any, rules: Any
) -> None:
    """Draw every world into its picture."""
    for index in range(worlds.shape[0]):
        draw_frame(pictures[index], lines[index], drawn[index], sheets, worlds[index], rules[0])


def seconds(batch: Batch, size: tuple[int, int, int], steps: int, anew: bool) -> float:
    """Return the seconds per picture; anew: nothing of the previous picture is used."""
    count = len(batch.worlds)
    pictures = np.zeros((count, *size), np.uint8)
    lines = pictures.reshape(count, size[0], -1)
    drawn = np.zeros(count, Drawn)
    generator = np.random.default_rng(0)
    sheets = make_scenery(*size)
    total = 0.0
    for step in range(steps):
        batch.command(generator.integers(0, 3, count))
        batch.step()
        if anew:
            drawn["begun"] = 0
        start = time.perf_counter()
        draw_worlds(pictures, lines, drawn, sheets, batch.worlds, batch.rules)
        if step >= 20:
            total += time.perf_counter() - start
    return total / ((steps - 20) * count)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=256)
    parser.add_argument("--steps", type=int, default=400, help="steps of 4 ticks per row")
    options = parser.parse_args()
    print(f"{'microseconds a picture':32}{'what differs':>14}{'everything':>14}")
    for levels in ("campaign", "warden"):
        for size in SIZES:
            times = []
            for anew in (False, True):
                config = Config(actions="discrete3", levels=levels)
                batch = Batch(options.worlds, config, Autoreset.NEXT_STEP, threads=1)
                for index in range(options.worlds):
                    batch.seed(index, index)
                batch.reset(np.ones(options.worlds, np.bool_))
                times.append(seconds(batch, size, options.steps, anew) * 1e6)
            name = f"{levels}, {size[0]} x {size[1]} x {size[2]}"
            print(f"{name:32}{times[0]:14.2f}{times[1]:14.2f}")


if __name__ == "__main__":
    main()
