"""The games that are compared: this project's, and those of its peers that are installed.

Every module has functions that make a `Game`, all of which are used in the same way::

    game = ale_games.one()
    game.play(100)  # decisions, with random actions; resets are included
    game.worlds  # the number of worlds that each decision steps
    game.close()
"""

import importlib
import itertools
from collections.abc import Iterator
from types import ModuleType
from typing import Any, Protocol

import gymnasium as gym
import numpy as np
import numpy.typing as npt

# The name of each peer, which is its package's, and its module here.
PEERS = {
    "MinAtar": "minatar_games",
    "ale-py": "ale_games",
    "env-breakoutatari2600-turbo-native": "turbo_games",
}
ACTIONS = 1000  # decisions until the actions repeat


class Game(Protocol):
    """Worlds of a game that are played together."""

    worlds: int

    def play(self, decisions: int) -> None:
        """Play a number of decisions in every world."""

    def close(self) -> None: ...


class One:
    """A Gymnasium environment, reset when an episode ends."""

    worlds = 1

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        self.env = env
        env.reset(seed=0)
        actions = np.random.default_rng(0).integers(0, env.action_space.n, ACTIONS)
        self.actions: Iterator[int] = itertools.cycle(actions.tolist())

    def play(self, decisions: int) -> None:
        env = self.env
        for action in itertools.islice(self.actions, decisions):
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

    def close(self) -> None:
        self.env.close()


class Many:
    """A Gymnasium vector environment that begins new episodes by itself."""

    def __init__(self, env: gym.vector.VectorEnv[Any, Any, Any]) -> None:
        self.env = env
        self.worlds = env.num_envs
        env.reset(seed=0)
        shape = (ACTIONS, self.worlds)
        actions = np.random.default_rng(0).integers(0, env.single_action_space.n, shape)
        self.actions: Iterator[npt.NDArray[np.int64]] = itertools.cycle(actions)

    def play(self, decisions: int) -> None:
        step = self.env.step
        for actions in itertools.islice(self.actions, decisions):
            step(actions)

    def close(self) -> None:
        self.env.close()


def peer(name: str) -> ModuleType | None:
    """Return the module for a peer; None if a package that it needs is not installed."""
    try:
        return importlib.import_module(f".{PEERS[name]}", __name__)
    except ImportError:
        return None
