"""Drawing primitives: kernels that blend colours into a picture by the exact area they cover.

Coordinates are float64 pixels: x to the right, y down; pixel (row r, column c) is the square from
(c, r) to (c + 1, r + 1). With one channel the same code draws in grey. The picture's edges cut off
what lies outside.

Written by hand because pictures are observations: no library draws them inside compiled kernels,
without a display, and with the same bits on every machine.
"""

import math
from typing import Any, NamedTuple, TypeAlias

from ...physics.kernels import kernel
from ...physics.shapes.records import Edges, ShapeRecord

Image: TypeAlias = Any  # uint8 [height, width, channels]
Colour: TypeAlias = Any  # float64 [channels], from 0 to 255

# Horizontal lines per pixel row along which round outlines are integrated. The midpoint rule on a
# width that only grows (or shrinks) within the row errs by less than 1 / 16 of a pixel.
SUBLINES = 8
# A trapezoid whose two widths differ by less than this (pixels) counts as a rectangle: the exact
# formula would divide by nearly 0.
NEARLY_UPRIGHT = 1e-6


@kernel
def mix(one: float, other: float, part: float) -> float:
    """Return a mixture of two numbers; part in [0, 1] is the share of the other one."""
    return one + (other - one) * part


@kernel
def blend_channel(
    image: Image, row: int, column: int, channel: int, colour: float, coverage: float
) -> None:
    """Blend one channel of a colour (0 to 255) into a pixel, by coverage in [0, 1]."""
    image[row, column, channel] = int(
        mix(float(image[row, column, channel]), colour, coverage) + 0.5
    )


@kernel
def blend(image: Image, row: int, column: int, colour: Colour, coverage: float) -> None:
    """Blend a colour into a pixel, by coverage in [0, 1]."""
    for channel in range(image.shape[2]):
        blend_channel(image, row, column, channel, colour[channel], coverage)


@kernel
def overlap(low: float, high: float, lower: float, upper: float) -> float:
    """Return the length of [low, high] inside [lower, upper]."""
    return max(0.0, min(high, upper) - max(low, lower))


@kernel
def first_pixel(low: float) -> int:
    """Return the first pixel >= 0 that a range from a coordinate on touches."""
    return math.floor(max(low, 0.0))


@kernel
def last_pixel(high: float, size: int) -> int:
    """Return the end (exclusive, <= size) of the pixels that a range up to a coordinate touches."""
    return math.ceil(min(high, float(size)))


@kernel
def height_part(row: int, top: float, bottom: float) -> float:
    """Return where the middle of a row of pixels lies, from 0 at the top to 1 at the bottom."""
    return min(max((row + 0.5 - top) / (bottom - top), 0.0), 1.0)


@kernel
def fill_rectangle(
    image: Image, left: float, top: float, right: float, bottom: float, upper: Colour, lower: Colour
) -> None:
    """Fill a rectangle with a vertical gradient between two colours (flat if they are the same)."""
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        height = overlap(float(row), row + 1.0, top, bottom)
        part = height_part(row, top, bottom)
        for column in range(first_pixel(left), last_pixel(right, image.shape[1])):
            coverage = height * overlap(float(column), column + 1.0, left, right)
            for channel in range(image.shape[2]):
                colour = mix(upper[channel], lower[channel], part)
                blend_channel(image, row, column, channel, colour, coverage)


@kernel
def rounded_coverage(
    row: int, column: int, left: float, top: float, right: float, bottom: float, radius: float
) -> float:
    """Return the fraction of a pixel that a rectangle with rounded corners covers."""
    low = max(float(row), top)
    high = min(row + 1.0, bottom)
    if high <= low:
        return 0.0
    area = 0.0
    for line in range(SUBLINES):
        y = low + (high - low) * ((line + 0.5) / SUBLINES)
        # How far the line lies beyond the centres of the corners, and how much they cut off there.
        beyond = max(max(top + radius - y, y - bottom + radius), 0.0)
        cut = radius - math.sqrt(max(radius * radius - beyond * beyond, 0.0))
        area += overlap(float(column), column + 1.0, left + cut, right - cut)
    return area * (high - low) / SUBLINES


