"""Policies without a network, to compare agents with."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium.spaces import Discrete
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from ...envs.rules import FIELD_WIDTH
from ..experiment.worlds import native
from .landing import next_ball
from .planner import Planner
from .policy import Policy, encode_actions, paddle_reach


class NoOp:
    """Does nothing."""

    def __init__(self, space: Any) -> None:
        self._space = space

    def __call__(self, observations: NDArray[Any], worlds: NDArray[np.int64]) -> NDArray[Any]:
        """Return the actions that do nothing."""
        return encode_actions(self._space, np.zeros(len(worlds)))


class RandomPolicy:
    """Draws every action with the same probability, from a generator of its own.

    A world's n-th action does not depend on which other worlds still play.
    """

    def __init__(self, space: Any, num_worlds: int, seed: int) -> None:
        self._space = space
        self._num_worlds = num_worlds
        self._random = np.random.default_rng(seed)

    def __call__(self, observations: NDArray[Any], worlds: NDArray[np.int64]) -> NDArray[Any]:
        """Return random actions."""
        if isinstance(self._space, Discrete):
            return self._random.integers(int(self._space.n), size=self._num_worlds)[worlds]
        size = (self._num_worlds, *self._space.shape)
        return self._random.uniform(-1.0, 1.0, size)[worlds].astype(np.float32)


class BallFollower:
    """Keeps the paddle's middle below the first ball; never fires.

    ``layout`` names the slices of an observation: ``"paddle"`` and ``"ball_x"`` begin with the
    paddle's middle and the first ball's position across the field, on the same scale. ``reach`` is
    how far the paddle can move in a decision, on that scale.
    """

    def __init__(self, space: Any, layout: Mapping[str, slice], reach: float) -> None:
        self._space = space
        self._reach = reach
        self._paddle = layout["paddle"].start
        self._ball = layout["ball_x"].start

    def __call__(self, observations: NDArray[Any], worlds: NDArray[np.int64]) -> NDArray[Any]:
        """Return actions for observations [n, size]."""
        gap = observations[:, self._ball] - observations[:, self._paddle]
        return encode_actions(self._space, gap / self._reach)


class LandingFollower:
    """Keeps the paddle's middle where the next ball comes down; fires if it can.

    It foresees the walls but nothing else. While no ball falls, it follows the first one.

    ``layout`` names the slices of an observation, and ``reach`` is how far the paddle can move in a
    decision, in brick widths.
    """

    def __init__(self, space: Any, layout: Mapping[str, slice], reach: float) -> None:
        self._space = space
        self._layout = layout
        self._reach = reach

    def __call__(self, observations: NDArray[Any], worlds: NDArray[np.int64]) -> NDArray[Any]:
        """Return actions for observations [n, size]."""
        target, _ = next_ball(observations, self._layout)
        middle = (observations[:, self._layout["paddle"].start] + 1.0) * (FIELD_WIDTH / 2)
        return encode_actions(self._space, (target - middle) / self._reach, fire=True)


def make_baseline(name: str, worlds: VectorEnv[Any, Any, Any], seed: int) -> Policy:
    """Return a baseline by its name, to play in ``worlds``, whose observation is ``vector``."""
    space = worlds.single_action_space
    layout: Mapping[str, slice] = native(worlds).layout
    if name == "no-op":
        return NoOp(space)
    if name == "random":
        return RandomPolicy(space, worlds.num_envs, seed)
    if name == "ball-follower":
        return BallFollower(space, layout, paddle_reach(worlds) * 2 / FIELD_WIDTH)
    if name == "landing-follower":
        return LandingFollower(space, layout, paddle_reach(worlds))
    return Planner(worlds)
