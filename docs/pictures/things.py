"""Draws the pictures of `things.md` and the film of `environment.md`.

Run it as ``python docs/pictures/things.py [folder]``.
"""

import sys
from pathlib import Path
from typing import Any

import gymnasium as gym
import imageio.v3 as iio
from arkanoid.agents.show.film import write_film
from arkanoid.envs.play.things import (
    BOSS_THING,
    BRICK_THINGS,
    CAPSULE_THINGS,
    ENEMY_THINGS,
    SHARD_THING,
    draw_icon,
    draw_things,
)

SCALE = 48  # pixels per brick width
FILM = "game.gif"
DECISIONS = 180
THINGS = {
    **{f"capsule-{thing.name[0]}": thing for thing in CAPSULE_THINGS},
    **{f"brick-{thing.name}": thing for thing in BRICK_THINGS},
    **{f"enemy-{number}": thing for number, thing in enumerate(ENEMY_THINGS, 1)},
    "boss": BOSS_THING,
    "shard": SHARD_THING,
}


def film(path: Path) -> None:
    """Write a film in which the paddle follows where the lowest ball will land."""
    env: Any = gym.make(
        "arkanoid:Arkanoid-v0",
        render_mode="rgb_array",
        render_size=256,
        landing=True,
        capsule_rate=0.6,
        levels="honeycomb",
    )
    parts = env.unwrapped.layout
    observation, _ = env.reset(seed=11)
    pictures = []
    for _ in range(DECISIONS):
        pictures.append(env.render())
        known = observation[parts["landing_known"]] > 0
        soonest = (observation[parts["landing_ticks"]] + ~known).argmin()
        away = observation[parts["landing_x"]][soonest] - observation[parts["paddle"]][0]
        observation, *_ = env.step(3 if abs(away) < 0.05 else 5 if away > 0 else 4)
    env.close()
    write_film(path, pictures, 15.0)


def main(folder: Path) -> None:
    """Write all pictures into a folder."""
    things = folder / "things"
    things.mkdir(exist_ok=True)
    for name, picture in zip(THINGS, draw_things(tuple(THINGS.values()), SCALE)[0], strict=True):
        iio.imwrite(things / f"{name}.png", picture, compress_level=9)
    iio.imwrite(folder / "icon.png", draw_icon(), compress_level=9)
    film(folder / FILM)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
