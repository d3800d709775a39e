"""The motifs of generated levels: at each point a motif has a strength and a layer.

Bricks lie where a motif is strong, in the colour of their layer. Coordinates are in brick widths
from the middle of the bricks' rows, x to the right and y down, so that a circle looks round. A
style is what a seed makes of a motif: six numbers in [0, 1).
"""

import math

import numpy as np

from ...physics.kernels import kernel
from .noise import noise

WAVE = 0
RINGS = 1
ISLANDS = 2
STRIPES = 3
NOISE = 4
MOTIF_COUNT = 5
MOTIFS = {"wave": WAVE, "rings": RINGS, "islands": ISLANDS, "stripes": STRIPES, "noise": NOISE}

# The first index of the islands' and of the clouds' random numbers.
_ISLANDS_AT = 10_000
_CLOUDS_AT = 20_000
# Islands and the clouds' corners lie on both sides of the middle. This offset makes their indices
# positive.
_MIDDLE = 32


@kernel
def zigzag(value: float) -> float:
    """Return a triangle wave of period 1: 0 at whole numbers, 1 halfway between them."""
    return 1.0 - abs(2.0 * (value - math.floor(value)) - 1.0)


@kernel
def swell(value: float) -> float:
    """Return a smooth wave like `zigzag`, made of parabolas."""
    slope = zigzag(value)
    if slope < 0.5:
        return 2.0 * slope * slope
    return 1.0 - 2.0 * (1.0 - slope) * (1.0 - slope)


@kernel
def motif_at(
    motif: int, style: tuple[float, ...], key: np.uint64, x: float, y: float
) -> tuple[float, int]:
    """Return (strength in [0, 1], layer >= 0) of a motif at a point; style: six numbers."""
    if motif == WAVE:
        return _wave(style, x, y)
    if motif == RINGS:
        return _rings(style, x, y)
    if motif == ISLANDS:
        return _islands(style, key, x, y)
    if motif == STRIPES:
        return _stripes(style, x, y)
    return _clouds(style, key, x, y)


@kernel
def _band(depth: float, thickness: float) -> tuple[float, int]:
    """Return (strength, layer) at a depth in bands of equal thickness."""
    # Strongest in the middle of a band. Bands above depth 0 need layers >= 0, too.
    position = depth / thickness + 16.0
    return zigzag(position), int(max(0.0, math.floor(position)))


@kernel
def _wave(style: tuple[float, ...], x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of bands that rise and fall, smoothly or in zigzags."""
    length = 5.0 + 7.0 * style[0]
    height = 0.6 + 1.2 * style[1]
    # Half of the waves have a crest or a trough in the middle.
    shift = math.floor(4.0 * style[2]) / 2.0 if style[2] < 0.5 else style[2]
    along = x / length + shift
    crest = swell(along) if style[3] < 0.6 else zigzag(along)
    return _band(y - height * crest, 1.0 + 0.75 * style[4])


@kernel
def _rings(style: tuple[float, ...], x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of nested rings: boxes, diamonds or circles."""
    aside = 0.0 if style[0] < 0.6 else 7.0 * (style[0] - 0.8)
    across, down = abs(x - aside), abs(y) * (1.0 + style[1])
    if style[2] < 0.35:
        radius = max(across, down)
    elif style[2] < 0.7:
        radius = 0.75 * (across + down)
    else:
        radius = math.sqrt(across * across + down * down)
    return _band(radius + style[3], 1.0 + style[4])


@kernel
def _islands(style: tuple[float, ...], key: np.uint64, x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of islands in rows; every other row is shifted by half a step."""
    step_x, step_y = 2.6 + 1.6 * style[0], 1.6 + 1.2 * style[1]
    down = y / step_y + style[2]
    row = math.floor(down)
    across = x / step_x + (0.5 if (int(row) + _MIDDLE) % 2 else 0.0) + (style[3] < 0.5) * 0.5
    column = math.floor(across)
    island = int((row + _MIDDLE) * 2 * _MIDDLE + column + _MIDDLE)
    from_x, from_y = abs(across - column - 0.5) * step_x, abs(down - row - 0.5) * step_y
    distance = from_x + from_y
    if style[4] >= 0.5:
        distance = math.sqrt(from_x * from_x + from_y * from_y)
    size = 1.2 + 0.6 * noise(key, _ISLANDS_AT + island)
    layer = int(distance * 1.6) if style[5] < 0.5 else island
    return max(0.0, 1.0 - distance / (1.5 * size)), layer


@kernel
def _stripes(style: tuple[float, ...], x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of stripes: vertical, horizontal, slanted, chevrons or crossed."""
    thickness = 1.0 + style[1]
    if style[0] < 0.2:
        return _band(x + 0.5 * thickness, 1.0 if style[1] < 0.3 else 2.0)
    if style[0] < 0.35:
        return _band(y, 0.5 * thickness + 0.25)
    slope = 0.5 + math.floor(3.0 * style[2]) / 2.0
    if style[0] < 0.6:
        return _band(y + (slope if style[3] < 0.5 else -slope) * x, thickness + 0.5 * slope)
    if style[0] < 0.8:
        return _band(y + (slope if style[3] < 0.5 else -slope) * abs(x), thickness + 0.5 * slope)
    first, layer = _band(y + slope * x, thickness + slope)
    second, other = _band(y - slope * x, thickness + slope)
    return max(first, second), layer + other


@kernel
def _clouds(style: tuple[float, ...], key: np.uint64, x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of clouds: random heights at grid corners, smooth between them."""
    across = x / (2.0 + 2.0 * style[0]) + style[1] + _MIDDLE
    down = y / (1.0 + 1.0 * style[0]) + style[2] + _MIDDLE
    column, row = math.floor(across), math.floor(down)
    # Parabolas, as in `swell`: no creases at the corners.
    right = swell(0.5 * (across - column))
    lower = swell(0.5 * (down - row))
    corner = _CLOUDS_AT + int(row * 2 * _MIDDLE + column)
    upper_height = (1.0 - right) * noise(key, corner) + right * noise(key, corner + 1)
    corner += 2 * _MIDDLE
    lower_height = (1.0 - right) * noise(key, corner) + right * noise(key, corner + 1)
    height = (1.0 - lower) * upper_height + lower * lower_height
    # Layers by height, as on a map, or horizontal ones.
    layer = int(height * 6.0) if style[3] < 0.5 else int(max(0.0, y * 2.0 + _MIDDLE))
    return height, layer
