"""Microseconds a picture, of games that are played on between the pictures.

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
from arkanoid.envs.draw.scenery import scenery
from arkanoid.physics.kernels.decorators import kernel

SIZES = [(84, 84, 1), (84, 84, 3), (210, 160, 3), (512, 384, 3)]


@kernel
def draw_worlds(
    pictures: Any, lines: Any, drawn: Any, sheets: Any, worlds: Any, rules: Any
) -> None:
    """Draw each world into its picture."""
    for index in range(worlds.shape[0]):
        draw_frame(pictures[index], lines[index], drawn[index], sheets, worlds[index], rules[0])


def seconds(batch: Batch, size: tuple[int, int, int], steps: int, anew: bool) -> float:
    """Return the seconds a picture takes; anew: nothing of the picture before is used."""
    number = len(batch.worlds)
    pictures = np.zeros((number, *size), np.uint8)
    lines = pictures.reshape(number, size[0], -1)
    drawn = np.zeros(number, Drawn)
    generator = np.random.default_rng(0)
    sheets = scenery(*size)
    total = 0.0
    for step in range(steps):
        batch.command(generator.integers(0, 3, number))
        batch.step()
        if anew:
            drawn["begun"] = 0
        start = time.perf_counter()
        draw_worlds(pictures, lines, drawn, sheets, batch.worlds, batch.rules)
        if step >= 20:
            total += time.perf_counter() - start
    return total / ((steps - 20) * number)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=256)
    parser.add_argument("--steps", type=int, default=400, help="of 4 ticks, for each row")
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
