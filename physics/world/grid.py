"""The broad phase: a uniform grid of square cells; those at its border extend to infinity.

A static body is entered once, into every cell from which a moving body may touch it. A moving body
is in the cell of its position. A cell is as large as the largest moving body, so that two of them
can only touch from the same cell or neighbouring cells. A moving body that is too large for that
*roams*: it is tested against every body. So is a static body that is unbounded, or in too many
cells.
"""

import math

from ..kernels import kernel
from .records import Box, Boxes, HeaderRecord, Headers, Indices, TraitRecord
from .view import (
    WorldView,
    boundless_of,
    firsts_of,
    header_of,
    heads_of,
    items_of,
    motions_of,
    moving_of,
    near_of,
    plans_of,
    roaming_of,
    traits_of,
)

NO_ONE = -1


@kernel
def cell_index(position: float, start: float, cell: float, count: int) -> int:
    """Return the column or row of a position; a position outside belongs to the border."""
    # Clamped as a float: a position may be too large for an integer.
    return int(max(0.0, min(count - 1.0, math.floor((position - start) / cell))))


@kernel
def covered_cells(header: HeaderRecord, box: Box, reach: float) -> tuple[int, int, int, int]:
    """Return (first_column, last_column, first_row, last_row) of a box (lower x, y, upper x, y).

    Only from there can a moving body touch it whose points are within ``reach`` of its position.
    """
    return (
        cell_index(box[0] - reach, header.left, header.cell, header.columns),
        cell_index(box[2] + reach, header.left, header.cell, header.columns),
        cell_index(box[1] - reach, header.bottom, header.cell, header.rows),
        cell_index(box[3] + reach, header.bottom, header.cell, header.rows),
    )


@kernel
def count_cells(
    headers: Headers, boxes: Boxes, reach: float, covered: Indices, counts: Indices
) -> None:
    """Count how many cells each box covers, and how many boxes cover each cell.

    Args:
        headers: the world's header, which describes the grid.
        boxes: float64 [n, 4]; reach: see `covered_cells`.
        covered: int64 [n]; on entry -1 for boxes to skip, on return the number of cells.
        counts: int64 [cells + 1], zeros on entry; cell c is counted in c + 1.
    """
    header = headers[0]
    for index in range(boxes.shape[0]):
        if covered[index] < 0:
            continue
        first_x, last_x, first_y, last_y = covered_cells(header, boxes[index], reach)
        covered[index] = (last_x - first_x + 1) * (last_y - first_y + 1)
        for row in range(first_y, last_y + 1):
            for column in range(first_x, last_x + 1):
                counts[row * header.columns + column + 1] += 1


@kernel
def fill_cells(
    headers: Headers, boxes: Boxes, reach: float, bodies: Indices, ends: Indices, items: Indices
) -> None:
    """Enter the boxes' bodies into the cells that they cover.

    Args:
        headers, boxes, reach: as for `count_cells`.
        bodies: int64 [n], the body of each box.
        ends: int64 [cells], where each cell's items begin; on return, where they end.
        items: int64, on return the bodies, cell by cell.
    """
    header = headers[0]
    for index in range(boxes.shape[0]):
        first_x, last_x, first_y, last_y = covered_cells(header, boxes[index], reach)
        for row in range(first_y, last_y + 1):
            for column in range(first_x, last_x + 1):
                cell = row * header.columns + column
                items[ends[cell]] = bodies[index]
                ends[cell] += 1


@kernel
def enter(world: WorldView, slot: int) -> None:
    """Put a moving body into the list of its plan's cell, if there are lists."""
    heads = heads_of(world)
    if heads.shape[0] == 0:
        return
    plans = plans_of(world)
    plan = plans[slot]
    cell = plan.row * header_of(world).columns + plan.column
    first = heads[cell]
    plan.next = first
    plan.previous = NO_ONE
    if first != NO_ONE:
        plans[first].previous = slot
    heads[cell] = slot


@kernel
def leave(world: WorldView, slot: int) -> None:
    """Take a moving body out of the list of its plan's cell, if there are lists."""
    heads = heads_of(world)
    if heads.shape[0] == 0:
        return
    plans = plans_of(world)
    plan = plans[slot]
    if plan.next != NO_ONE:
        plans[plan.next].previous = plan.previous
    if plan.previous != NO_ONE:
        plans[plan.previous].next = plan.next
    else:
        heads[plan.row * header_of(world).columns + plan.column] = plan.next


