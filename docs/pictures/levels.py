"""Draws the pictures of `levels.md`: ``python docs/pictures/levels.py``."""

import sys
from pathlib import Path
from typing import Any

import gymnasium as gym
import imageio.v3 as iio
import numpy as np
from arkanoid.envs.levels import CAMPAIGN
from arkanoid.envs.levels.generator import make_recipe
from arkanoid.envs.levels.motifs import MOTIFS
from numpy.typing import NDArray

NAMED = "named_levels.png"
GENERATED = "generated_levels.png"
DIFFICULTIES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)


def sheet(starts: list[dict[str, Any]], columns: int) -> NDArray[np.uint8]:
    """Return the first pictures of episodes that begin with these options, in rows."""
    env = gym.make("arkanoid:Arkanoid-v0", render_mode="rgb_array")
    frames = []
    for options in starts:
        env.reset(seed=0, options=options)
        frame: Any = env.render()
        # Half the resolution, without the score line and the space below the paddle.
        frames.append(frame[48:460:2, ::2])
    env.close()
    frames += [np.zeros_like(frames[0])] * (-len(frames) % columns)
    rows = [np.concatenate(frames[at : at + columns], 1) for at in range(0, len(frames), columns)]
    return np.concatenate(rows)


def named_levels() -> NDArray[np.uint8]:
    """Return a picture of the campaign's levels, row by row."""
    return sheet([{"level": name} for name in CAMPAIGN], 5)


def generated_levels() -> NDArray[np.uint8]:
    """Return a picture with one row per motif; difficulty rises from left to right."""
    starts = []
    for motif in MOTIFS.values():
        for column, difficulty in enumerate(DIFFICULTIES):
            seed = 100 * column
            while make_recipe(seed, difficulty).motif != motif:
                seed += 1
            starts.append({"seed": seed, "difficulty": difficulty})
    return sheet(starts, len(DIFFICULTIES))


def main(folder: Path) -> None:
    """Write both pictures into a folder."""
    iio.imwrite(folder / NAMED, named_levels(), compress_level=9)
    iio.imwrite(folder / GENERATED, generated_levels(), compress_level=9)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
