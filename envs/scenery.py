"""What stands still in the pictures of one size: the background, and each look of a brick."""

import itertools
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.compilation import kernel
from .font import draw_text, encode
from .palette import (
    BRICK,
    BRICK_FOOT,
    BRICK_LIT,
    BRICK_SHADED,
    CRACK,
    FIELD_LOWER,
    FIELD_UPPER,
    FRAME,
    LABEL,
    PALETTE,
    PATTERN,
    RIVET,
    SHINE,
    WALL,
    WALL_LIT,
    WALL_SHADED,
)
from .raster import (
    blend,
    draw_line,
    fill_disc,
    fill_rectangle,
    first_pixel,
    last_pixel,
    overlap,
)
from .rules import COLUMNS, FIELD_HEIGHT, FIELD_WIDTH, GOLD, ROWS, SILVER
from .view import WALL_WIDTH, make_view, place

# The score line's labels and values: upper side, height and left ends, in the field's brick widths.
LABEL_TOP = FIELD_HEIGHT + WALL_WIDTH + 1.25
LABEL_HEIGHT = 0.34
VALUE_TOP = FIELD_HEIGHT + WALL_WIDTH + 0.75
VALUE_HEIGHT = 0.5
SCORE_X = 0.0
ROUND_X = 4.7
LIVES_X = 7.1

# The looks of a cell of the lattice: without a brick, with one of a kind (numbered as the kinds
# are), and silver that was hit, by the part of its hits that it has taken.
DAMAGED = GOLD
DAMAGES = 3
LOOKS = GOLD + 1 + DAMAGES

MORTAR = 0.04  # between bricks
BEVEL = 0.07  # a brick's lit and shaded edges
SHINE_STRENGTH = 0.75  # from 0 to 1
CRACK_WIDTH = 0.05
# One crack more for each step of damage: x from the left, y from the upper side, from 0 to 1.
CRACKS = np.array(
    [
        [(0.42, 0.02), (0.50, 0.40), (0.40, 0.62), (0.52, 0.98)],
        [(0.50, 0.40), (0.68, 0.30), (0.80, 0.52), (0.98, 0.44)],
        [(0.02, 0.70), (0.16, 0.52), (0.28, 0.68), (0.40, 0.62)],
    ]
)


@dataclass(frozen=True)
class Scenery:
    """What all pictures of one size share; the arrays are read-only.

    Attributes:
        view: where the field lies, `View` [1].
        background: uint8 [height, width, 3], the picture without anything that changes.
        looks: uint8 [LOOKS, rows, columns * 3], the bytes of the lattice's pixels, full of bricks
            of one look each.
    """

    view: Any
    background: NDArray[np.uint8]
    looks: NDArray[np.uint8]


@lru_cache(maxsize=4)
def scenery(height: int, width: int) -> Scenery:
    """Return what all pictures of a size in pixels share, drawn on the first call."""
    view = make_view(height, width)
    background = np.zeros((height, width, 3), np.uint8)
    _draw_backdrop(background, view[0])
    if view[0].header:
        _draw_pattern(background, view[0])
    _draw_walls(background, view[0])
    if view[0].header:
        _draw_labels(background, view[0])
    rows, columns = view[0].rows, view[0].columns
    lattice = background[rows[0] : rows[-1], columns[0] : columns[-1]]
    looks = np.repeat(lattice[np.newaxis], LOOKS, axis=0)
    draw_looks(looks, view, PALETTE)
    looks = looks.reshape(LOOKS, lattice.shape[0], -1)
    background.flags.writeable = False
    looks.flags.writeable = False
    return Scenery(view, background, looks)


def _rectangle(
    image: NDArray[np.uint8], view: Any, box: tuple[float, ...], upper: int, lower: int
) -> None:
    """Fill a box (left, bottom, right, top) of the field's units with a gradient."""
    left, bottom = place(view, box[0], box[1])
    right, top = place(view, box[2], box[3])
    fill_rectangle(image, left, top, right, bottom, PALETTE[upper], PALETTE[lower])


def _line(
    image: NDArray[np.uint8], view: Any, ends: tuple[float, ...], width: float, colour: int
) -> None:
    """Draw a line between two points (x, y, x, y) of the field."""
    start, end = place(view, ends[0], ends[1]), place(view, ends[2], ends[3])
    draw_line(image, *start, *end, float(width * view.scale), PALETTE[colour])


def _draw_backdrop(image: NDArray[np.uint8], view: Any) -> None:
    """Fill the picture, and in it the field."""
    height, width = float(image.shape[0]), float(image.shape[1])
    fill_rectangle(image, 0.0, 0.0, width, height, PALETTE[FRAME], PALETTE[FRAME])
    _rectangle(image, view, (0.0, 0.0, FIELD_WIDTH, FIELD_HEIGHT), FIELD_UPPER, FIELD_LOWER)


def _draw_pattern(image: NDArray[np.uint8], view: Any) -> None:
    """Draw a faint tiling of the field: hexagons with sides of one brick width."""
    rise = math.sqrt(0.75)
    # Three sides of each hexagon, from its middle; the others are its neighbours'.
    outline = ((1.0, 0.0), (0.5, rise), (-0.5, rise), (-1.0, 0.0))
    for column in range(9):
        for row in range(-1, 9):
            x, y = 1.5 * column - 0.5, 2 * rise * (row + column % 2 / 2)
            for start, end in itertools.pairwise(outline):
                ends = (x + start[0], y + start[1], x + end[0], y + end[1])
                middle_x, middle_y = (ends[0] + ends[2]) / 2, (ends[1] + ends[3]) / 2
                if 0.0 < middle_x < FIELD_WIDTH and 0.0 < middle_y < FIELD_HEIGHT:
                    _line(image, view, ends, 0.035, PATTERN)


