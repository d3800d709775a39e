"""Where the game lies in a picture of any size."""

import math
from typing import Any, TypeAlias

import numpy as np

from ...physics.kernels import kernel
from ...physics.kernels.layouts import record_dtype
from ..rules import BRICK_HEIGHT, COLUMNS, FIELD_HEIGHT, FIELD_WIDTH, LATTICE_TOP, ROWS

# Around the field; lengths in brick widths.
WALL_WIDTH = 0.5
HEADER_HEIGHT = 1.5  # above the ceiling's wall, for the score line
FULL_WIDTH = FIELD_WIDTH + 2 * WALL_WIDTH
FULL_HEIGHT = FIELD_HEIGHT + WALL_WIDTH + HEADER_HEIGHT
# The width of the gates in the ceiling, and where the exit in the right wall begins and ends.
GATE_WIDTH = 1.0
EXIT_BOTTOM = 1.25
EXIT_TOP = 2.5
# With fewer pixels per brick width nobody could read the score line. Then the score line and the
# ceiling are left out, and the field fills the height (84 x 84: exactly 6 pixels per brick width).
HEADER_SCALE = 8.0

# Instead, small pictures show the status of the game along the field's lower edge: in two lines, as
# high as bricks, of units that are half as wide as bricks.
STATUS_LINES = 2
STATUS_UNITS = 2 * COLUMNS

# Lengths in pixels, x to the right and y down.
View = record_dtype(
    [
        ("scale", np.float64),  # pixels per brick width
        ("left", np.float64),  # x of the field's left edge
        ("bottom", np.float64),  # y of the field's lower edge
        ("header", np.int64),  # 1: there is a score line
        ("ground", np.int64),  # no thing is drawn in this row of pixels or below
        # The pixels at which the cells of the lattice begin, rounded: no pixel belongs to two
        # cells, and bricks are crisp.
        ("columns", np.int64, (COLUMNS + 1,)),
        ("rows", np.int64, (ROWS + 1,)),
        # The same for lines and units of the status.
        ("lines", np.int64, (STATUS_LINES + 1,)),
        ("units", np.int64, (STATUS_UNITS + 1,)),
    ]
)
ViewRecord: TypeAlias = Any  # one `View`
Views: TypeAlias = Any  # `View` [1]


def make_view(height: int, width: int) -> Views:
    """Return where the field lies in a picture, `View` [1]: centred, as large as fits."""
    views = np.zeros(1, View)
    lay_view(views[0], height, width)
    return views


@kernel
def lay_view(view: ViewRecord, height: int, width: int) -> None:
    """Write what `make_view` returns into a `View` record."""
    scale = min(height / FULL_HEIGHT, width / FULL_WIDTH)
    header = scale >= HEADER_SCALE
    shown = FULL_HEIGHT if header else FIELD_HEIGHT
    scale = min(height / shown, width / FULL_WIDTH)
    view.scale = scale
    view.header = 1 if header else 0
    view.left = round((width - FIELD_WIDTH * scale) / 2)
    view.bottom = round((height + shown * scale) / 2)
    for column in range(COLUMNS + 1):
        view.columns[column] = math.floor(view.left + column * scale + 0.5)
    for row in range(ROWS + 1):
        y = LATTICE_TOP - row * BRICK_HEIGHT
        view.rows[row] = math.floor(view.bottom - y * scale + 0.5)
    for line in range(STATUS_LINES + 1):
        y = (STATUS_LINES - line) * BRICK_HEIGHT
        view.lines[line] = min(height, math.floor(view.bottom - y * scale + 0.5))
    for unit in range(STATUS_UNITS + 1):
        view.units[unit] = math.floor(view.left + unit * scale / 2 + 0.5)
    view.ground = min(height, math.ceil(view.bottom)) if header else view.lines[0]


@kernel
def to_pixels(view: ViewRecord, x: float, y: float) -> tuple[float, float]:
    """Return the pixel coordinates of a point of the field."""
    return float(view.left + x * view.scale), float(view.bottom - y * view.scale)
