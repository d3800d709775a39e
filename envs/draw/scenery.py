"""What all pictures of one size share: the background, and each look of a brick."""

import math
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import inlined, kernel
from ..rules import COLUMNS, FIELD_HEIGHT, FIELD_WIDTH, GATE_X, GATES, GOLD, ROWS, SILVER
from .font import Codes, draw_text, encode
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
    STATUS_LINES,
    STATUS_UNITS,
    WALL_WIDTH,
    ViewRecord,
    Views,
    make_view,
    to_pixels,
)

Palette: TypeAlias = Any  # float64 [colours, channels]
# Left, bottom, right and top in the field; or two points.
Box: TypeAlias = tuple[float, float, float, float]
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

# The labels' letters.
SCORE_LABEL, ROUND_LABEL, LIVES_LABEL = encode("SCORE"), encode("ROUND"), encode("LIVES")

# Half a hexagon around its middle: three of its sides; the neighbours draw the others.
_RISE = math.sqrt(0.75)
HEXAGON = np.array([(1.0, 0.0), (0.5, _RISE), (-0.5, _RISE), (-1.0, 0.0)])
# The rivets of the side walls and of the ceiling, x and y.
_BESIDE = [
    (x, y)
    for y in (0.5, 4.25, 6.25, 8.25, 10.25, 12.25)
    for x in (-WALL_WIDTH / 2, FIELD_WIDTH + WALL_WIDTH / 2)
]
_ABOVE = [
    (x, FIELD_HEIGHT + WALL_WIDTH / 2)
    for x in (-WALL_WIDTH / 2, 1.25, 4.25, 6.75, 9.75, FIELD_WIDTH + WALL_WIDTH / 2)
]
RIVETS = np.array(_BESIDE + _ABOVE)

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
    rows, columns = lattice_size(view[0])
    looks = np.zeros((LOOKS, rows, columns, channels), np.uint8)
    draw_scenery(background, looks, view, palette)
    shared = Scenery(
        view,
        palette,
        background.reshape(height, width * channels),
        looks.reshape(LOOKS, rows, -1),
    )
    for array in shared:
        array.flags.writeable = False
    return shared


@kernel
def lattice_size(view: ViewRecord) -> tuple[int, int]:
    """Return how many rows and columns of pixels the lattice has."""
    return view.rows[ROWS] - view.rows[0], view.columns[COLUMNS] - view.columns[0]


@kernel
def draw_scenery(background: Image, looks: Looks, views: Views, palette: Palette) -> None:
    """Draw what pictures share.

    Args:
        background: uint8 [height, width, channels].
        looks: uint8 [LOOKS, rows, columns, channels].
        views: of the picture's size; palette: with as many channels.
    """
    view = views[0]
    _draw_backdrop(background, view, palette)
    _draw_walls(background, view, palette)
    if view.header == 1:
        _draw_pattern(background, view, palette)
        _draw_labels(background, view, palette)
    else:
        _draw_status_ground(background, view, palette)
    top, left = view.rows[0], view.columns[0]
    for look in range(LOOKS):
        for row in range(looks.shape[1]):
            for column in range(looks.shape[2]):
                for channel in range(looks.shape[3]):
                    pixel = background[top + row, left + column, channel]
                    looks[look, row, column, channel] = pixel
    draw_looks(looks, views, palette)


@kernel
def _rectangle(image: Image, view: ViewRecord, box: Box, upper: Colour, lower: Colour) -> None:
    """Fill a box of the field with a gradient."""
    left, bottom = to_pixels(view, box[0], box[1])
    right, top = to_pixels(view, box[2], box[3])
    fill_rectangle(image, left, top, right, bottom, upper, lower)


@kernel
def _line(image: Image, view: ViewRecord, ends: Box, width: float, colour: Colour) -> None:
    """Draw a line between two points of the field."""
    start_x, start_y = to_pixels(view, ends[0], ends[1])
    end_x, end_y = to_pixels(view, ends[2], ends[3])
    draw_line(image, start_x, start_y, end_x, end_y, width * view.scale, colour)


@inlined
def _draw_backdrop(image: Image, view: ViewRecord, palette: Palette) -> None:
    """Fill the picture and, in it, the field."""
    height, width = float(image.shape[0]), float(image.shape[1])
    frame = palette[FRAME]
    fill_rectangle(image, 0.0, 0.0, width, height, frame, frame)
    field = 0.0, 0.0, FIELD_WIDTH, FIELD_HEIGHT
    _rectangle(image, view, field, palette[FIELD_UPPER], palette[FIELD_LOWER])


