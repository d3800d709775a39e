"""A disc among the equal boxes of a lattice, some of its cells solid: bricks, tiles, a maze.

The disc meets the union of the solid cells, not each box separately. Faces between two solid cells
and corners along a straight seam do not exist, so that a row of bricks gives the same bits as one
wall (no "ghost collisions"). Cells are counted from the upper left, row by row.
"""

import math
from typing import Any, TypeAlias

import numpy as np

from ..kernels import inner, kernel
from ..kernels.layouts import record_dtype
from .disc_disc import sweep_point_disc
from .results import NO_IMPACT

Lattice = record_dtype(
    [
        ("left", np.float64),  # of the lattice's upper left corner
        ("top", np.float64),
        ("cell_width", np.float64),
        ("cell_height", np.float64),
        ("columns", np.int64),
        ("rows", np.int64),
    ]
)

# A sweep over more rows than this goes through them one by one, and only as far as it has to.
_FEW_ROWS = 3
# The part of a cell by which such a sweep looks too far, so that no rounding error hides a cell.
_MARGIN = 1 / 64

# What kernels are passed (to a type checker, anything):
LatticeRecord: TypeAlias = Any  # one `Lattice`
SolidCells: TypeAlias = Any  # integers [rows * columns]; a cell is solid if its number is not 0


@kernel
def lattice_index(position: float, size: float, count: int) -> int:
    """Return the index in [0, count) of the cell that holds a position, or the nearest one."""
    # Clamped as a float: a position may be too large for an integer.
    return int(max(0.0, min(count - 1.0, math.floor(position / size))))


@kernel
def cell_centre(lattice: LatticeRecord, cell: int) -> tuple[float, float]:
    """Return the middle of a cell."""
    column = cell % lattice.columns
    row = cell // lattice.columns
    x: float = lattice.left + (column + 0.5) * lattice.cell_width
    y: float = lattice.top - (row + 0.5) * lattice.cell_height
    return x, y


@kernel
def is_solid(lattice: LatticeRecord, solid: SolidCells, column: int, row: int) -> bool:
    """Return whether a cell is solid (``solid[cell] != 0``); cells outside the lattice are not."""
    if column < 0 or row < 0 or column >= lattice.columns or row >= lattice.rows:
        return False
    return bool(solid[row * lattice.columns + column] != 0)


@kernel
def swept_cells(
    lattice: LatticeRecord,
    x: float,
    y: float,
    velocity_x: float,
    velocity_y: float,
    duration: float,
    lower_x: float,
    lower_y: float,
    upper_x: float,
    upper_y: float,
) -> tuple[int, int, int, int]:
    """Return (first_column, last_column, first_row, last_row) of the cells that a box may meet.

    The box moves from (x, y); ``lower`` and ``upper`` are its corners relative to there. If it
    stays outside of the lattice, each last index is less than the first.
    """
    end_x, end_y = x + velocity_x * duration, y + velocity_y * duration
    low_x, high_x = min(x, end_x) + lower_x - lattice.left, max(x, end_x) + upper_x - lattice.left
    low_y, high_y = lattice.top - max(y, end_y) - upper_y, lattice.top - min(y, end_y) - lower_y
    width, height = lattice.cell_width * lattice.columns, lattice.cell_height * lattice.rows
    if high_x < 0.0 or high_y < 0.0 or low_x > width or low_y > height:
        return 0, -1, 0, -1
    return (
        lattice_index(low_x, lattice.cell_width, lattice.columns),
        lattice_index(high_x, lattice.cell_width, lattice.columns),
        lattice_index(low_y, lattice.cell_height, lattice.rows),
        lattice_index(high_y, lattice.cell_height, lattice.rows),
    )


@kernel
def sweep_disc_lattice(
    lattice: LatticeRecord,
    solid: SolidCells,
    x: float,
    y: float,
    velocity_x: float,
    velocity_y: float,
    radius: float,
    duration: float,
) -> tuple[float, float, float, int]:
    """Return (time, normal_x, normal_y, cell) of a moving disc's first impact; time inf if none.

    The normal points from the cell to the disc. A disc that touches the cells meets them at time 0
    if it approaches them, and never if it slides along them or recedes.
    """
    first_column, last_column, first_row, last_row = swept_cells(
        lattice, x, y, velocity_x, velocity_y, duration, -radius, -radius, radius, radius
    )
    if last_row - first_row >= _FEW_ROWS:
        return _sweep_rows(
            lattice, solid, x, y, velocity_x, velocity_y, radius, duration, first_row, last_row
        )
    time, normal_x, normal_y, cell = math.inf, 0.0, 0.0, -1
    for row in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            index = row * lattice.columns + column
            if solid[index] != 0:
                candidate, out_x, out_y = _sweep_cell(
                    lattice, solid, column, row, x, y, velocity_x, velocity_y, radius, duration
                )
                if candidate < time:
                    time, normal_x, normal_y, cell = candidate, out_x, out_y, index
    return time, normal_x, normal_y, cell


