"""What an observation shows at present, so that only what has changed is written.

This memory belongs to the observation, not to the game: any number of observers can look at the
same world, at any time, and none of them writes to it.
"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import inlined
from ..state import MAX_CHANGES, WorldRecord

# Of one observation, int64 [3]. Not a record: NumPy takes longer to pass one to a kernel.
ShownRow: TypeAlias = Any
SHOWN_CHANGES = 0  # the world's `brick_changes` when the bricks were written
SHOWN_CAPSULES = 1  # 1: numbers of capsules, powers or beams are not all zero
SHOWN_ENEMIES = 2  # 1: numbers of enemies, the boss or shards are not all zero

ALL_BRICKS = -1
UNKNOWN = -(2**62)  # no world remembers all changes since then


def nothing_shown(num_worlds: int) -> NDArray[np.int64]:
    """Return what observations that are all zeros show, int64 [n, 3]."""
    return np.zeros((num_worlds, 3), np.int64)


def forget_shown(shown: NDArray[np.int64]) -> None:
    """Note that observations may show anything, so that all of their numbers are written anew."""
    shown[:] = UNKNOWN, 1, 1


def check_within(observations: NDArray[Any], low: float, high: float) -> None:
    """Raise a ValueError if a number of observations is out of a range, or NaN."""
    if not (observations.min() >= low and observations.max() <= high):
        raise ValueError(f"an observation can't be: a number is not between {low:g} and {high:g}")


@inlined
def bricks_to_write(world: WorldRecord, shown: ShownRow) -> int:
    """Return how many of the latest changes of bricks are not shown yet, or `ALL_BRICKS`.

    It notes that they are shown, so the caller must write them.
    """
    changes = world.brick_changes - shown[SHOWN_CHANGES]
    if changes == 0:
        return 0
    shown[SHOWN_CHANGES] = world.brick_changes
    return changes if 0 < changes <= MAX_CHANGES else ALL_BRICKS


@inlined
def changed_cell(world: WorldRecord, change: int) -> int:
    """Return the cell of one of the latest changes, counted back from 0, the latest of all."""
    return int(world.changed_cells[(world.brick_changes - change) % MAX_CHANGES])
