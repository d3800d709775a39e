import copy
import math
import pickle
from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np
import pytest
import shapely
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
)
from arkanoid.physics.shapes.table import shape_table
from hypothesis import example, given
from hypothesis import strategies as st

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]

SAMPLES: tuple[Collider, ...] = (
    Particle(0.5),
    HalfPlane((1, 2), 0.25),
    AxisAlignedHalfPlane("-y", 0.5),
    AxisAlignedRectangle(2, 1),
    Rectangle(2, 1, 0.5),
    Convex([(0, 0), (2, 0), (1, 1.5)], rotation=0.3),
    Convex(SQUARE, [2]),
)


@pytest.mark.parametrize("collider", SAMPLES)
def test_colliders_are_values(collider: Collider) -> None:
    assert collider.edges is not None  # fills the cached properties
    twin = pickle.loads(pickle.dumps(collider))
    assert twin == collider == copy.deepcopy(collider)
    assert hash(twin) == hash(collider)
    assert len({twin, collider}) == 1
    assert all(collider != other for other in SAMPLES if other is not collider)
    for name in ("kind", "edges", "radius", "normal", "anything"):
        with pytest.raises((FrozenInstanceError, AttributeError)):
            setattr(collider, name, 1.0)


@pytest.mark.parametrize("collider", SAMPLES)
def test_a_collider_prints_as_the_expression_that_makes_it(collider: Collider) -> None:
    remade = eval(repr(collider))
    assert type(remade) is type(collider)
    rebuilt, original = (np.array(c.edges, float) for c in (remade, collider))
    np.testing.assert_allclose(rebuilt, original, rtol=0, atol=1e-15)


def test_printed_colliders() -> None:
    assert repr(Particle(1)) == "Particle(radius=1.0)"
    assert repr(AxisAlignedHalfPlane("+y")) == "AxisAlignedHalfPlane(direction='+y', offset=0.0)"
    assert repr(Rectangle(2, 1)) == "Rectangle(width=2.0, height=1.0, rotation=0.0)"
    triangle = "Convex(vertices=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))"
    assert repr(Convex([(0, 0), (1, 0), (0, 1)])) == triangle
    assert repr(Convex([(1, 0), (0, 1), (0, 0)])) == triangle
    assert repr(Convex(SQUARE, [1, 2, 3])) == (
        "Convex.from_half_planes(HalfPlane(normal=(0.0, -1.0), offset=0.0))"
    )


NOT_SIZES = [0, -1, -0.0, math.nan, math.inf, -math.inf]


@pytest.mark.parametrize("size", NOT_SIZES)
def test_sizes_must_be_positive_and_finite(size: float) -> None:
    for make in (AxisAlignedRectangle, Rectangle):
        with pytest.raises(ValueError, match="width must be"):
            make(size, 1)
        with pytest.raises(ValueError, match="height must be"):
            make(1, size)


@pytest.mark.parametrize("radius", [-1, math.nan, math.inf])
def test_a_radius_must_not_be_negative(radius: float) -> None:
    with pytest.raises(ValueError, match=r"radius must .* but is (-1|nan|inf)"):
        Particle(radius)


def test_a_radius_may_be_0() -> None:
    assert Particle(0).radius == 0.0


@pytest.mark.parametrize("value", ["1", None, 1j, True, [1]])
def test_sizes_must_be_numbers(value: Any) -> None:
    with pytest.raises(TypeError, match="radius must be a number"):
        Particle(value)
    with pytest.raises(TypeError, match="rotation must be a number"):
        Rectangle(1, 1, value)


