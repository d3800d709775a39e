"""What a picture shows at present, so that only what differs need be drawn.

A picture and its `Drawn` record belong together. Things that move are noted with the box of pixels
that they may have touched; before the next drawing these boxes are erased.
"""

from typing import Any

import numpy as np

from ...physics.kernels import kernel
from ..rules import CELLS, GATES, MAX_BALLS, MAX_BEAMS, MAX_ENEMIES, MAX_SHARDS
from .raster import first_pixel, last_pixel

# Paddle, capsule, boss and exit, and what there may be more of.
MAX_MARKS = 4 + MAX_BALLS + MAX_BEAMS + MAX_ENEMIES + MAX_SHARDS + GATES

Drawn = np.dtype(
    (
        np.record,
        [
            ("begun", np.int64),  # 0: the picture's bytes mean nothing
            ("score", np.int64),
            ("lives", np.int64),
            ("power", np.int64),
            ("header_round", np.int64),  # what the score line shows
            ("round_number", np.int64),  # in which the bricks are drawn
            ("brick_hits", np.uint8, (CELLS,)),
            ("kind", np.uint8, (CELLS,)),
            # The boxes of pixels to be erased: rows and columns, each end excluded.
            ("marks", np.int64),
            ("top", np.int64, (MAX_MARKS,)),
            ("bottom", np.int64, (MAX_MARKS,)),
            ("left", np.int64, (MAX_MARKS,)),
            ("right", np.int64, (MAX_MARKS,)),
        ],
    )
)


@kernel
def copy_bytes(target: Any, source: Any) -> None:
    """Copy uint8 [n]; as a loop, because assigning a slice costs two seconds of compilation."""
    for index in range(target.shape[0]):
        target[index] = source[index]


@kernel
def mark(drawn: Any, image: Any, left: float, top: float, right: float, bottom: float) -> None:
    """Note a box, in pixels, in which a thing is drawn, cut off at the picture's edges."""
    first_row, end_row = first_pixel(top), last_pixel(bottom, image.shape[0])
    first_column, end_column = first_pixel(left), last_pixel(right, image.shape[1])
    if first_row >= end_row or first_column >= end_column:
        return
    index = drawn.marks
    drawn.top[index] = first_row
    drawn.bottom[index] = end_row
    drawn.left[index] = first_column
    drawn.right[index] = end_column
    drawn.marks = index + 1


@kernel
def mark_shape(
    drawn: Any, image: Any, shape: Any, x: float, y: float, scale: float, hidden: int
) -> None:
    """Note the bounding box of a `Shape`, its body at a place in pixels, below the hidden rows."""
    mark(
        drawn,
        image,
        x + shape.lower_x * scale,
        max(float(hidden), y - shape.upper_y * scale),
        x + shape.upper_x * scale,
        y - shape.lower_y * scale,
    )
