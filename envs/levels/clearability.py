"""Whether a level can be cleared: every breakable brick must be within a ball's reach.

A ball comes from below, through every cell but gold (a brick that breaks is a way, later), from
side to side and up and down: between two golden bricks that meet at a corner nothing passes, and a
gap of one cell is wide enough. Above the lattice the field is open from wall to wall.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import kernel
from ..rules import CELLS, COLUMNS, EMPTY, GOLD

# Set, in a cell's kind, while its level is searched: a ball can come here.
REACHED = 128


@kernel
def mark_reachable(kinds: Any) -> None:
    """Mark with `REACHED` all cells that a ball can come to; kinds: uint8 [CELLS].

    Marks that are there stay, so that a level with one more gap needs only the rest of the search.
    """
    changed = True
    while changed:
        changed = False
        # Both ways, because most ways lead straight up, and the rest up and down in turn.
        for step in range(2 * CELLS):
            cell = CELLS - 1 - step if step < CELLS else step - CELLS
            if kinds[cell] < REACHED and kinds[cell] != GOLD and borders_reached(kinds, cell):
                kinds[cell] |= REACHED
                changed = True
                if cell < COLUMNS:
                    _mark_top_row(kinds)


@kernel
def _mark_top_row(kinds: Any) -> None:
    """Mark the whole top row but its gold: a ball above the bricks can fly to any column."""
    for column in range(COLUMNS):
        if kinds[column] != GOLD:
            kinds[column] |= REACHED


@kernel
def borders_reached(kinds: Any, cell: int) -> bool:
    """Tell whether a ball can come to a side of a cell (the top row's upper side apart)."""
    column = cell % COLUMNS
    if cell >= CELLS - COLUMNS or kinds[cell + COLUMNS] >= REACHED:
        return True
    if cell >= COLUMNS and kinds[cell - COLUMNS] >= REACHED:
        return True
    if column > 0 and kinds[cell - 1] >= REACHED:
        return True
    return bool(column < COLUMNS - 1 and kinds[cell + 1] >= REACHED)


@kernel
def count_unreached(kinds: Any) -> int:
    """Return the number of breakable bricks without a mark; kinds: uint8 [CELLS]."""
    count = 0
    for cell in range(CELLS):
        if kinds[cell] != EMPTY and kinds[cell] < GOLD:
            count += 1
    return count


@kernel
def clear_marks(kinds: Any) -> None:
    """Take all marks away again; kinds: uint8 [CELLS]."""
    for cell in range(CELLS):
        kinds[cell] &= REACHED - 1


@kernel
def unreachable(kinds: Any) -> int:
    """Return the number of breakable bricks that no ball can reach; kinds: uint8 [CELLS].

    The kinds are marked while this runs, and unmarked at its end.
    """
    mark_reachable(kinds)
    count = count_unreached(kinds)
    clear_marks(kinds)
    return count


def unreachable_bricks(kinds: NDArray[np.uint8]) -> list[tuple[int, int]]:
    """Return the breakable bricks that no ball can reach, as (row, column) from the upper left.

    Args:
        kinds: uint8 [18, 11], a level's bricks by their kinds, the top row first.
    """
    if not (kinds == GOLD).any():
        return []
    marked = kinds.ravel().copy()
    mark_reachable(marked)
    rows = marked.reshape(kinds.shape)
    found = np.argwhere((rows != EMPTY) & (rows < GOLD))
    return [(int(row), int(column)) for row, column in found]
