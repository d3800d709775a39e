"""A stroke font: capitals, digits and some punctuation, drawn at any size.

Each glyph is a set of strokes on a grid 4 wide and 6 high, with corners cut at 45 degrees. A stroke
is written as points joined by hyphens, a point as its two coordinates: ``"00-26-40 12-32"`` is an
A. All strokes of a glyph are drawn at once, so that they join without a seam.

Our own font, because the score line is part of observations: it must be compiled and the same on
every machine.
"""

import itertools
import math
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import kernel
from .raster import (
    Colour,
    Image,
    blend,
    first_pixel,
    last_pixel,
    squared_distance_to_segment,
    stroke_coverage,
)

Codes: TypeAlias = Any  # int64 [n], the ASCII codes of a text

# In units of the grid.
GRID_HEIGHT = 6.0
ADVANCE = 5.6  # from one glyph to the next
STROKE = 0.95  # the width of a stroke
GLYPH_WIDTH = (4.0 + STROKE) / (GRID_HEIGHT + STROKE)  # as a fraction of a glyph's height

GLYPHS = {
    " ": "",
    "!": "26-22 20-20",
    "%": "00-46 05-05 41-41",
    "'": "26-24",
    "(": "36-24-22-30",
    ")": "16-24-22-10",
    "+": "03-43 21-25",
    ",": "21-10",
    "-": "03-43",
    ".": "20-20",
    "/": "00-46",
    "0": "10-01-05-16-36-45-41-30-10",
    "1": "14-26-20 10-30",
    "2": "05-16-36-45-44-00-40",
    "3": "05-16-36-45-44-33-13 33-42-41-30-10-01",
    "4": "30-36-02-42",
    "5": "46-06-03-33-42-41-30-10-01",
    "6": "45-36-16-05-01-10-30-41-42-33-03",
    "7": "06-46-45-20",
    "8": "13-04-05-16-36-45-44-33-13-02-01-10-30-41-42-33",
    "9": "01-10-30-41-45-36-16-05-04-13-43",
    ":": "21-21 24-24",
    "=": "02-42 04-44",
    "?": "05-16-36-45-44-22 20-20",
    "A": "00-04-26-44-40 02-42",
    "B": "00-06-36-45-44-33-03 33-42-41-30-00",
    "C": "45-36-16-05-01-10-30-41",
    "D": "00-06-26-44-42-20-00",
    "E": "46-06-00-40 03-33",
    "F": "46-06-00 03-33",
    "G": "45-36-16-05-01-10-30-41-43-23",
    "H": "00-06 40-46 03-43",
    "I": "10-30 20-26 16-36",
    "J": "01-10-30-41-46",
    "K": "00-06 46-03-40",
    "L": "06-00-40",
    "M": "00-06-23-46-40",
    "N": "00-06-40-46",
    "O": "10-01-05-16-36-45-41-30-10",
    "P": "00-06-36-45-44-33-03",
    "Q": "10-01-05-16-36-45-41-30-10 22-40",
    "R": "00-06-36-45-44-33-03 23-40",
    "S": "45-36-16-05-04-13-33-42-41-30-10-01",
    "T": "06-46 20-26",
    "U": "06-01-10-30-41-46",
    "V": "06-20-46",
    "W": "06-10-23-30-46",
    "X": "00-46 06-40",
    "Y": "06-23-46 20-23",
    "Z": "06-46-00-40",
}


def _segments(strokes: str) -> list[tuple[float, ...]]:
    """Return the segments (start_x, start_y, end_x, end_y) of a glyph."""
    found: list[tuple[float, ...]] = []
    for stroke in strokes.split():
        points = [(float(point[0]), float(point[1])) for point in stroke.split("-")]
        found += [(*start, *end) for start, end in itertools.pairwise(points)]
    return found


def _tables() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return all segments, and the index of the first one of each ASCII code."""
    segments: list[tuple[float, ...]] = []
    first = [0]
    for code in range(128):
        segments += _segments(GLYPHS.get(chr(code), ""))
        first.append(len(segments))
    return np.array(segments), np.array(first)


_SEGMENTS, _FIRST = _tables()
_ZERO = ord("0")


def encode(text: str) -> NDArray[np.int64]:
    """Return the codes of a text, int64 [n], for `draw_text`; small letters become capitals.

    Raises:
        ValueError: the font has no glyph for a character.
    """
    capitals = text.upper()
    for character in capitals:
        if character not in GLYPHS:
            raise ValueError(
                f"the font has no {character!r} (of {text!r}); it has {''.join(GLYPHS)!r}"
            )
    return np.array([ord(character) for character in capitals], np.int64)


@kernel
def text_step(height: float) -> float:
    """Return the distance from glyph to glyph in a text of some height."""
    return height * ADVANCE / (GRID_HEIGHT + STROKE)


@kernel
def draw_glyph(image: Image, code: int, x: float, y: float, height: float, colour: Colour) -> None:
    """Draw the glyph of an ASCII code; x, y: its upper left corner, in pixels like the height."""
    scale = height / (GRID_HEIGHT + STROKE)
    half = STROKE / 2 * scale
    left, bottom = x + half, y + height - half
    first, end = _FIRST[code], _FIRST[code + 1]
    if first == end:
        return
    for row in range(first_pixel(y - 1.0), last_pixel(y + height + 1.0, image.shape[0])):
        grid_y = (bottom - row - 0.5) / scale
        for column in range(
            first_pixel(x - 1.0), last_pixel(x + 5.0 * scale + 1.0, image.shape[1])
        ):
            grid_x = (column + 0.5 - left) / scale
            nearest = math.inf
            for index in range(first, end):
                squared = squared_distance_to_segment(
                    grid_x,
                    grid_y,
                    _SEGMENTS[index, 0],
                    _SEGMENTS[index, 1],
                    _SEGMENTS[index, 2],
                    _SEGMENTS[index, 3],
                )
                nearest = min(nearest, squared)
            coverage = stroke_coverage(math.sqrt(nearest) * scale, half)
            if coverage > 0.0:
                blend(image, row, column, colour, coverage)


@kernel
def draw_text(
    image: Image, codes: Codes, x: float, y: float, height: float, colour: Colour
) -> None:
    """Draw a text, see `encode`; x, y: its upper left corner, in pixels like the height."""
    step = text_step(height)
    for index in range(codes.shape[0]):
        draw_glyph(image, codes[index], x + index * step, y, height, colour)


@kernel
def count_digits(value: int) -> int:
    """Return the number of decimal digits of an integer >= 0."""
    count = 1
    while value >= 10:
        value //= 10
        count += 1
    return count


@kernel
def draw_number(
    image: Image, value: int, x: float, y: float, height: float, colour: Colour
) -> None:
    """Draw an integer >= 0; x, y: its upper left corner, in pixels like the height."""
    step = text_step(height)
    count = count_digits(value)
    for index in range(count):
        rest = value
        for _ in range(count - 1 - index):
            rest //= 10
        draw_glyph(image, _ZERO + rest % 10, x + index * step, y, height, colour)
