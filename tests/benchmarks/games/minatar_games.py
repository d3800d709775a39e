"""MinAtar's breakout: a ball on a grid of 10 × 10, in Python. It has no vector environment."""

import itertools
from collections.abc import Iterator

import gymnasium as gym
import minatar
import minatar.gym
import numpy as np

from . import ACTIONS, One


class Own:
    """MinAtar's own class, without Gymnasium: act, then ask for the state."""

    worlds = 1

    def __init__(self) -> None:
        self.env = minatar.Environment("breakout")
        self.env.seed(0)
        self.env.reset()
        choice = self.env.minimal_action_set()
        actions = np.random.default_rng(0).choice(choice, ACTIONS)
        self.actions: Iterator[int] = itertools.cycle(actions.tolist())

    def play(self, decisions: int) -> None:
        env = self.env
        for action in itertools.islice(self.actions, decisions):
            _, terminal = env.act(action)
            env.state()
            if terminal:
                env.reset()
                env.state()

    def close(self) -> None:
        """There is nothing to close."""


def own() -> Own:
    return Own()


def one() -> One:
    """Return the same game through `gym.make`, with the default wrappers."""
    name = "MinAtar/Breakout-v1"
    if name not in gym.registry:
        minatar.gym.register_envs()
    return One(gym.make(name))
