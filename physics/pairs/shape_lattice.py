"""Any bounded shape among the equal boxes of a lattice, through the table of pairs.

Each solid cell is met for itself: unlike a disc (`lattice.py`), a shape that slides along a row
within a rounding error of it may be caught at a seam. Keep a clearance.
"""

import math
from typing import Any

from ..kernels import kernel
from .approach import approach_between
from .lattice import cell_centre, lattice_index


@kernel
def sweep_shape_lattice(
    shapes: Any,
    edges: Any,
    shape: int,
    cell_shape: int,
    lattice: Any,
    solid: Any,
    x: float,
    y: float,
    velocity_x: float,
    velocity_y: float,
    duration: float,
) -> tuple[float, float, float, int]:
    """Return (time, normal_x, normal_y, cell) of a moving shape's first impact; time inf if none.

    The normal points from the cell to the shape. Cells that it overlaps and recedes from are none.

    Args:
        shape: index of the shape in the table; cell_shape: of a box of a cell's size.
    """
    bounds = shapes[shape]
    end_x, end_y = x + velocity_x * duration, y + velocity_y * duration
    low_x = min(x, end_x) + bounds.lower_x - lattice.left
    high_x = max(x, end_x) + bounds.upper_x - lattice.left
    low_y = lattice.top - max(y, end_y) - bounds.upper_y
    high_y = lattice.top - min(y, end_y) - bounds.lower_y
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
                centre_x, centre_y = cell_centre(lattice, index)
                met, out_x, out_y = approach_between(
                    shapes,
                    edges,
                    cell_shape,
                    shape,
                    x - centre_x,
                    y - centre_y,
                    velocity_x,
                    velocity_y,
                    duration,
                )
                if met < time:
                    time, normal_x, normal_y, cell = met, out_x, out_y, index
    return time, normal_x, normal_y, cell
