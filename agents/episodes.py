"""Playing whole episodes with a policy, one a seed, many at once."""

from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from .adapter import GymnasiumVecEnv
from .baselines import Policy

# What an episode's info tells of it: as it is at its end, or summed over its decisions.
FINAL_KEYWORDS = ("score", "lives", "round", "bricks_left")
SUMMED_KEYWORDS = ("hits",)


def adapt(worlds: VectorEnv[Any, Any, Any]) -> GymnasiumVecEnv:
    """Return the worlds for stable-baselines3, with the game's own statistics of each episode."""
    return GymnasiumVecEnv(worlds, FINAL_KEYWORDS, SUMMED_KEYWORDS)


def play_episodes(
    worlds: VectorEnv[Any, Any, Any], policy: Policy, seed: int
) -> dict[str, NDArray[np.float64]]:
    """Play one episode in each world, world *i* with seed ``seed + i``.

    Returns what was reached, an array [worlds] for each of ``return``, ``steps`` (decisions) and
    the keywords above. Only a world's first episode counts: taking whichever episodes end first
    would favour short ones.
    """
    venv = adapt(worlds)
    venv.seed(seed)
    observations = venv.reset()
    first: list[dict[str, float] | None] = [None] * venv.num_envs
    while any(episode is None for episode in first):
        assert isinstance(observations, np.ndarray)
        observations, _, dones, infos = venv.step(policy(observations))
        for world in np.flatnonzero(dones).tolist():
            first[world] = first[world] or infos[world]["episode"]
    episodes = [episode for episode in first if episode is not None]
    keys = {"return": "r", "steps": "l", **{key: key for key in FINAL_KEYWORDS + SUMMED_KEYWORDS}}
    return {
        name: np.array([episode[key] for episode in episodes], np.float64)
        for name, key in keys.items()
    }
