"""What actions command: the velocity of the paddle, and whether it fires."""

from typing import Any

import numpy as np

from ..physics.kernels import kernel

# Velocity in [-1, 1] and fire of the discrete actions, float64 [actions, 2].
_MOVES = [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0]]
_MOVES_WITH_FIRE = [[move, 1.0] for move, _ in _MOVES]

COMMANDS = {
    "discrete3": np.array(_MOVES),
    "discrete6": np.array(_MOVES + _MOVES_WITH_FIRE),
}


@kernel
def decode_actions(actions: Any, table: Any, commands: Any) -> int:
    """Write what discrete actions (int64 [n]) command; return the first illegal one's world or -1.

    Args:
        table: float64 [actions, 2]; commands: float64 [n, 2].
    """
    for index in range(actions.shape[0]):
        action = actions[index]
        if action < 0 or action >= table.shape[0]:
            return index
        commands[index, 0] = table[action, 0]
        commands[index, 1] = table[action, 1]
    return -1


@kernel
def decode_velocities(actions: Any, commands: Any) -> int:
    """Write what box actions (float64 [n, 2]) command; return the first illegal one's world or -1.

    Args:
        commands: float64 [n, 2].
    """
    for index in range(actions.shape[0]):
        move, fire = actions[index, 0], actions[index, 1]
        # In this order a NaN is illegal.
        if not (-1.0 <= move <= 1.0 and -1.0 <= fire <= 1.0):
            return index
        commands[index, 0] = move
        commands[index, 1] = 1.0 if fire > 0.0 else 0.0
    return -1