@kernel
def enter_all(world: WorldView) -> None:
    """Put every moving body that does not roam into the cell of its position."""
    header = header_of(world)
    heads = heads_of(world)
    traits = traits_of(world)
    moving = moving_of(world)
    motions = motions_of(world)
    plans = plans_of(world)
    for cell in range(heads.shape[0]):
        heads[cell] = NO_ONE
    for slot in range(plans.shape[0]):
        if not traits[moving[slot]].roams:
            motion, plan = motions[slot], plans[slot]
            plan.column = cell_index(motion.x, header.left, header.cell, header.columns)
            plan.row = cell_index(motion.y, header.bottom, header.cell, header.rows)
            enter(world, slot)


@kernel
def time_to_cross(
    position: float, velocity: float, start: float, cell: float, index: int, count: int
) -> float:
    """Return in how long a body leaves its column or row; inf if there is no next one."""
    if velocity > 0.0 and index < count - 1:
        return max(0.0, (start + (index + 1) * cell - position) / velocity)
    if velocity < 0.0 and index > 0:
        return max(0.0, (start + index * cell - position) / velocity)
    return math.inf


@kernel
def interacts(one: TraitRecord, other: TraitRecord) -> bool:
    """Return whether two bodies may meet: their masks allow it, and one of them has a mass.

    A sensor meets every body that is no sensor, also one without a mass.
    """
    if (one.category & other.mask) == 0 or (other.category & one.mask) == 0:
        return False
    if one.sensor >= 0 or other.sensor >= 0:
        return bool(one.sensor < 0 or other.sensor < 0)
    return bool(one.inverse_mass + other.inverse_mass > 0.0)


@kernel
def find_near(world: WorldView, slot: int, only_later: bool) -> int:
    """Write the bodies that a moving body may meet from its cell into ``near``; return how many.

    Args:
        world, slot: the moving body.
        only_later: of the moving bodies, write only those with later slots, so that going through
            all slots gives every pair once.
    """
    least = slot + 1 if only_later else 0
    trait = traits_of(world)[moving_of(world)[slot]]
    if trait.roams:
        return _append_all(world, trait, slot, least)
    boundless, firsts, items = boundless_of(world), firsts_of(world), items_of(world)
    count = 0
    for index in range(boundless.shape[0]):
        count = _append(world, trait, boundless[index], count)
    plan = plans_of(world)[slot]
    own = plan.row * header_of(world).columns + plan.column
    for index in range(firsts[own], firsts[own + 1]):
        count = _append(world, trait, items[index], count)
    if heads_of(world).shape[0] == 0:
        moving = moving_of(world)
        for other in range(least, moving.shape[0]):
            if other != slot:
                count = _append(world, trait, moving[other], count)
        return count
    return _append_around(world, trait, slot, least, count)


@kernel
def _append_all(world: WorldView, trait: TraitRecord, slot: int, least: int) -> int:
    """Append static bodies, and moving ones from slot ``least`` on; return how many there are."""
    traits = traits_of(world)
    count = 0
    for other in range(traits.shape[0]):
        theirs = traits[other].slot
        if theirs < 0 or (theirs != slot and theirs >= least):
            count = _append(world, trait, other, count)
    return count


@kernel
def _append_around(world: WorldView, trait: TraitRecord, slot: int, least: int, count: int) -> int:
    """Append roaming bodies, and those in the nine cells around, from slot ``least`` on."""
    traits, moving, roaming = traits_of(world), moving_of(world), roaming_of(world)
    header, heads, plans = header_of(world), heads_of(world), plans_of(world)
    for index in range(roaming.shape[0]):
        theirs = traits[roaming[index]].slot
        if theirs >= least and theirs != slot:
            count = _append(world, trait, roaming[index], count)
    plan = plans[slot]
    for row in range(max(0, plan.row - 1), min(header.rows, plan.row + 2)):
        for column in range(max(0, plan.column - 1), min(header.columns, plan.column + 2)):
            other = heads[row * header.columns + column]
            for _ in range(plans.shape[0]):  # a list is not longer
                if other == NO_ONE:
                    break
                if other >= least and other != slot:
                    count = _append(world, trait, moving[other], count)
                other = plans[other].next
    return count


@kernel
def _append(world: WorldView, trait: TraitRecord, other: int, count: int) -> int:
    """Append a body to ``near`` if the two interact; return how many there are."""
    if not interacts(trait, traits_of(world)[other]):
        return count
    near_of(world)[count] = other
    return count + 1