@pytest.mark.parametrize("number", [np.float32(0.5), np.int64(2), np.float64(0.1)])
def test_numpy_numbers_become_floats(number: Any) -> None:
    assert type(Particle(number).radius) is float
    assert hash(Particle(number)) == hash(Particle(float(number)))


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_offsets_and_angles_must_be_finite(bad: float) -> None:
    with pytest.raises(ValueError, match="offset must be finite"):
        HalfPlane((1, 0), bad)
    with pytest.raises(ValueError, match="offset must be finite"):
        AxisAlignedHalfPlane("+x", bad)
    with pytest.raises(ValueError, match="rotation must be finite"):
        Rectangle(1, 1, bad)
    with pytest.raises(ValueError, match="rotation must be finite"):
        Convex(SQUARE, rotation=bad)
    with pytest.raises(ValueError, match=r"normal\[0\] must be finite"):
        HalfPlane((bad, 0))


def test_a_half_plane_needs_a_direction() -> None:
    with pytest.raises(ValueError, match="normal must have a direction"):
        HalfPlane((0, 0))
    with pytest.raises(ValueError, match="two numbers"):
        HalfPlane((1, 0, 0))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="two numbers"):
        HalfPlane(1.0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"direction must be one of \+x, -x, \+y, -y"):
        AxisAlignedHalfPlane("up")  # type: ignore[arg-type]


def test_a_half_plane_normalises_without_changing_its_region() -> None:
    plane = HalfPlane((3, -4), 10)
    assert plane.normal == (0.6, -0.8)
    assert plane.offset == 2.0
    assert HalfPlane((0, -7), 7).edges == AxisAlignedHalfPlane("-y", 1).edges


@pytest.mark.parametrize("quarters", range(-9, 10))
def test_quarter_turns_are_exact(quarters: int) -> None:
    width, height = (3.0, 1.0) if quarters % 2 == 0 else (1.0, 3.0)
    for angle in (quarters * math.pi / 2, quarters * (math.pi / 2), math.radians(90 * quarters)):
        (turned,), (plain,) = (
            shape_table([box])[0] for box in (Rectangle(3, 1, angle), Rectangle(width, height))
        )
        assert turned.tolist()[4:] == plain.tolist()[4:]
        polygon = Convex([(1.5, 0.5), (-1.5, 0.5), (-1.5, -0.5), (1.5, -0.5)], rotation=angle)
        assert {abs(x) for x, _ in polygon.vertices} == {width / 2}
        assert {abs(y) for _, y in polygon.vertices} == {height / 2}


