"""Drawing primitives: kernels that mix colours into a picture by the exact area they cover.

A picture is uint8 [height, width, channels]. Coordinates are float64 pixels: x to the right, y
down, and pixel (row r, column c) is the square from (c, r) to (c + 1, r + 1). A colour is float64
[channels], from 0 to 255; with one channel the same code draws in grey. What lies outside of the
picture is cut off. Nothing is allocated, and no display is needed.
"""

import math
from typing import Any

from ...physics.kernels import kernel

# Horizontal lines per pixel row along which round outlines are integrated: the midpoint rule on a
# width that only grows (or shrinks) within the row errs by less than 1 / 16 of a pixel.
SUBLINES = 8
# Below this difference (pixels) of the widths at its two ends, a trapezoid is taken as a rectangle;
# the exact formula would divide by nearly nothing.
NEARLY_UPRIGHT = 1e-6


@kernel
def mix(one: float, other: float, part: float) -> float:
    """Return the mixture of two numbers; part: of the other one, in [0, 1]."""
    return one + (other - one) * part


@kernel
def blend_channel(
    image: Any, row: int, column: int, channel: int, colour: float, coverage: float
) -> None:
    """Mix a colour's channel (0 to 255) into that of one pixel, by its coverage in [0, 1]."""
    image[row, column, channel] = int(
        mix(float(image[row, column, channel]), colour, coverage) + 0.5
    )


@kernel
def blend(image: Any, row: int, column: int, colour: Any, coverage: float) -> None:
    """Mix a colour into one pixel, by its coverage in [0, 1]."""
    for channel in range(image.shape[2]):
        blend_channel(image, row, column, channel, colour[channel], coverage)


@kernel
def overlap(low: float, high: float, lower: float, upper: float) -> float:
    """Return the length of [low, high] inside [lower, upper]."""
    return max(0.0, min(high, upper) - max(low, lower))


@kernel
def first_pixel(low: float) -> int:
    """Return the first pixel >= 0 that a range beginning at a coordinate touches."""
    return math.floor(max(low, 0.0))


@kernel
def last_pixel(high: float, size: int) -> int:
    """Return the end (exclusive, <= size) of the pixels that a range up to a coordinate touches."""
    return math.ceil(min(high, float(size)))


@kernel
def fill_rectangle(
    image: Any, left: float, top: float, right: float, bottom: float, upper: Any, lower: Any
) -> None:
    """Fill a rectangle with a vertical gradient between two colours (flat if they are the same)."""
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        height = overlap(float(row), row + 1.0, top, bottom)
        part = min(max((row + 0.5 - top) / (bottom - top), 0.0), 1.0)
        for column in range(first_pixel(left), last_pixel(right, image.shape[1])):
            coverage = height * overlap(float(column), column + 1.0, left, right)
            for channel in range(image.shape[2]):
                colour = mix(upper[channel], lower[channel], part)
                blend_channel(image, row, column, channel, colour, coverage)


@kernel
def rounded_coverage(
    row: int, column: int, left: float, top: float, right: float, bottom: float, radius: float
) -> float:
    """Return the part of a pixel that a rectangle with rounded corners covers, by `SUBLINES`."""
    low = max(float(row), top)
    high = min(row + 1.0, bottom)
    if high <= low:
        return 0.0
    area = 0.0
    for line in range(SUBLINES):
        y = low + (high - low) * ((line + 0.5) / SUBLINES)
        # How far the line lies beyond the centres of the corners' circles, and what that cuts off.
        beyond = max(max(top + radius - y, y - bottom + radius), 0.0)
        cut = radius - math.sqrt(max(radius * radius - beyond * beyond, 0.0))
        area += overlap(float(column), column + 1.0, left + cut, right - cut)
    return area * (high - low) / SUBLINES