@kernel
def fill_rounded_rectangle(
    image: Image,
    left: float,
    top: float,
    right: float,
    bottom: float,
    radius: float,
    colour: Colour,
) -> None:
    """Fill a rectangle with rounded corners; radius in pixels."""
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        for column in range(first_pixel(left), last_pixel(right, image.shape[1])):
            coverage = rounded_coverage(row, column, left, top, right, bottom, radius)
            blend(image, row, column, colour, coverage)


@kernel
def fill_disc(image: Image, x: float, y: float, radius: float, colour: Colour) -> None:
    """Fill a disc; centre and radius in pixels."""
    fill_rounded_rectangle(image, x - radius, y - radius, x + radius, y + radius, radius, colour)


@kernel
def stroke_coverage(distance: float, half_width: float) -> float:
    """Return the fraction of a pixel under a stroke, from its distance to the stroke's middle line.

    Distance and half width are in pixels. The result is exact for strokes along an axis; for others
    it is as if the pixel were turned to face the stroke.
    """
    return overlap(distance - 0.5, distance + 0.5, -half_width, half_width)


@kernel
def squared_distance_to_segment(
    x: float, y: float, start_x: float, start_y: float, end_x: float, end_y: float
) -> float:
    """Return the squared distance of a point from a segment, which may have no length."""
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
    image: Image,
    start_x: float,
    start_y: float,
    end_x: float,
    end_y: float,
    width: float,
    colour: Colour,
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
    # How much of the pixel lies to the right, at the upper and the lower end of the edge's part.
    upper = column + 1.0 - (start_x + (top - start_y) * slope)
    lower = column + 1.0 - (start_x + (bottom - start_y) * slope)
    area = (bottom - top) * _integral_of_clamped(upper, lower, 1.0)
    return area if end_y > start_y else -area


@kernel
def convex_coverage(
    shape: ShapeRecord, edges: Edges, x: float, y: float, scale: float, row: int, column: int
) -> float:
    """Return the fraction of a pixel inside a bounded shape without rounding.

    Args:
        shape: `Shape` record; edges: `Edge` records of all shapes, in body coordinates, y up.
        x, y: the body's position in pixels; scale: pixels per unit of length.
        row, column: the pixel.
    """
    area = 0.0
    for index in range(shape.first, shape.first + shape.count):
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


class Span(NamedTuple):
    """The part of a pixel row that a shape covers, in pixels.

    From begin to end the shape covers something. From left to right it covers each pixel fully from
    side to side, by the height. An empty span has the height 0.
    """

    begin: float
    left: float
    right: float
    end: float
    height: float


@kernel
def row_span(shape: ShapeRecord, edges: Edges, x: float, y: float, scale: float, row: int) -> Span:
    """Return the `Span` of a row of pixels; the arguments are those of `convex_coverage`."""
    begin, left, right, end, height = math.inf, -math.inf, math.inf, -math.inf, 0.0
    for index in range(shape.first, shape.first + shape.count):
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
    return Span(begin, left, right, end, height)


@kernel
def span_coverage(
    span: Span,
    shape: ShapeRecord,
    edges: Edges,
    x: float,
    y: float,
    scale: float,
    row: int,
    column: int,
) -> float:
    """Return what `convex_coverage` returns; for most pixels the `Span` of their row is enough."""
    if column >= span.left and column + 1.0 <= span.right:
        return span.height
    return convex_coverage(shape, edges, x, y, scale, row, column)


@kernel
def fill_convex(
    image: Image,
    shape: ShapeRecord,
    edges: Edges,
    x: float,
    y: float,
    scale: float,
    upper: Colour,
    lower: Colour,
) -> None:
    """Fill a bounded `Shape` without rounding with a vertical gradient.

    The colours are those at its upper and lower end. A smaller scale than the picture's draws the
    shape smaller, about its body's position.
    """
    top, bottom = y - shape.upper_y * scale, y - shape.lower_y * scale
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        part = height_part(row, top, bottom)
        span = row_span(shape, edges, x, y, scale, row)
        if span.height == 0.0:
            continue
        for column in range(first_pixel(span.begin), last_pixel(span.end, image.shape[1])):
            coverage = span_coverage(span, shape, edges, x, y, scale, row, column)
            for channel in range(image.shape[2]):
                colour = mix(upper[channel], lower[channel], part)
                blend_channel(image, row, column, channel, colour, coverage)
