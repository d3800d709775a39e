"""What actions command: the velocity of the paddle, and whether it fires."""

import operator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.kernels import kernel

BOX = "Box(-1.0, 1.0, (2,), float32)"  # the space of continuous actions, in words

# Velocity in [-1, 1] and fire of the discrete actions, float64 [actions, 2].
_MOVES = [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0]]
_MOVES_WITH_FIRE = [[move, 1.0] for move, _ in _MOVES]

COMMANDS = {
    "discrete3": np.array(_MOVES),
    # Those of Atari's Breakout, in its order: its wrappers look for FIRE at 1.
    "discrete4": np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [-1.0, 0.0]]),
    "discrete6": np.array(_MOVES + _MOVES_WITH_FIRE),
}
_WORDS = {-1.0: "LEFT", 0.0: "", 1.0: "RIGHT"}


def action_meanings(actions: str) -> list[str]:
    """Return the Atari's word for each discrete action, ``"LEFTFIRE"`` say.

    Raises:
        ValueError: the actions are continuous.
    """
    if actions not in COMMANDS:
        raise ValueError(f"actions={actions!r} are continuous: no action has a meaning of its own")
    words = [_WORDS[move] + ("FIRE" if fire else "") for move, fire in COMMANDS[actions].tolist()]
    return [word or "NOOP" for word in words]


def read_discrete(action: Any, count: int) -> int:
    """Return the number of one discrete action: an integer of Python, NumPy, torch or JAX.

    Arrays have no axes: [1] is no integer. Neither is True.

    Raises:
        TypeError: it is no integer.
        ValueError: it is not in the space.
    """
    number = action if type(action) is int else _integer(action)
    if number is None:
        raise TypeError(f"action {action!r} is not in Discrete({count}): it must be one integer")
    if not 0 <= number < count:
        raise ValueError(f"action {action!r} is not in Discrete({count})")
    return number


def _integer(action: Any) -> int | None:
    """Return an integer that is not Python's own, or None if it is none."""
    if isinstance(action, np.integer):
        return int(action)
    # A tensor of one number has an index even if it has axes, or if it is a boolean.
    if getattr(action, "shape", ()) != () or "bool" in str(getattr(action, "dtype", type(action))):
        return None
    try:
        return operator.index(action)
    except TypeError:
        return None


def read_array(actions: Any, space: str) -> NDArray[Any]:
    """Return actions as an array.

    Args:
        space: theirs, in words.

    Raises:
        TypeError: they are none: rows of different lengths, or a tensor that NumPy can't read.
    """
    try:
        return np.asarray(actions)
    except (RuntimeError, TypeError, ValueError) as error:
        raise TypeError(f"{actions!r:.200} is not in {space}, and no array: {error}") from error


def as_float32(actions: NDArray[Any]) -> NDArray[np.float32]:
    """Return numbers as the space of continuous actions has them; what is too large is infinite."""
    with np.errstate(all="ignore"):
        return actions.astype(np.float32, order="C")


def read_box(action: Any) -> tuple[float, float]:
    """Return the velocity in [-1, 1], a float32, and fire (0 or 1) of one continuous action.

    Raises:
        TypeError: it is not two numbers.
        ValueError: it has a NaN.
    """
    array = read_array(action, BOX)
    if array.shape != (2,) or array.dtype.kind not in "iuf":
        raise TypeError(f"action {action!r} is not in {BOX}: it must be velocity and fire")
    move, fire = (array if array.dtype == np.float32 else as_float32(array)).tolist()
    if move != move or fire != fire:
        raise ValueError(f"action {action!r} is not in {BOX}: it has a NaN")
    return max(-1.0, min(1.0, move)), 1.0 if fire > 0.0 else 0.0


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
    """Write what box actions (float32 [n, 2]) command; return the first NaN's world or -1.

    What is outside of the bounds counts as at the bound: a float32 is often rounded past it.

    Args:
        commands: float64 [n, 2].
    """
    for index in range(actions.shape[0]):
        move, fire = actions[index, 0], actions[index, 1]
        if move != move or fire != fire:
            return index
        commands[index, 0] = max(-1.0, min(1.0, move))
        commands[index, 1] = 1.0 if fire > 0.0 else 0.0
    return -1