@kernel
def fill_rounded_rectangle(
    image: Any,
    left: float,
    top: float,
    right: float,
    bottom: float,
    radius: float,
    colour: Any,
) -> None:
    """Fill a rectangle whose corners are rounded by a radius in pixels."""
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        for column in range(first_pixel(left), last_pixel(right, image.shape[1])):
            coverage = rounded_coverage(row, column, left, top, right, bottom, radius)
            blend(image, row, column, colour, coverage)


@kernel
def fill_disc(image: Any, x: float, y: float, radius: float, colour: Any) -> None:
    """Fill a disc; centre and radius in pixels."""
    fill_rounded_rectangle(image, x - radius, y - radius, x + radius, y + radius, radius, colour)


@kernel
def stroke_coverage(distance: float, half_width: float) -> float:
    """Return the part of a pixel under a stroke whose middle line passes at a distance, pixels.

    Exact for strokes along the axes, as if the pixel were turned along the stroke for others.
    """
    return overlap(distance - 0.5, distance + 0.5, -half_width, half_width)


@kernel
def draw_ring(image: Any, x: float, y: float, radius: float, width: float, colour: Any) -> None:
    """Draw a circle's line; centre, radius of the line's middle, and its width in pixels."""
    reach = radius + width / 2 + 1.0
    for row in range(first_pixel(y - reach), last_pixel(y + reach, image.shape[0])):
        for column in range(first_pixel(x - reach), last_pixel(x + reach, image.shape[1])):
            across, down = column + 0.5 - x, row + 0.5 - y
            distance = abs(math.sqrt(across * across + down * down) - radius)
            coverage = stroke_coverage(distance, width / 2)
            if coverage > 0.0:
                blend(image, row, column, colour, coverage)


@kernel
def squared_distance_to_segment(
    x: float, y: float, start_x: float, start_y: float, end_x: float, end_y: float
) -> float:
    """Return the squared distance of a point from a segment (its ends may coincide)."""
    along_x, along_y = end_x - start_x, end_y - start_y
    length = along_x * along_x + along_y * along_y
    part = 0.0
    if length > 0.0:
        part = ((x - start_x) * along_x + (y - start_y) * along_y) / length
        part = min(max(part, 0.0), 1.0)
    off_x, off_y = x - start_x - part * along_x, y - start_y - part * along_y
    return off_x * off_x + off_y * off_y


@kernel
def draw_line(
    image: Any,
    start_x: float,
    start_y: float,
    end_x: float,
    end_y: float,
    width: float,
    colour: Any,
) -> None:
    """Draw a line with round ends; coordinates and width in pixels."""
    reach = width / 2 + 1.0
    left, right = min(start_x, end_x) - reach, max(start_x, end_x) + reach
    top, bottom = min(start_y, end_y) - reach, max(start_y, end_y) + reach
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        for column in range(first_pixel(left), last_pixel(right, image.shape[1])):
            squared = squared_distance_to_segment(
                column + 0.5, row + 0.5, start_x, start_y, end_x, end_y
            )
            coverage = stroke_coverage(math.sqrt(squared), width / 2)
            if coverage > 0.0:
                blend(image, row, column, colour, coverage)


@kernel
def _integral_of_clamped(start: float, end: float, width: float) -> float:
    """Return the mean of min(max(t, 0), width) over t from start to end."""
    if abs(end - start) < NEARLY_UPRIGHT:
        return min(max((start + end) / 2, 0.0), width)
    below_end = min(max(end, 0.0), width)
    below_start = min(max(start, 0.0), width)
    # The antiderivative is 0, then t * t / 2, then a line of slope `width`.
    upper = below_end * below_end / 2 + max(end - width, 0.0) * width
    lower = below_start * below_start / 2 + max(start - width, 0.0) * width
    return (upper - lower) / (end - start)


