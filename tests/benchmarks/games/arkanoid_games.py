"""This project's environments, as `gym.make` and `gym.make_vec` make them."""

from typing import Any

import arkanoid  # noqa: F401
import gymnasium as gym

from . import Many, One


def one(name: str, **keywords: Any) -> One:
    """Return one world, with the default wrappers."""
    return One(gym.make(name, **keywords))


def many(name: str, worlds: int, threads: int = 1, **keywords: Any) -> Many:
    """Return the native vector environment; observations are not copied."""
    return Many(
        gym.make_vec(name, worlds, "vector_entry_point", copy=False, threads=threads, **keywords)
    )