@inlined
def _draw_pattern(image: Image, view: ViewRecord, palette: Palette) -> None:
    """Draw a faint tiling of the field: hexagons with sides of one brick width."""
    rise = HEXAGON[1, 1]
    for column in range(9):
        for row in range(-1, 9):
            x, y = 1.5 * column - 0.5, 2 * rise * (row + column % 2 / 2)
            for side in range(HEXAGON.shape[0] - 1):
                start_x, start_y = x + HEXAGON[side, 0], y + HEXAGON[side, 1]
                end_x, end_y = x + HEXAGON[side + 1, 0], y + HEXAGON[side + 1, 1]
                middle_x, middle_y = (start_x + end_x) / 2, (start_y + end_y) / 2
                if 0.0 < middle_x < FIELD_WIDTH and 0.0 < middle_y < FIELD_HEIGHT:
                    _line(image, view, (start_x, start_y, end_x, end_y), 0.035, palette[PATTERN])


@inlined
def _draw_walls(image: Image, view: ViewRecord, palette: Palette) -> None:
    """Draw the side walls and, in large pictures, the ceiling, with their closed gates."""
    top = FIELD_HEIGHT + (WALL_WIDTH if view.header == 1 else 0.0)
    left, right = -WALL_WIDTH, FIELD_WIDTH + WALL_WIDTH
    _draw_wall(image, view, palette, (left, 0.0, 0.0, top))
    _draw_wall(image, view, palette, (FIELD_WIDTH, 0.0, right, top))
    if view.header == 0:
        return
    _draw_wall(image, view, palette, (left, FIELD_HEIGHT, right, top))
    for rivet in range(RIVETS.shape[0]):
        x, y = to_pixels(view, RIVETS[rivet, 0], RIVETS[rivet, 1])
        fill_disc(image, x, y, 0.09 * view.scale, palette[RIVET])
    for gate in range(GATES):
        x, half = GATE_X[gate], GATE_WIDTH / 2
        box = x - half, FIELD_HEIGHT, x + half, top
        _draw_door(image, view, palette, box, (x, FIELD_HEIGHT, x, top))
    middle = (EXIT_BOTTOM + EXIT_TOP) / 2
    box = FIELD_WIDTH, EXIT_BOTTOM, right, EXIT_TOP
    _draw_door(image, view, palette, box, (FIELD_WIDTH, middle, right, middle))


@kernel
def _draw_wall(image: Image, view: ViewRecord, palette: Palette, box: Box) -> None:
    """Draw a straight piece of wall, lit from the upper left."""
    left, bottom, right, top = box
    edge = 0.08
    lit, shaded, wall = palette[WALL_LIT], palette[WALL_SHADED], palette[WALL]
    _rectangle(image, view, box, shaded, shaded)
    _rectangle(image, view, (left, bottom, right - edge, top), lit, lit)
    _rectangle(image, view, (left + edge, bottom, right - edge, top - edge), wall, wall)


@kernel
def _draw_door(image: Image, view: ViewRecord, palette: Palette, box: Box, seam: Box) -> None:
    """Draw a closed gate in a wall: two wings that meet at a seam."""
    left, bottom, right, top = box
    edge = 0.04
    dark, door, shaded = palette[SEAM], palette[DOOR], palette[WALL_SHADED]
    inside = left + edge, bottom + edge, right - edge, top - edge
    _rectangle(image, view, box, dark, dark)
    _rectangle(image, view, inside, door, shaded)
    _line(image, view, seam, 0.06, dark)


@inlined
def _draw_labels(image: Image, view: ViewRecord, palette: Palette) -> None:
    """Draw the labels of the score line."""
    _draw_label(image, view, palette, SCORE_LABEL, SCORE_X)
    _draw_label(image, view, palette, ROUND_LABEL, ROUND_X)
    _draw_label(image, view, palette, LIVES_LABEL, LIVES_X)


@kernel
def _draw_label(
    image: Image, view: ViewRecord, palette: Palette, codes: Codes, left: float
) -> None:
    """Draw a label of the score line."""
    x, y = to_pixels(view, left, LABEL_TOP)
    draw_text(image, codes, x, y, LABEL_HEIGHT * view.scale, palette[LABEL])


@inlined
def _draw_status_ground(image: Image, view: ViewRecord, palette: Palette) -> None:
    """Fill the lines of the status."""
    for row in range(view.lines[0], view.lines[STATUS_LINES]):
        for column in range(view.units[0], view.units[STATUS_UNITS]):
            for channel in range(image.shape[2]):
                image[row, column, channel] = round(palette[STATUS, channel])


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
