"""What all pictures of one size share: the background, and each look of a brick."""

import itertools
import math
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import kernel
from ..rules import COLUMNS, FIELD_HEIGHT, FIELD_WIDTH, GATE_X, GOLD, ROWS, SILVER
from .font import draw_text, encode
from .palette import (
    BRICK_BODY,
    BRICK_FOOT,
    BRICK_LIT,
    BRICK_SHADED,
    CRACK,
    DOOR,
    FIELD_LOWER,
    FIELD_UPPER,
    FRAME,
    LABEL,
    PATTERN,
    RIVET,
    SEAM,
    SHINE,
    STATUS,
    WALL,
    WALL_LIT,
    WALL_SHADED,
    palette_for,
)
from .raster import (
    Colour,
    Image,
    blend,
    draw_line,
    fill_disc,
    fill_rectangle,
    first_pixel,
    last_pixel,
    overlap,
)
from .view import (
    EXIT_BOTTOM,
    EXIT_TOP,
    GATE_WIDTH,
    HEADER_SCALE,
    WALL_WIDTH,
    ViewRecord,
    Views,
    make_view,
    to_pixels,
)

Palette: TypeAlias = Any  # float64 [colours, channels]
Looks: TypeAlias = Any  # uint8 [LOOKS, rows, columns, channels], the lattice full of each look

# The score line's labels and values: upper side, height and left ends, in brick widths.
LABEL_TOP = FIELD_HEIGHT + WALL_WIDTH + 1.25
LABEL_HEIGHT = 0.34
VALUE_TOP = FIELD_HEIGHT + WALL_WIDTH + 0.75
VALUE_HEIGHT = 0.5
SCORE_X = 0.0
ROUND_X = 4.7
LIVES_X = 7.1

# The looks of a cell: empty, a brick of each kind (numbered like the kinds), and damaged silver in
# some steps of damage.
DAMAGED = GOLD
DAMAGES = 3
LOOKS = GOLD + 1 + DAMAGES

MORTAR = 0.04  # between bricks
BEVEL = 0.07  # a brick's lit and shaded edges
SHINE_STRENGTH = 0.75  # from 0 to 1
CRACK_WIDTH = 0.05
# Each step of damage adds a crack: x from the left, y from the upper side, from 0 to 1.
CRACKS = np.array(
    [
        [(0.42, 0.02), (0.50, 0.40), (0.40, 0.62), (0.52, 0.98)],
        [(0.50, 0.40), (0.68, 0.30), (0.80, 0.52), (0.98, 0.44)],
        [(0.02, 0.70), (0.16, 0.52), (0.28, 0.68), (0.40, 0.62)],
    ]
)


class Scenery(NamedTuple):
    """What all pictures of one size share, as one argument of kernels; the arrays are read-only.

    Attributes:
        views: where the field lies, `View` [1].
        palette: float64 [colours, channels].
        background: uint8 [height, width * channels], a picture without anything that changes.
        looks: uint8 [LOOKS, rows, columns * channels], the pixels of the lattice, full of bricks of
            each look.
    """

    views: Views
    palette: NDArray[np.float64]
    background: NDArray[np.uint8]
    looks: NDArray[np.uint8]


@lru_cache(maxsize=8)
def make_scenery(height: int, width: int, channels: int) -> Scenery:
    """Return what all pictures of a size in pixels share; the first call draws it.

    Args:
        channels: 3 for red, green and blue, 1 for grey.
    """
    view = make_view(height, width)
    palette = palette_for(not view[0].header, channels)
    background = np.zeros((height, width, channels), np.uint8)
    painter = _Painter(background, view[0], palette)
    _draw_backdrop(painter)
    _draw_walls(painter)
    if view[0].header:
        _draw_pattern(painter)
        _draw_labels(painter)
    else:
        lines, units = view[0].lines, view[0].units
        background[lines[0] : lines[-1], units[0] : units[-1]] = np.rint(palette[STATUS])
    rows, columns = view[0].rows, view[0].columns
    lattice = background[rows[0] : rows[-1], columns[0] : columns[-1]]
    looks = np.repeat(lattice[np.newaxis], LOOKS, axis=0)
    draw_looks(looks, view, palette)
    shared = Scenery(
        view,
        palette,
        background.reshape(height, width * channels),
        looks.reshape(LOOKS, lattice.shape[0], -1),
    )
    for array in shared:
        array.flags.writeable = False
    return shared


class _Painter:
    """Draws into a picture in the field's coordinates and the palette's colours."""

    def __init__(self, image: NDArray[np.uint8], view: ViewRecord, palette: Palette) -> None:
        self.image = image
        self.view = view
        self.palette = palette

    def rectangle(self, box: tuple[float, ...], upper: int, lower: int) -> None:
        """Fill a box (left, bottom, right, top) with a gradient."""
        left, bottom = to_pixels(self.view, box[0], box[1])
        right, top = to_pixels(self.view, box[2], box[3])
        colours = self.palette[upper], self.palette[lower]
        fill_rectangle(self.image, left, top, right, bottom, *colours)

    def line(self, ends: tuple[float, ...], width: float, colour: int) -> None:
        """Draw a line between two points (x, y, x, y)."""
        start, end = to_pixels(self.view, ends[0], ends[1]), to_pixels(self.view, ends[2], ends[3])
        width = float(width * self.view.scale)
        draw_line(self.image, *start, *end, width, self.palette[colour])

    def disc(self, x: float, y: float, radius: float, colour: int) -> None:
        """Fill a disc."""
        radius = float(radius * self.view.scale)
        fill_disc(self.image, *to_pixels(self.view, x, y), radius, self.palette[colour])

    def text(self, text: str, x: float, y: float, height: float, colour: int) -> None:
        """Draw a text; x, y: its upper left corner."""
        height = float(height * self.view.scale)
        draw_text(
            self.image, encode(text), *to_pixels(self.view, x, y), height, self.palette[colour]
        )