@kernel
def area_beyond_edge(
    start_x: float, start_y: float, end_x: float, end_y: float, row: int, column: int
) -> float:
    """Return the signed area of a pixel to the right of an edge: positive if the edge runs down.

    By Green's theorem the sum over a polygon's edges is the exact area of the pixel inside it.
    """
    top = max(min(start_y, end_y), float(row))
    bottom = min(max(start_y, end_y), row + 1.0)
    if bottom <= top:
        return 0.0
    slope = (end_x - start_x) / (end_y - start_y)
    # The widths of what lies to the right, at the upper and the lower end of the edge's part.
    upper = column + 1.0 - (start_x + (top - start_y) * slope)
    lower = column + 1.0 - (start_x + (bottom - start_y) * slope)
    area = (bottom - top) * _integral_of_clamped(upper, lower, 1.0)
    return area if end_y > start_y else -area


@kernel
def convex_coverage(
    edges: Any, first: int, count: int, x: float, y: float, scale: float, row: int, column: int
) -> float:
    """Return the part of a pixel inside a bounded shape with the edges [first, first + count).

    Args:
        edges: `Edge` records in body coordinates (y up); x, y: the body's place in pixels.
        scale: pixels per unit of length.
    """
    area = 0.0
    for index in range(first, first + count):
        edge = edges[index]
        area += area_beyond_edge(
            x + edge.start_x * scale,
            y - edge.start_y * scale,
            x + edge.end_x * scale,
            y - edge.end_y * scale,
            row,
            column,
        )
    return min(abs(area), 1.0)


@kernel
def row_span(
    edges: Any, first: int, count: int, x: float, y: float, scale: float, row: int
) -> tuple[float, float, float, float, float]:
    """Return (begin, left, right, end, height): what of a row of pixels a shape covers.

    From begin to end it covers anything, and from left to right, between its sides, each pixel by
    the height. A height of 0 is that of an empty row. The arguments are `convex_coverage`'s.
    """
    begin, left, right, end, height = math.inf, -math.inf, math.inf, -math.inf, 0.0
    for index in range(first, first + count):
        edge = edges[index]
        start_x, start_y = x + edge.start_x * scale, y - edge.start_y * scale
        end_x, end_y = x + edge.end_x * scale, y - edge.end_y * scale
        top = max(min(start_y, end_y), float(row))
        bottom = min(max(start_y, end_y), row + 1.0)
        if bottom <= top:
            continue
        slope = (end_x - start_x) / (end_y - start_y)
        upper = start_x + (top - start_y) * slope
        lower = start_x + (bottom - start_y) * slope
        if end_y > start_y:  # counterclockwise edges run down on the left
            begin, left = min(begin, min(upper, lower)), max(left, max(upper, lower))
            height += bottom - top
        else:
            right, end = min(right, min(upper, lower)), max(end, max(upper, lower))
    return begin, left, right, end, height


@kernel
def span_coverage(
    span: tuple[float, float, float, float, float],
    edges: Any,
    first: int,
    count: int,
    x: float,
    y: float,
    scale: float,
    row: int,
    column: int,
) -> float:
    """Return `convex_coverage`, for which most pixels of a row need no more than its `row_span`."""
    if column >= span[1] and column + 1.0 <= span[2]:
        return span[4]
    return convex_coverage(edges, first, count, x, y, scale, row, column)


@kernel
def fill_convex(
    image: Any,
    shape: Any,
    edges: Any,
    x: float,
    y: float,
    scale: float,
    upper: Any,
    lower: Any,
) -> None:
    """Fill a bounded `Shape` without rounding, its body at a place in pixels; see below.

    The colours are those at its upper and lower end. A smaller scale than the picture's draws the
    shape smaller, about its body's place.
    """
    top, bottom = y - shape.upper_y * scale, y - shape.lower_y * scale
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        part = min(max((row + 0.5 - top) / (bottom - top), 0.0), 1.0)
        span = row_span(edges, shape.first, shape.count, x, y, scale, row)
        if span[4] == 0.0:
            continue
        for column in range(first_pixel(span[0]), last_pixel(span[3], image.shape[1])):
            coverage = span_coverage(
                span, edges, shape.first, shape.count, x, y, scale, row, column
            )
            for channel in range(image.shape[2]):
                colour = mix(upper[channel], lower[channel], part)
                blend_channel(image, row, column, channel, colour, coverage)