@inner
def _sweep_rows(
    lattice: LatticeRecord,
    solid: SolidCells,
    x: float,
    y: float,
    velocity_x: float,
    velocity_y: float,
    radius: float,
    duration: float,
    first_row: int,
    last_row: int,
) -> tuple[float, float, float, int]:
    """Return what `sweep_disc_lattice` returns, bit for bit, for a long way through some rows.

    It goes through the rows in the order in which the disc reaches them, looks only at the columns
    that the disc passes while it is in a row, and stops at the first impact.
    """
    width, height = lattice.cell_width, lattice.cell_height
    reach_x, reach_y = radius + _MARGIN * width, radius + _MARGIN * height
    time, normal_x, normal_y, cell = math.inf, 0.0, 0.0, -1
    for number in range(last_row - first_row + 1):
        row = first_row + number if velocity_y < 0.0 else last_row - number
        # When the disc comes into the row, and when it has left it.
        enters, leaves = 0.0, duration
        above = y - (lattice.top - row * height + reach_y)  # the row, if positive
        below = lattice.top - (row + 1) * height - reach_y - y
        if velocity_y < 0.0:
            enters, leaves = max(0.0, above / -velocity_y), min(duration, below / velocity_y)
        elif velocity_y > 0.0:
            enters, leaves = max(0.0, below / velocity_y), min(duration, above / -velocity_y)
        if time < enters:
            break
        one, other = x + velocity_x * enters, x + velocity_x * leaves
        first = lattice_index(min(one, other) - reach_x - lattice.left, width, lattice.columns)
        last = lattice_index(max(one, other) + reach_x - lattice.left, width, lattice.columns)
        for column in range(first, last + 1):
            index = row * lattice.columns + column
            if solid[index] == 0:
                continue
            candidate, out_x, out_y = _sweep_cell(
                lattice, solid, column, row, x, y, velocity_x, velocity_y, radius, duration
            )
            # Of cells that are met at once the first one counts, whatever the order of the rows.
            if candidate < time or (candidate == time and index < cell):
                time, normal_x, normal_y, cell = candidate, out_x, out_y, index
    return time, normal_x, normal_y, cell


@kernel
def _sweep_cell(
    lattice: LatticeRecord,
    solid: SolidCells,
    column: int,
    row: int,
    x: float,
    y: float,
    velocity_x: float,
    velocity_y: float,
    radius: float,
    duration: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) of a moving disc's first impact on one solid cell."""
    # Only the two faces that look against the velocity can be met, and the corners at them.
    side = 1 if velocity_x < 0.0 else -1  # of the face that a horizontal motion meets
    level = 1 if velocity_y < 0.0 else -1
    left = lattice.left + column * lattice.cell_width
    right = lattice.left + (column + 1) * lattice.cell_width
    top = lattice.top - row * lattice.cell_height
    bottom = lattice.top - (row + 1) * lattice.cell_height
    face_x = right if side > 0 else left
    face_y = top if level > 0 else bottom
    beside = is_solid(lattice, solid, column + side, row)
    above = is_solid(lattice, solid, column, row - level)

    if velocity_x != 0.0 and not beside and (x - face_x) * side >= 0.0:
        time = max(0.0, ((x - face_x) * side - radius) / abs(velocity_x))
        foot = y + velocity_y * time
        if time <= duration and bottom <= foot <= top:
            return time, float(side), 0.0
    if velocity_y != 0.0 and not above and (y - face_y) * level >= 0.0:
        time = max(0.0, ((y - face_y) * level - radius) / abs(velocity_y))
        foot = x + velocity_x * time
        if time <= duration and left <= foot <= right:
            return time, 0.0, float(level)

    time, normal_x, normal_y = NO_IMPACT
    for corner in range(4):
        across = 1 if corner % 2 else -1
        along = 1 if corner // 2 else -1
        if is_solid(lattice, solid, column + across, row):
            continue
        if is_solid(lattice, solid, column, row - along):
            continue
        corner_x = right if across > 0 else left
        corner_y = top if along > 0 else bottom
        from_x, from_y = x - corner_x, y - corner_y
        candidate, out_x, out_y = sweep_point_disc(radius, from_x, from_y, velocity_x, velocity_y)
        # Only a quarter of the circle about the corner counts; on the rest the faces come first.
        is_in_quarter = out_x * across >= 0.0 and out_y * along >= 0.0
        if candidate < time and candidate <= duration and is_in_quarter:
            time, normal_x, normal_y = candidate, out_x, out_y
    return time, normal_x, normal_y