def _draw_backdrop(painter: _Painter) -> None:
    """Fill the picture and, in it, the field."""
    height, width = float(painter.image.shape[0]), float(painter.image.shape[1])
    frame = painter.palette[FRAME]
    fill_rectangle(painter.image, 0.0, 0.0, width, height, frame, frame)
    painter.rectangle((0.0, 0.0, FIELD_WIDTH, FIELD_HEIGHT), FIELD_UPPER, FIELD_LOWER)


def _draw_pattern(painter: _Painter) -> None:
    """Draw a faint tiling of the field: hexagons with sides of one brick width."""
    rise = math.sqrt(0.75)
    # Three sides of each hexagon, relative to its middle; the neighbours draw the others.
    outline = ((1.0, 0.0), (0.5, rise), (-0.5, rise), (-1.0, 0.0))
    for column in range(9):
        for row in range(-1, 9):
            x, y = 1.5 * column - 0.5, 2 * rise * (row + column % 2 / 2)
            for start, end in itertools.pairwise(outline):
                ends = (x + start[0], y + start[1], x + end[0], y + end[1])
                middle_x, middle_y = (ends[0] + ends[2]) / 2, (ends[1] + ends[3]) / 2
                if 0.0 < middle_x < FIELD_WIDTH and 0.0 < middle_y < FIELD_HEIGHT:
                    painter.line(ends, 0.035, PATTERN)


def _draw_walls(painter: _Painter) -> None:
    """Draw the side walls and, in large pictures, the ceiling, with their closed gates."""
    header = painter.view.header
    top = FIELD_HEIGHT + (WALL_WIDTH if header else 0.0)
    for left in (-WALL_WIDTH, FIELD_WIDTH):
        _draw_wall(painter, (left, 0.0, left + WALL_WIDTH, top))
    if not header:
        return
    _draw_wall(painter, (-WALL_WIDTH, FIELD_HEIGHT, FIELD_WIDTH + WALL_WIDTH, top))
    for y in (0.5, 4.25, 6.25, 8.25, 10.25, 12.25):
        for x in (-WALL_WIDTH / 2, FIELD_WIDTH + WALL_WIDTH / 2):
            painter.disc(x, y, 0.09, RIVET)
    for x in (-WALL_WIDTH / 2, 1.25, 4.25, 6.75, 9.75, FIELD_WIDTH + WALL_WIDTH / 2):
        painter.disc(x, FIELD_HEIGHT + WALL_WIDTH / 2, 0.09, RIVET)
    for x in GATE_X:
        half = GATE_WIDTH / 2
        box = (x - half, FIELD_HEIGHT, x + half, FIELD_HEIGHT + WALL_WIDTH)
        _draw_door(painter, box, (x, box[1], x, box[3]))
    middle = (EXIT_BOTTOM + EXIT_TOP) / 2
    box = (FIELD_WIDTH, EXIT_BOTTOM, FIELD_WIDTH + WALL_WIDTH, EXIT_TOP)
    _draw_door(painter, box, (box[0], middle, box[2], middle))


def _draw_wall(painter: _Painter, box: tuple[float, ...]) -> None:
    """Draw a straight piece of wall, lit from the upper left."""
    left, bottom, right, top = box
    edge = 0.08
    painter.rectangle(box, WALL_SHADED, WALL_SHADED)
    painter.rectangle((left, bottom, right - edge, top), WALL_LIT, WALL_LIT)
    painter.rectangle((left + edge, bottom, right - edge, top - edge), WALL, WALL)


def _draw_door(
    painter: _Painter, box: tuple[float, float, float, float], seam: tuple[float, ...]
) -> None:
    """Draw a closed gate in a wall: two wings that meet at a seam (x, y, x, y)."""
    left, bottom, right, top = box
    edge = 0.04
    painter.rectangle(box, SEAM, SEAM)
    painter.rectangle((left + edge, bottom + edge, right - edge, top - edge), DOOR, WALL_SHADED)
    painter.line(seam, 0.06, SEAM)


def _draw_labels(painter: _Painter) -> None:
    """Draw the labels of the score line."""
    for text, x in (("SCORE", SCORE_X), ("ROUND", ROUND_X), ("LIVES", LIVES_X)):
        painter.text(text, x, LABEL_TOP, LABEL_HEIGHT, LABEL)


@kernel
def draw_looks(looks: Looks, views: Views, palette: Palette) -> None:
    """Fill the lattice with bricks of each look."""
    rows, columns = views[0].rows, views[0].columns
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
                    views[0].scale,
                )


@kernel
def draw_brick(
    image: Image,
    palette: Palette,
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
    body = palette[BRICK_BODY + kind]
    lit = palette[BRICK_LIT + kind]
    shaded = palette[BRICK_SHADED + kind]
    foot = palette[BRICK_FOOT + kind]
    fill_rectangle(image, left, top, right, bottom, shaded, shaded)
    fill_rectangle(image, left, top, right - bevel, bottom - bevel, lit, lit)
    fill_rectangle(image, left + bevel, top + bevel, right - bevel, bottom - bevel, body, foot)
    if kind >= SILVER and damage == 0:
        # Where bands of light are as wide as a pixel, gold has dark bands to differ from silver.
        dark = kind == GOLD and scale < HEADER_SCALE
        _draw_shine(
            image,
            palette[BRICK_SHADED + GOLD if dark else SHINE],
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
    image: Image, colour: Colour, left: float, top: float, right: float, bottom: float, scale: float
) -> None:
    """Draw a wide and a narrow band across a brick of metal."""
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
    image: Image,
    colour: Colour,
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
