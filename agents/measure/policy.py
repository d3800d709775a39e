"""A policy, and its moves in each form that actions can have."""

from typing import Any, Protocol

import numpy as np
from gymnasium.spaces import Discrete
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from ...envs.actions import COMMANDS
from ...envs.rules import PADDLE_SPEED
from ..experiment.worlds import native


class Policy(Protocol):
    """An agent or a baseline.

    One that has an attribute ``device`` which is not None plays in worlds on that device, and is
    given tensors of torch.
    """

    def __call__(self, observations: Any, worlds: NDArray[np.int64]) -> NDArray[Any]:
        """Return actions [n, ...] for observations [n, ...] of worlds, given by indices [n]."""
        ...


def device_of(policy: Policy) -> str | None:
    """Return where the worlds are that a policy plays in; None: here, with NumPy's arrays."""
    device: str | None = getattr(policy, "device", None)
    return device


def encode_actions(space: Any, moves: NDArray[Any], fire: bool = False) -> NDArray[Any]:
    """Return the actions that move the paddle, and fire if the action space can.

    Args:
        space: `Discrete`, one of `actions.COMMANDS`; or `Box`: velocity and fire.
        moves: how far, [n]; 1 is the most that the paddle can move in a decision. A discrete action
            moves so far or not at all, whichever ends nearer: otherwise the paddle would tremble.
        fire: whether to fire, if an action does so and moves as wanted.
    """
    if isinstance(space, Discrete):
        (table,) = (table for table in COMMANDS.values() if len(table) == space.n)
        wanted = np.where(moves < -0.5, -1.0, np.where(moves > 0.5, 1.0, 0.0))
        fits = table[:, 0] == wanted[:, np.newaxis]
        # Of those that move so, the one that fires or does not, or else the only one.
        actions: NDArray[np.int64] = (2 * fits + (fits & (table[:, 1] == fire))).argmax(axis=1)
        return actions
    velocities = np.clip(moves, -1.0, 1.0)
    return np.stack([velocities, np.full(len(moves), 1.0 if fire else -1.0)], 1, dtype=np.float32)


def paddle_reach(worlds: VectorEnv[Any, Any, Any]) -> float:
    """Return how far the paddle can move in a decision, in brick widths."""
    return PADDLE_SPEED * float(native(worlds).config.frame_skip)
