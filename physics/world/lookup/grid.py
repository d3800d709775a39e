"""The moving bodies' boxes in a grid of squares, without bounds and with levels for all sizes.

The cells of each level are twice as large as those of the level below. A body is on the first level
whose cells are at least as large as its box, in the cell of the box's middle. So two boxes on one
level can only overlap if their cells are neighbours. The cells are kept in a hash table, so that it
does not matter where bodies are. (Teschner et al., Optimized Spatial Hashing for Collision
Detection of Deformable Objects, VMV 2003; Ericson, *Real-Time Collision Detection*, 7.2.)
"""

import math

from ...kernels import kernel
from ..state.records import BoxRecord, Indices
from ..state.view import (
    LEVELS,
    WorldView,
    boxes_of,
    grid_of,
    header_of,
    heads_of,
    level_counts_of,
    plans_of,
)
from .tree import NO_ONE

MIDDLE_LEVEL = 24  # with the cells that suit typical bodies
# A cell is larger than a box by this fraction, because of rounding. No number of a cell is larger
# than 1e9, see `boxes.FAR`.
SPARE = 1e-6
FARTHEST = 1e12
_BITS = (1 << 26) - 1


@kernel
def cell_size(world: WorldView, level: int) -> float:
    """Return the size of a level's cells; the last level has a single one."""
    if level == LEVELS - 1:
        return math.inf
    size: float = header_of(world).cell
    for _ in range(level, MIDDLE_LEVEL):
        size *= 0.5
    for _ in range(MIDDLE_LEVEL, level):
        size *= 2.0
    return size


@kernel
def number_of(position: float, size: float) -> int:
    """Return the column or row of a position."""
    if size == math.inf:
        return 0
    # No body is so far away, but a query may be.
    return math.floor(max(-FARTHEST, min(FARTHEST, position / size)))


@kernel
def bucket_of(level: int, column: int, row: int, buckets: int) -> int:
    """Return the place of a cell in the table, whose length is a power of two."""
    # Only some bits of the numbers: so nothing overflows.
    mixed = level * 83492791 + (column & _BITS) * 73856093 + (row & _BITS) * 19349663
    return (mixed ^ (mixed >> 15)) & (buckets - 1)


@kernel
def clear_grid(world: WorldView) -> None:
    """Take all bodies out."""
    heads, counts, grid = heads_of(world), level_counts_of(world), grid_of(world)
    for bucket in range(heads.shape[0]):
        heads[bucket] = NO_ONE
    for level in range(LEVELS):
        counts[level] = 0
    grid.lowest = LEVELS
    grid.highest = -1


@kernel
def enter_grid(world: WorldView, slot: int) -> None:
    """Put a body into the cell of its box."""
    plan, box, heads = plans_of(world)[slot], boxes_of(world)[slot], heads_of(world)
    grid, counts = grid_of(world), level_counts_of(world)
    width = max(box.upper_x - box.lower_x, box.upper_y - box.lower_y) * (1.0 + SPARE)
    level, size = MIDDLE_LEVEL, header_of(world).cell
    while level > 0 and 0.5 * size >= width:
        level -= 1
        size *= 0.5
    while level < LEVELS - 1 and not size >= width:
        level += 1
        size = size * 2.0 if level < LEVELS - 1 else math.inf
    box.level = level
    box.column = number_of(0.5 * box.lower_x + 0.5 * box.upper_x, size)
    box.row = number_of(0.5 * box.lower_y + 0.5 * box.upper_y, size)
    bucket = bucket_of(level, box.column, box.row, heads.shape[0])
    first = heads[bucket]
    box.next = first
    plan.previous = NO_ONE
    if first != NO_ONE:
        plans_of(world)[first].previous = slot
    heads[bucket] = slot
    counts[level] += 1
    grid.lowest = min(grid.lowest, level)
    grid.highest = max(grid.highest, level)


@kernel
def leave_grid(world: WorldView, slot: int) -> None:
    """Take a body out of its cell."""
    plans, boxes, heads = plans_of(world), boxes_of(world), heads_of(world)
    previous, box = plans[slot].previous, boxes[slot]
    if box.next != NO_ONE:
        plans[box.next].previous = previous
    if previous != NO_ONE:
        boxes[previous].next = box.next
    else:
        heads[bucket_of(box.level, box.column, box.row, heads.shape[0])] = box.next
    grid, counts = grid_of(world), level_counts_of(world)
    counts[box.level] -= 1
    while grid.highest >= 0 and counts[grid.highest] == 0:
        grid.highest -= 1
    while grid.lowest < LEVELS and counts[grid.lowest] == 0:
        grid.lowest += 1


@kernel
def find_in_grid(
    world: WorldView,
    lower_x: float,
    lower_y: float,
    upper_x: float,
    upper_y: float,
    found: Indices,
    count: int,
) -> int:
    """Append the slots of bodies whose boxes touch or overlap one; return how many there are.

    ``found`` has room for one more than all of them: what is looked at is written first.
    """
    grid, counts = grid_of(world), level_counts_of(world)
    for level in range(grid.lowest, grid.highest + 1):
        if counts[level] > 0:
            count = _find_on_level(world, level, lower_x, lower_y, upper_x, upper_y, found, count)
    return count


@kernel
def _find_on_level(
    world: WorldView,
    level: int,
    lower_x: float,
    lower_y: float,
    upper_x: float,
    upper_y: float,
    found: Indices,
    count: int,
) -> int:
    """Do the same for the bodies on one level."""
    plans, boxes, heads = plans_of(world), boxes_of(world), heads_of(world)
    size = cell_size(world, level)
    # The middle of a box that touches this one is at most half a cell away from it.
    columns = (upper_x - lower_x) / size + 2.0
    rows = (upper_y - lower_y) / size + 2.0
    if not columns * rows <= max(16.0, plans.shape[0]):
        # A box so large that there are fewer bodies than cells.
        for slot in range(plans.shape[0]):
            if plans[slot].is_linked and boxes[slot].level == level:
                found[count] = slot
                count += touch(boxes[slot], lower_x, lower_y, upper_x, upper_y)
        return count
    left = number_of(lower_x - 0.5 * size, size)
    right = number_of(upper_x + 0.5 * size, size)
    low = number_of(lower_y - 0.5 * size, size)
    high = number_of(upper_y + 0.5 * size, size)
    for column in range(left, right + 1):
        for row in range(low, high + 1):
            slot = heads[bucket_of(level, column, row, heads.shape[0])]
            while slot != NO_ONE:
                box = boxes[slot]
                # Several cells may share a bucket.
                found[count] = slot
                count += (
                    touch(box, lower_x, lower_y, upper_x, upper_y)
                    & (box.column == column)
                    & (box.row == row)
                    & (box.level == level)
                )
                slot = box.next
    return count


@kernel
def touch(box: BoxRecord, lower_x: float, lower_y: float, upper_x: float, upper_y: float) -> bool:
    """Return whether a box touches or overlaps another one, which is given by its sides."""
    # Without a branch, which a processor could not foresee.
    return bool(
        (lower_x <= box.upper_x)
        & (upper_x >= box.lower_x)
        & (lower_y <= box.upper_y)
        & (upper_y >= box.lower_y)
    )
