"""Policies without a network, to compare agents with."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from gymnasium.spaces import Discrete
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

# Takes observations [worlds, ...] and returns actions [worlds, ...].
Policy = Callable[[NDArray[Any]], NDArray[Any]]

NO_OP, LEFT, RIGHT = 0, 1, 2

# In units of half the field's width. The paddle moves 0.76 brick widths, or 0.14 of this unit, in a
# decision of four ticks: within half of that a move would overshoot, and the paddle would tremble.
_DEAD_ZONE = 0.07


def no_op(observations: NDArray[Any]) -> NDArray[np.int64]:
    """Return the actions [worlds] of somebody who only watches."""
    return np.full(len(observations), NO_OP, np.int64)


class RandomPolicy:
    """Draws every action with the same probability, from a generator of its own."""

    def __init__(self, num_actions: int, seed: int) -> None:
        self._num_actions = num_actions
        self._random = np.random.default_rng(seed)

    def __call__(self, observations: NDArray[Any]) -> NDArray[np.int64]:
        """Return actions [worlds]."""
        return self._random.integers(self._num_actions, size=len(observations))


class BallFollower:
    """Keeps the paddle's middle below the first ball; never fires.

    ``layout`` names the slices of an observation: ``"paddle"`` and ``"ball_x"`` begin with the
    paddle's middle and the first ball's position across the field, on the same scale.
    """

    def __init__(self, layout: Mapping[str, slice]) -> None:
        self._paddle = layout["paddle"].start
        self._ball = layout["ball_x"].start

    def __call__(self, observations: NDArray[Any]) -> NDArray[np.int64]:
        """Return the actions [worlds] for observations [worlds, size]."""
        gap = observations[:, self._ball] - observations[:, self._paddle]
        return np.where(gap < -_DEAD_ZONE, LEFT, np.where(gap > _DEAD_ZONE, RIGHT, NO_OP))


def make_baselines(worlds: VectorEnv[Any, Any, Any], seed: int) -> dict[str, Policy]:
    """Return the baselines that can play in ``worlds``, by name.

    The ball-follower is among them where the observation has named slices (``layout``). Raises
    ValueError if the actions are not `Discrete`.
    """
    space = worlds.single_action_space
    if not isinstance(space, Discrete):
        raise ValueError(f"the baselines play with Discrete actions, not {space}")
    policies: dict[str, Policy] = {
        "no-op": no_op,
        "random": RandomPolicy(int(space.n), seed),
    }
    layout = getattr(worlds.unwrapped, "layout", None)
    if layout is not None:
        policies["ball-follower"] = BallFollower(layout)
    return policies