@pytest.mark.parametrize(
    ("vertices", "words"),
    [
        ([(0, 0), (0, 1), (1, 1), (1, 0)], "clockwise"),
        ([(0, 0), (2, 0), (0.5, 0.5), (0, 2)], "not convex: it turns to the right at vertex 2"),
        ([(0, 0), (1, 1), (2, 2)], "degenerate"),
        ([(0, 0), (1, 0), (2, 0), (1, 0.0)], "degenerate"),
        ([(0, 0), (1, 0)], "at least three"),
        ([(0, 0)], "at least three"),
        ([], "at least three"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "vertices 1 and 2 are the same"),
        ([(0, 0), (1, 0), (0, 1), (0, 0)], "vertices 3 and 0 are the same"),
        ([(0, 0), (math.nan, 0), (0, 1)], r"vertices\[1\]\[0\] must be finite"),
        ([(0, 0), (1, 0, 0), (0, 1)], r"vertices\[1\] must be two numbers"),
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "degenerate|clockwise|not convex"),
        (
            [(math.cos(4 * math.pi * i / 5), math.sin(4 * math.pi * i / 5)) for i in range(5)],
            "winds more than once",
        ),
    ],
)
def test_an_invalid_polygon_is_refused(vertices: list[Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Convex(vertices)


@pytest.mark.parametrize(
    ("open_edges", "words"),
    [
        ([4], "edge 4, but there are edges 0 to 3"),
        ([-1], "edge -1"),
        ([0, 1, 2, 3], "every edge"),
    ],
)
def test_open_edges_must_be_edges(open_edges: list[int], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Convex(SQUARE, open_edges)


def test_edges_on_one_line_are_joined() -> None:
    square = Convex(SQUARE)
    assert Convex([(0, 0), (0.3, 0), (0.7, 0), (1, 0), (1, 1), (0.5, 1), (0, 1)]) == square
    # One of two pieces of a side is missing: the other one's half-plane still bounds the region.
    assert Convex([(0, 0), (0.5, 0), (1, 0), (1, 1), (0, 1)], [1]) == square
    assert Convex([(0, 0), (0.5, 0), (1, 0), (1, 1), (0, 1)], [0, 1]).is_open
    # Nearly on one line, as after rounding.
    assert len(Convex([(0, 0), (0.1, 0.3), (0.2, 0.6 + 1e-16), (0.3, 0.9), (-1, 1)]).edges) == 3


def test_equal_regions_are_equal_however_they_were_made() -> None:
    square = Convex(SQUARE)
    assert Convex(SQUARE[2:] + SQUARE[:2]) == square
    planes = [HalfPlane(n, o) for n, o in (((1, 0), 1), ((0, 1), 1), ((-1, 0), 0), ((0, -1), 0))]
    assert Convex.from_half_planes(*planes) == square
    assert Convex.from_half_planes(reversed(planes)) == square
    redundant = [HalfPlane((1, 1), 5), HalfPlane((1, 0), 2), HalfPlane((1, 0), 1)]
    assert Convex.from_half_planes(*redundant, *planes) == square
    assert Convex.from_half_planes(*planes, HalfPlane((1, 1), 2)) == square
    assert Convex.from_half_planes(*square.half_planes) == square


def test_a_missing_edge_opens_the_region() -> None:
    strip = Convex(SQUARE, [2])
    assert strip.is_open
    assert strip.vertices == ((0, 0), (1, 0))
    assert [(p.normal, p.offset) for p in strip.half_planes] == [
        ((-1, 0), 0),
        ((0, -1), 0),
        ((1, 0), 1),
    ]
    assert Convex(SQUARE, [1, 3]).vertices == ()
    assert len(Convex(SQUARE, [1, 3]).edges) == 2
    corner = Convex(SQUARE, [1, 2])
    assert corner.vertices == ((0, 0),)
    assert Convex([(0, 0), (1, 0)], [1]).edges == Convex(SQUARE, [1, 2, 3]).edges
    (shape,) = shape_table([corner])[0]
    assert shape.tolist()[4:] == (0.0, 0.0, math.inf, math.inf)


def test_neighbours_of_a_missing_edge_that_meet_further_out_make_a_corner() -> None:
    trapezoid = [(-2, 0), (2, 0), (1, 1), (-1, 1)]
    assert Convex(trapezoid, [2]) == Convex([(-2, 0), (2, 0), (0, 2)])
    # They diverge: open.
    assert Convex(trapezoid, [0]).is_open


@pytest.mark.parametrize(
    "planes",
    [
        [((1, 0), -1), ((-1, 0), -1)],
        [((1, 0), 0), ((-1, 0), 0)],
        [((1, 0), 0), ((-1, 1), 0), ((0, -1), 0)],
        [((1, 0), -1), ((-1, 1), -1), ((0, -1), -1)],
        [((1, 0), 0), ((0, 1), 0), ((-1, -1), 0)],
    ],
)
def test_an_intersection_without_inside_is_refused(planes: list[Any]) -> None:
    with pytest.raises(ValueError, match="no inside in common"):
        Convex.from_half_planes(*[HalfPlane(normal, offset) for normal, offset in planes])


def test_an_intersection_needs_half_planes() -> None:
    with pytest.raises(ValueError, match="at least one"):
        Convex.from_half_planes()
    with pytest.raises(ValueError, match="at least one"):
        Convex.from_half_planes([])
    with pytest.raises(TypeError, match="must be half-planes"):
        Convex.from_half_planes(Particle(1))  # type: ignore[arg-type]
    one = Convex.from_half_planes(AxisAlignedHalfPlane("+y", 2))
    assert one.edges == AxisAlignedHalfPlane("+y", 2).edges


def clip(corners: list[tuple[float, float]], plane: HalfPlane) -> list[tuple[float, float]]:
    """Return the part of a polygon in a half-plane (Sutherland and Hodgman 1974)."""
    (nx, ny), kept = plane.normal, []
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        a, b = nx * ax + ny * ay - plane.offset, nx * bx + ny * by - plane.offset
        if a <= 0:
            kept.append((ax, ay))
        if (a < 0 < b) or (b < 0 < a):
            kept.append((ax + (bx - ax) * a / (a - b), ay + (by - ay) * a / (a - b)))
    return kept


def area(corners: list[tuple[float, float]]) -> float:
    return float(shapely.Polygon(corners).area) if len(corners) > 2 else 0.0


LINES = st.lists(
    st.tuples(st.floats(0, 6.28), st.floats(-0.5, 2)),
    min_size=1,
    max_size=9,
)


@given(LINES)
@example([(2.5625, 0.25), (0.0, 0.0), (2.5625, 0.25), (4.0, 0.0)])
def test_the_edges_bound_the_intersection_of_the_half_planes(
    lines: list[tuple[float, float]],
) -> None:
    """Compare with a clipped large box, and point by point: the remaining edges say what is inside.

    (GEOS fails for the triangle of the example, in which one half-plane occurs twice.)
    """
    planes = [HalfPlane((math.cos(angle), math.sin(angle)), offset) for angle, offset in lines]
    clipped = [(50.0, 50.0), (-50.0, 50.0), (-50.0, -50.0), (50.0, -50.0)]
    for plane in planes:
        clipped = clip(clipped, plane)
    try:
        region = Convex.from_half_planes(*planes)
    except ValueError:
        # It is empty, unless it is as thin as rounding or beyond the clipping box.
        assert area(clipped) < 1e-9
        return
    points = np.random.default_rng(0).uniform(-5, 5, (200, 2))
    depths = [
        np.max([points @ np.array(p.normal) - p.offset for p in which], axis=0)
        for which in (planes, region.half_planes)
    ]
    clear = np.abs(depths[0]) > 1e-9
    assert ((depths[0] < 0) == (depths[1] < 0))[clear].all()
    for x, y in region.vertices:
        assert max(p.normal[0] * x + p.normal[1] * y - p.offset for p in planes) <= 1e-9 * (
            1 + math.hypot(x, y)
        )
    if not region.is_open and max(map(abs, sum(region.vertices, ()))) < 40:
        assert area(list(region.vertices)) == pytest.approx(area(clipped), abs=1e-9)


@pytest.mark.parametrize("collider", SAMPLES)
def test_bounds_enclose_the_region(collider: Collider) -> None:
    shapes, edges = shape_table([collider])
    (shape,) = shapes
    assert len(edges) >= 1
    corners = np.array(
        [(e.start_x, e.start_y) for e in collider.edges if e.has_start] or [(0.0, 0.0)]
    )
    if isinstance(collider, Particle):
        assert shape.tolist()[4:] == (-0.5, -0.5, 0.5, 0.5)
    elif not isinstance(collider, HalfPlane | AxisAlignedHalfPlane):
        low = np.array([shape.lower_x, shape.lower_y])
        high = np.array([shape.upper_x, shape.upper_y])
        assert (low <= corners).all()
        assert (corners <= high).all()
        finite = np.isfinite(low)
        np.testing.assert_array_equal(low[finite], corners.min(axis=0)[finite])


def test_bounds_of_half_planes() -> None:
    shapes, _ = shape_table((HalfPlane((1, 1)), AxisAlignedHalfPlane("-x", 2), Convex(SQUARE, [0])))
    inf = math.inf
    assert shapes[0].tolist()[4:] == (-inf, -inf, inf, inf)
    assert shapes[1].tolist()[4:] == (-2.0, -inf, inf, inf)
    assert shapes[2].tolist()[4:] == (0.0, -inf, 1.0, 1.0)


def test_a_table_holds_colliders_only() -> None:
    shapes, edges = shape_table([])
    assert (len(shapes), len(edges)) == (0, 1)
    with pytest.raises(TypeError, match="a collider is needed"):
        shape_table([(1, 2)])  # type: ignore[list-item]
