"""What a picture shows, so that only what has changed need be drawn.

A picture and its `Drawn` record belong together. The record holds the boxes of pixels that moving
things may have touched; the next drawing erases these boxes first.
"""

from typing import Any, TypeAlias

import numpy as np

from ...physics.kernels import kernel
from ...physics.kernels.layouts import record_dtype
from ...physics.shapes.records import ShapeRecord
from ..rules import CELLS, GATES, MAX_BALLS, MAX_BEAMS, MAX_ENEMIES, MAX_SHARDS
from .raster import Image, first_pixel, last_pixel

# One each for paddle, capsule, boss and exit; the others come in numbers.
MAX_BOXES = 4 + MAX_BALLS + MAX_BEAMS + MAX_ENEMIES + MAX_SHARDS + GATES

Drawn = record_dtype(
    [
        ("begun", np.int64),  # 0: nothing is drawn yet
        # What the score line shows, or the status.
        ("score", np.int64),
        ("lives", np.int64),
        ("power", np.int64),
        ("header_round", np.int64),
        ("idle", np.int64),
        ("decisions", np.int64),
        # The boxes to be erased, in pixels; right and bottom are excluded.
        ("boxes", np.int64),
        ("top", np.int64, (MAX_BOXES,)),
        ("bottom", np.int64, (MAX_BOXES,)),
        ("left", np.int64, (MAX_BOXES,)),
        ("right", np.int64, (MAX_BOXES,)),
        # The bricks that are drawn, and the round they belong to.
        ("round_number", np.int64),
        ("brick_hits", np.uint8, (CELLS,)),
        ("kind", np.uint8, (CELLS,)),
    ]
)
DrawnRecord: TypeAlias = Any  # one `Drawn`
Lines: TypeAlias = Any  # uint8 [height, width * channels], the bytes of a picture
Bytes: TypeAlias = Any  # uint8 [n]


@kernel
def copy_bytes(target: Bytes, source: Bytes) -> None:
    """Copy uint8 [n]; a loop, because assigning a slice costs two seconds of compilation."""
    for index in range(target.shape[0]):
        target[index] = source[index]


@kernel
def note_box(
    drawn: DrawnRecord, image: Image, left: float, top: float, right: float, bottom: float
) -> None:
    """Note the box, in pixels, in which a thing is drawn; the picture cuts it off."""
    first_row, end_row = first_pixel(top), last_pixel(bottom, image.shape[0])
    first_column, end_column = first_pixel(left), last_pixel(right, image.shape[1])
    if first_row >= end_row or first_column >= end_column:
        return
    index = drawn.boxes
    drawn.top[index] = first_row
    drawn.bottom[index] = end_row
    drawn.left[index] = first_column
    drawn.right[index] = end_column
    drawn.boxes = index + 1


@kernel
def note_shape(
    drawn: DrawnRecord,
    image: Image,
    shape: ShapeRecord,
    x: float,
    y: float,
    scale: float,
    hidden: int,
) -> None:
    """Note the bounding box of a `Shape` at x, y in pixels; the first rows may be hidden."""
    note_box(
        drawn,
        image,
        x + shape.lower_x * scale,
        max(float(hidden), y - shape.upper_y * scale),
        x + shape.upper_x * scale,
        y - shape.lower_y * scale,
    )