def _draw_walls(image: NDArray[np.uint8], view: Any) -> None:
    """Draw the two side walls, and the ceiling's where there is room."""
    top = FIELD_HEIGHT + (WALL_WIDTH if view.header else 0.0)
    for left in (-WALL_WIDTH, FIELD_WIDTH):
        _draw_beam(image, view, (left, 0.0, left + WALL_WIDTH, top))
    if view.header:
        _draw_beam(image, view, (-WALL_WIDTH, FIELD_HEIGHT, FIELD_WIDTH + WALL_WIDTH, top))
        for step in range(1, 7):
            for x in (-WALL_WIDTH / 2, FIELD_WIDTH + WALL_WIDTH / 2):
                _draw_rivet(image, view, x, 2.0 * step + 0.25)
        for step in range(6):
            _draw_rivet(image, view, 2.1 * step + 0.25, FIELD_HEIGHT + WALL_WIDTH / 2)


def _draw_beam(image: NDArray[np.uint8], view: Any, box: tuple[float, ...]) -> None:
    """Draw a bar of wall that is lit from the upper left."""
    left, bottom, right, top = box
    edge = 0.08
    _rectangle(image, view, box, WALL_SHADED, WALL_SHADED)
    _rectangle(image, view, (left, bottom, right - edge, top), WALL_LIT, WALL_LIT)
    _rectangle(image, view, (left + edge, bottom, right - edge, top - edge), WALL, WALL)


def _draw_rivet(image: NDArray[np.uint8], view: Any, x: float, y: float) -> None:
    fill_disc(image, *place(view, x, y), float(0.09 * view.scale), PALETTE[RIVET])


def _draw_labels(image: NDArray[np.uint8], view: Any) -> None:
    """Draw what never changes of the score line."""
    for text, x in (("SCORE", SCORE_X), ("ROUND", ROUND_X), ("LIVES", LIVES_X)):
        height = float(LABEL_HEIGHT * view.scale)
        draw_text(image, encode(text), *place(view, x, LABEL_TOP), height, PALETTE[LABEL])


@kernel
def draw_looks(looks: Any, view: Any, palette: Any) -> None:
    """Fill the lattice with bricks of each look; looks: uint8 [LOOKS, rows, columns, channels]."""
    rows, columns = view[0].rows, view[0].columns
    for look in range(1, LOOKS):
        for row in range(ROWS):
            for column in range(COLUMNS):
                draw_brick(
                    looks[look],
                    palette,
                    look,
                    float(columns[column] - columns[0]),
                    float(rows[row] - rows[0]),
                    float(columns[column + 1] - columns[0]),
                    float(rows[row + 1] - rows[0]),
                    view[0].scale,
                )


@kernel
def draw_brick(
    image: Any,
    palette: Any,
    look: int,
    left: float,
    top: float,
    right: float,
    bottom: float,
    scale: float,
) -> None:
    """Draw a brick of a look into its cell (pixels), lit from the upper left."""
    damage = max(look - DAMAGED, 0)
    kind = SILVER if damage > 0 else look
    right -= MORTAR * scale
    bottom -= MORTAR * scale
    bevel = BEVEL * scale
    body = palette[BRICK + kind]
    lit = palette[BRICK_LIT + kind]
    shaded = palette[BRICK_SHADED + kind]
    foot = palette[BRICK_FOOT + kind]
    fill_rectangle(image, left, top, right, bottom, shaded, shaded)
    fill_rectangle(image, left, top, right - bevel, bottom - bevel, lit, lit)
    fill_rectangle(image, left + bevel, top + bevel, right - bevel, bottom - bevel, body, foot)
    if kind >= SILVER and damage == 0:
        _draw_shine(
            image,
            palette[SHINE],
            left + bevel,
            top + bevel,
            right - bevel,
            bottom - bevel,
            scale,
        )
    for crack in range(damage):
        _draw_crack(image, palette[CRACK], crack, left, top, right, bottom, scale)


@kernel
def _draw_shine(
    image: Any, colour: Any, left: float, top: float, right: float, bottom: float, scale: float
) -> None:
    """Draw a bright band across a brick of metal, and a narrow one beside it."""
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        height = overlap(float(row), row + 1.0, top, bottom)
        for column in range(first_pixel(left), last_pixel(right, image.shape[1])):
            # From 0 at the lower left to about 1.3 at the upper right, in brick widths.
            along = (column + 0.5 - left + bottom - row - 0.5) / scale
            wide = 1.0 - abs(along - 0.5) / 0.16
            narrow = 1.0 - abs(along - 0.8) / 0.07
            shine = SHINE_STRENGTH * max(wide, max(narrow, 0.0))
            width = overlap(float(column), column + 1.0, left, right)
            blend(image, row, column, colour, shine * height * width)


@kernel
def _draw_crack(
    image: Any,
    colour: Any,
    crack: int,
    left: float,
    top: float,
    right: float,
    bottom: float,
    scale: float,
) -> None:
    """Draw one of the cracks of a damaged brick."""
    width, height = right - left, bottom - top
    for index in range(CRACKS.shape[1] - 1):
        draw_line(
            image,
            left + CRACKS[crack, index, 0] * width,
            top + CRACKS[crack, index, 1] * height,
            left + CRACKS[crack, index + 1, 0] * width,
            top + CRACKS[crack, index + 1, 1] * height,
            CRACK_WIDTH * scale,
            colour,
        )
