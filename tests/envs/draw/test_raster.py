"""Drawing primitives against the areas that Shapely or a formula gives."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.draw.raster import (
    NEARLY_UPRIGHT,
    SUBLINES,
    convex_coverage,
    draw_line,
    fill_convex,
    fill_disc,
    fill_rectangle,
    fill_rounded_rectangle,
    rounded_coverage,
    stroke_coverage,
)
from arkanoid.physics.shapes.records import Edge, Shape
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely import LineString, MultiPoint, Point, Polygon, area, box, intersection
from shapely.geometry.polygon import orient

SIZE = 24
WHITE = np.full(3, 255.0)
GREY = np.array([255.0])
# The error of storing a pixel as an integer, as coverage.
ROUNDING = 0.5 / 255
# The error of a box filter along the normal of a straight edge. It is largest at 45 degrees, where
# the edge cuts off a corner of the pixel that the filter does not see: (sqrt(2) - 1)^2 / 4.
SLANTED_EDGE = (math.sqrt(2) - 1) ** 2 / 4

# The first example may compile kernels.
PROPERTY = settings(deadline=None, max_examples=50)

Draw = Callable[[NDArray[np.uint8], float, float], None]


def canvas(channels: int = 1, size: int = SIZE) -> NDArray[np.uint8]:
    return np.zeros((size, size, channels), np.uint8)


def coverage(image: NDArray[np.uint8]) -> NDArray[np.float64]:
    return image[:, :, 0] / 255.0


def exact_coverage(region: Any, size: int = SIZE) -> NDArray[np.float64]:
    """The area of a Shapely region within each pixel."""
    columns, rows = np.meshgrid(np.arange(size), np.arange(size))
    return area(intersection(box(columns, rows, columns + 1, rows + 1), region))


def convex_shape(points: NDArray[np.float64]) -> tuple[Any, Any]:
    """A `Shape` and its `Edge` records for counterclockwise points: only what drawing reads."""
    edges = np.zeros(len(points), Edge)
    edges["start_x"], edges["start_y"] = points.T
    edges["end_x"], edges["end_y"] = np.roll(points, -1, axis=0).T
    shape = np.zeros(1, Shape)
    shape["count"] = len(points)
    shape["lower_x"], shape["lower_y"] = points.min(axis=0)
    shape["upper_x"], shape["upper_y"] = points.max(axis=0)
    return shape[0], edges


def hull_points(seed: int, corners: int) -> NDArray[np.float64]:
    """A random convex polygon about the origin, counterclockwise."""
    points = np.random.default_rng(seed).uniform(-1.0, 1.0, (corners, 2))
    hull = orient(MultiPoint(points).convex_hull)
    return np.array(hull.exterior.coords)[:-1]


inside = st.floats(4.0, 20.0)
middle = st.floats(8.0, 16.0)
length = st.floats(0.01, 12.0)


@PROPERTY
@given(left=inside, top=inside, width=length, height=length)
def test_a_rectangle_covers_its_exact_area_in_every_pixel(
    left: float, top: float, width: float, height: float
) -> None:
    image = canvas()
    fill_rectangle(image, left, top, left + width, top + height, GREY, GREY)
    exact = exact_coverage(box(left, top, left + width, top + height))
    np.testing.assert_allclose(coverage(image), exact, rtol=0, atol=ROUNDING + 1e-12)


def test_a_rectangle_shades_from_one_colour_to_the_other() -> None:
    image = canvas()
    fill_rectangle(image, 0.0, 0.0, 24.0, 24.0, np.array([0.0]), np.array([240.0]))
    # At a pixel's middle: 240 * (row + 1/2) / 24, rounded (halves upwards).
    expected = (np.arange(24) * 10 + 5).astype(np.uint8)
    np.testing.assert_array_equal(image[:, 7, 0], expected)
    assert (image == image[:, :1]).all()


@PROPERTY
@given(x=middle, y=middle, radius=st.floats(0.05, 7.0))
def test_a_discs_pixels_are_exact_to_the_bound_of_its_integration(
    x: float, y: float, radius: float
) -> None:
    exact = exact_coverage(Point(x, y).buffer(radius, quad_segs=512))
    drawn = np.array(
        [
            [
                rounded_coverage(
                    row, column, x - radius, y - radius, x + radius, y + radius, radius
                )
                for column in range(SIZE)
            ]
            for row in range(SIZE)
        ]
    )
    # The midpoint rule errs by at most half a step times the total variation of the integrand:
    # within a pixel the width may grow by 1 and shrink by 1.
    assert np.abs(drawn - exact).max() <= 2 * 0.5 / SUBLINES
    # The whole chord grows to 2 r and shrinks again.
    assert abs(drawn.sum() - math.pi * radius**2) <= 4 * radius * 0.5 / SUBLINES


@PROPERTY
@given(left=inside, top=inside, width=length, height=length)
def test_a_rounded_rectangle_without_radius_is_a_rectangle(
    left: float, top: float, width: float, height: float
) -> None:
    sharp, rounded = canvas(3), canvas(3)
    fill_rectangle(sharp, left, top, left + width, top + height, WHITE, WHITE)
    fill_rounded_rectangle(rounded, left, top, left + width, top + height, 0.0, WHITE)
    # Summing eight equal parts may round the other way.
    assert np.abs(sharp.astype(int) - rounded.astype(int)).max() <= 1


@PROPERTY
@given(
    seed=st.integers(0, 10**6),
    corners=st.integers(3, 12),
    x=inside,
    y=inside,
    scale=st.floats(0.3, 9.0),
)
def test_a_convex_polygon_covers_its_exact_area_in_every_pixel(
    seed: int, corners: int, x: float, y: float, scale: float
) -> None:
    points = hull_points(seed, corners)
    shape, edges = convex_shape(points)
    drawn = np.array(
        [
            [convex_coverage(shape, edges, x, y, scale, row, column) for column in range(SIZE)]
            for row in range(SIZE)
        ]
    )
    # The picture's y points down.
    exact = exact_coverage(Polygon(points * (scale, -scale) + (x, y)))
    np.testing.assert_allclose(drawn, exact, rtol=0, atol=NEARLY_UPRIGHT)
    image = canvas()
    fill_convex(image, shape, edges, x, y, scale, GREY, GREY)
    np.testing.assert_allclose(coverage(image), exact, rtol=0, atol=ROUNDING + NEARLY_UPRIGHT)


@PROPERTY
@given(
    start=st.tuples(inside, inside),
    end=st.tuples(inside, inside),
    width=st.floats(1.0, 4.0),
)
def test_a_line_agrees_with_shapely_except_for_slanted_edges(
    start: tuple[float, float], end: tuple[float, float], width: float
) -> None:
    image = canvas()
    draw_line(image, *start, *end, width, GREY)
    exact = exact_coverage(LineString([start, end]).buffer(width / 2, quad_segs=64))
    # At the round ends this bound does not hold; elsewhere a pixel may see both edges.
    middles = [[Point(column + 0.5, row + 0.5) for column in range(SIZE)] for row in range(SIZE)]
    away = np.array(
        [
            [min(p.distance(Point(start)), p.distance(Point(end))) > width / 2 + 1 for p in line]
            for line in middles
        ]
    )
    error = np.abs(coverage(image) - exact)
    assert error[away].max(initial=0.0) <= 2 * SLANTED_EDGE + ROUNDING


@PROPERTY
@given(distance=st.floats(-3.0, 3.0), half_width=st.floats(0.01, 2.0))
def test_a_stroke_along_an_axis_is_covered_exactly(distance: float, half_width: float) -> None:
    pixel = box(distance - 0.5, -0.5, distance + 0.5, 0.5)
    stroke = box(-half_width, -9.0, half_width, 9.0)
    exact = pixel.intersection(stroke).area
    assert stroke_coverage(abs(distance), half_width) == pytest.approx(exact, abs=1e-12)


# The sizes are sums of powers of two, so that moving by whole pixels causes no rounding.
PRIMITIVES: dict[str, Draw] = {
    "rectangle": lambda image, x, y: fill_rectangle(
        image, x - 3.25, y - 2.125, x + 3.25, y + 2.125, WHITE, WHITE
    ),
    "rounded rectangle": lambda image, x, y: fill_rounded_rectangle(
        image, x - 3.25, y - 2.125, x + 3.25, y + 2.125, 1.25, WHITE
    ),
    "disc": lambda image, x, y: fill_disc(image, x, y, 3.75, WHITE),
    "line": lambda image, x, y: draw_line(image, x - 4.0, y, x + 4.0, y, 1.5, WHITE),
    "convex": lambda image, x, y: fill_convex(
        image,
        *convex_shape(
            np.array([(1.0, 0.0), (0.5, 0.75), (-0.5, 0.75), (-1.0, 0.0), (0.0, -0.875)])
        ),
        x,
        y,
        4.0,
        WHITE,
        WHITE,
    ),
}


@pytest.mark.parametrize("name", PRIMITIVES)
@pytest.mark.parametrize("centre", [12.0, 12.5])
def test_symmetric_shapes_draw_symmetric_pixels(name: str, centre: float) -> None:
    """Left and right are equal bit for bit, and so are the channels."""
    image = canvas(3, size=int(2 * centre))
    PRIMITIVES[name](image, centre, centre)
    assert image.any()
    np.testing.assert_array_equal(image, image[:, ::-1])
    np.testing.assert_array_equal(image[:, :, 0], image[:, :, 2])


@pytest.mark.parametrize("name", PRIMITIVES)
@PROPERTY
@given(x=st.integers(-60, 60), y=st.integers(-60, 60), part=st.sampled_from([0.0, 0.25, 0.5]))
def test_what_lies_outside_is_cut_off(name: str, x: int, y: int, part: float) -> None:
    """The result equals the middle of a larger picture, in which nothing is cut off."""
    small, large = canvas(3), canvas(3, size=160)
    PRIMITIVES[name](small, x + part, y + part)
    PRIMITIVES[name](large, x + part + 64, y + part + 64)
    np.testing.assert_array_equal(small, large[64 : 64 + SIZE, 64 : 64 + SIZE])


def test_colours_are_blended_by_coverage() -> None:
    image = np.full((1, 1, 3), 100, np.uint8)
    colour = np.array([200.0, 100.0, 0.0])
    fill_rectangle(image, 0.25, 0.0, 1.0, 1.0, colour, colour)
    np.testing.assert_array_equal(image[0, 0], [175, 100, 25])
