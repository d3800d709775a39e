"""The motifs of generated levels: for every place a strength, and the layer that it belongs to.

Bricks are laid where a motif is strong, in the colour of their layer. Places are measured in brick
widths from the middle of the bricks' rows, x to the right and y down, so that a circle looks round.
A style is what a seed makes of a motif: six numbers in [0, 1).
"""

import math
from typing import Any

from ...physics.kernels import kernel
from .noise import noise

WAVE = 0
RINGS = 1
ISLANDS = 2
STRIPES = 3
NOISE = 4
MOTIF_COUNT = 5
MOTIFS = {"wave": WAVE, "rings": RINGS, "islands": ISLANDS, "stripes": STRIPES, "noise": NOISE}

# Where the numbers of islands and of the noise begin among those of a seed.
_ISLANDS_AT = 10_000
_NOISE_AT = 20_000
# So that the islands and the noise's corners, which lie on both sides of the middle, have numbers
# of their own that are not negative.
_MIDDLE = 32


@kernel
def zigzag(value: float) -> float:
    """Return a triangle wave of period 1, 0 at whole numbers and 1 between them."""
    return 1.0 - abs(2.0 * (value - math.floor(value)) - 1.0)


@kernel
def swell(value: float) -> float:
    """Return a wave of period 1 and from 0 to 1 like `zigzag`, made of parabolas."""
    slope = zigzag(value)
    if slope < 0.5:
        return 2.0 * slope * slope
    return 1.0 - 2.0 * (1.0 - slope) * (1.0 - slope)


@kernel
def motif_at(
    motif: int, style: tuple[float, ...], key: Any, x: float, y: float
) -> tuple[float, int]:
    """Return (strength in [0, 1], layer >= 0) of a motif at a place; style: six numbers."""
    if motif == WAVE:
        return _wave(style, x, y)
    if motif == RINGS:
        return _rings(style, x, y)
    if motif == ISLANDS:
        return _islands(style, key, x, y)
    if motif == STRIPES:
        return _stripes(style, x, y)
    return _noise(style, key, x, y)


@kernel
def _band(depth: float, thickness: float) -> tuple[float, int]:
    """Return (strength, layer) at a depth below the first of equally thick bands."""
    # Strongest in the middle of a band; the bands are counted from far above the first.
    position = depth / thickness + 16.0
    return zigzag(position), int(max(0.0, math.floor(position)))


@kernel
def _wave(style: tuple[float, ...], x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of bands that rise and fall, smoothly or in a zigzag."""
    length = 5.0 + 7.0 * style[0]
    height = 0.6 + 1.2 * style[1]
    # Half of them have a crest or a trough in the middle.
    shift = math.floor(4.0 * style[2]) / 2.0 if style[2] < 0.5 else style[2]
    along = x / length + shift
    crest = swell(along) if style[3] < 0.6 else zigzag(along)
    return _band(y - height * crest, 1.0 + 0.75 * style[4])


@kernel
def _rings(style: tuple[float, ...], x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of rings: boxes, diamonds or circles, one in another."""
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
def _islands(style: tuple[float, ...], key: Any, x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of islands in rows, every other row shifted by half a step."""
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
    """Return (strength, layer) of stripes: upright, level, slanted, in chevrons or crossed."""
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
def _noise(style: tuple[float, ...], key: Any, x: float, y: float) -> tuple[float, int]:
    """Return (strength, layer) of clouds: random heights at corners, smooth between them."""
    across = x / (2.0 + 2.0 * style[0]) + style[1] + _MIDDLE
    down = y / (1.0 + 1.0 * style[0]) + style[2] + _MIDDLE
    column, row = math.floor(across), math.floor(down)
    # Parabolas, as in `swell`: no creases at the corners.
    right = swell(0.5 * (across - column))
    lower = swell(0.5 * (down - row))
    corner = _NOISE_AT + int(row * 2 * _MIDDLE + column)
    upper_height = (1.0 - right) * noise(key, corner) + right * noise(key, corner + 1)
    corner += 2 * _MIDDLE
    lower_height = (1.0 - right) * noise(key, corner) + right * noise(key, corner + 1)
    height = (1.0 - lower) * upper_height + lower * lower_height
    # Layers like those of a map by heights, or level ones.
    layer = int(height * 6.0) if style[3] < 0.5 else int(max(0.0, y * 2.0 + _MIDDLE))
    return height, layer
