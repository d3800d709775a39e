"""A disc among the equal boxes of a lattice, some of its cells solid: bricks, tiles, a maze.

The union of the solid cells is met, not each box for itself: faces between two solid cells and
corners along a straight seam do not exist, so that a row of bricks gives the same bits as one wall
(no "ghost collisions"). Cells are counted from the upper left, row by row.
"""

import math
from typing import Any

import numpy as np

from ..kernels import kernel
from .disc_disc import sweep_point_disc

Lattice = np.dtype(
    (
        np.record,
        [
            ("left", np.float64),  # of the lattice's upper left corner
            ("top", np.float64),
            ("cell_width", np.float64),
            ("cell_height", np.float64),
            ("columns", np.int64),
            ("rows", np.int64),
        ],
    )
)


@kernel
def lattice_index(position: float, size: float, count: int) -> int:
    """Return the index in [0, count) of the cell that holds a position, or the nearest one."""
    # Clamped as a float: a position may be too large for an integer.
    return int(max(0.0, min(count - 1.0, math.floor(position / size))))


@kernel
def cell_centre(lattice: Any, cell: int) -> tuple[float, float]:
    """Return the middle of a cell."""
    column = cell % lattice.columns
    row = cell // lattice.columns
    x: float = lattice.left + (column + 0.5) * lattice.cell_width
    y: float = lattice.top - (row + 0.5) * lattice.cell_height
    return x, y


@kernel
def is_solid(lattice: Any, solid: Any, column: int, row: int) -> bool:
    """Tell whether a cell is solid (``solid[cell] != 0``); none outside the lattice is."""
    if column < 0 or row < 0 or column >= lattice.columns or row >= lattice.rows:
        return False
    return bool(solid[row * lattice.columns + column] != 0)


@kernel
def sweep_disc_lattice(
    lattice: Any,
    solid: Any,
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
    end_x, end_y = x + velocity_x * duration, y + velocity_y * duration
    low_x, high_x = min(x, end_x) - radius - lattice.left, max(x, end_x) + radius - lattice.left
    low_y, high_y = lattice.top - max(y, end_y) - radius, lattice.top - min(y, end_y) + radius
    time, normal_x, normal_y, cell = math.inf, 0.0, 0.0, -1
    width, height = lattice.cell_width * lattice.columns, lattice.cell_height * lattice.rows
    if high_x < 0.0 or high_y < 0.0 or low_x > width or low_y > height:
        return time, normal_x, normal_y, cell
    first_column = lattice_index(low_x, lattice.cell_width, lattice.columns)
    last_column = lattice_index(high_x, lattice.cell_width, lattice.columns)
    last_row = lattice_index(high_y, lattice.cell_height, lattice.rows)
    for row in range(lattice_index(low_y, lattice.cell_height, lattice.rows), last_row + 1):
        for column in range(first_column, last_column + 1):
            index = row * lattice.columns + column
            if solid[index] != 0:
                found = _sweep_cell(
                    lattice, solid, column, row, x, y, velocity_x, velocity_y, radius, duration
                )
                if found[0] < time:
                    time, normal_x, normal_y = found
                    cell = index
    return time, normal_x, normal_y, cell


@kernel
def _sweep_cell(
    lattice: Any,
    solid: Any,
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
    # Only the two faces and the three corners that look against the velocity can be met first.
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

    time, normal_x, normal_y = math.inf, 0.0, 0.0
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
        met, out_x, out_y = sweep_point_disc(radius, from_x, from_y, velocity_x, velocity_y)
        # The rest of the circle about the corner lies within the faces' reach.
        if met < time and met <= duration and out_x * across >= 0.0 and out_y * along >= 0.0:
            time, normal_x, normal_y = met, out_x, out_y
    return time, normal_x, normal_y
