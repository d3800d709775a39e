"""Whether a level can be cleared: a ball must be able to come to every breakable brick.

A ball comes from below. It passes through every cell but gold (a brick that breaks opens a way
later), up, down and sideways. It does not pass between two golden bricks that meet at a corner; a
gap of one cell is wide enough. Above the lattice the field is open from wall to wall.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import kernel
from ..rules import CELLS, COLUMNS, EMPTY, GOLD

# This bit of a cell's kind is set while a level is searched: a ball can come to the cell.
REACHED = 128

Kinds = Any  # uint8 [n]: the kind of brick in each cell


@kernel
def search_reachable(kinds: Kinds) -> None:
    """Set `REACHED` in all cells that a ball can come to; kinds: uint8 [CELLS].

    An earlier search stays valid when a gap is opened: this one goes on from it.
    """
    # Each round but the last reaches a cell.
    for _ in range(CELLS + 1):
        changed = False
        # Upward first, because most ways lead straight up, then downward.
        for step in range(2 * CELLS):
            cell = CELLS - 1 - step if step < CELLS else step - CELLS
            if kinds[cell] < REACHED and kinds[cell] != GOLD and borders_reached(kinds, cell):
                kinds[cell] |= REACHED
                changed = True
                if cell < COLUMNS:
                    _reach_top_row(kinds)
        if not changed:
            return


@kernel
def _reach_top_row(kinds: Kinds) -> None:
    """Set `REACHED` in the top row, except gold: above the bricks a ball can fly to any column."""
    for column in range(COLUMNS):
        if kinds[column] != GOLD:
            kinds[column] |= REACHED


@kernel
def borders_reached(kinds: Kinds, cell: int) -> bool:
    """Return whether a ball can come to a side of a cell, except the top row's upper side."""
    column = cell % COLUMNS
    if cell >= CELLS - COLUMNS or kinds[cell + COLUMNS] >= REACHED:
        return True
    if cell >= COLUMNS and kinds[cell - COLUMNS] >= REACHED:
        return True
    if column > 0 and kinds[cell - 1] >= REACHED:
        return True
    return bool(column < COLUMNS - 1 and kinds[cell + 1] >= REACHED)


@kernel
def count_unreached(kinds: Kinds) -> int:
    """Return the number of breakable bricks that a search has not reached; kinds: uint8 [CELLS]."""
    count = 0
    for cell in range(CELLS):
        if kinds[cell] != EMPTY and kinds[cell] < GOLD:
            count += 1
    return count


@kernel
def clear_search(kinds: Kinds) -> None:
    """Clear `REACHED` in all cells; kinds: uint8 [CELLS]."""
    for cell in range(CELLS):
        kinds[cell] &= REACHED - 1


def unreachable_bricks(kinds: NDArray[np.uint8]) -> list[tuple[int, int]]:
    """Return the breakable bricks that no ball can reach, as (row, column) from the upper left.

    Args:
        kinds: uint8 [18, 11], the kind of brick in each cell, the top row first.
    """
    if not (kinds == GOLD).any():
        return []
    searched = kinds.ravel().copy()
    search_reachable(searched)
    rows = searched.reshape(kinds.shape)
    found = np.argwhere((rows != EMPTY) & (rows < GOLD))
    return [(int(row), int(column)) for row, column in found]
