"""Any bounded shape among the equal boxes of a lattice, through the table of pairs.

The shape meets each solid cell separately. Unlike a disc (`lattice.py`), a shape that slides along
a row of cells within a rounding error of it may be caught at a seam: keep a clearance.
"""

import math

from ..kernels import kernel
from ..shapes.records import Edges, Shapes
from .approach import approach_between
from .lattice import LatticeRecord, SolidCells, cell_centre, swept_cells


@kernel
def sweep_shape_lattice(
    shapes: Shapes,
    edges: Edges,
    shape: int,
    cell_shape: int,
    lattice: LatticeRecord,
    solid: SolidCells,
    x: float,
    y: float,
    velocity_x: float,
    velocity_y: float,
    duration: float,
) -> tuple[float, float, float, int]:
    """Return (time, normal_x, normal_y, cell) of a moving shape's first impact; time inf if none.

    The normal points from the cell to the shape. A cell that the shape overlaps and recedes from
    does not count.

    Args:
        shape: index of the shape in the table; cell_shape: of a box of a cell's size.
    """
    box = shapes[shape]
    first_column, last_column, first_row, last_row = swept_cells(
        lattice,
        x,
        y,
        velocity_x,
        velocity_y,
        duration,
        box.lower_x,
        box.lower_y,
        box.upper_x,
        box.upper_y,
    )
    time, normal_x, normal_y, cell = math.inf, 0.0, 0.0, -1
    for row in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            index = row * lattice.columns + column
            if solid[index] != 0:
                centre_x, centre_y = cell_centre(lattice, index)
                candidate, out_x, out_y = approach_between(
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
                if candidate < time:
                    time, normal_x, normal_y, cell = candidate, out_x, out_y, index
    return time, normal_x, normal_y, cell
