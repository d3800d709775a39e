"""A pattern as it lies in a scene: turned, enlarged, with its bounds and its outline."""

from typing import Any

from ..kernels import inlined, kernel
from ..shapes.bounds import bounds_of
from ..shapes.records import (
    AXIS_ALIGNED_HALF_PLANE,
    AXIS_ALIGNED_RECTANGLE,
    CONVEX,
    PARTICLE,
    RECTANGLE,
    EdgeRecord,
    Edges,
    ShapeRecord,
)

_QUARTER = 90
_FULL = 360
# What is open is shown up to this distance from the body.
_FAR = 1024.0


@kernel
def place_figure(
    figure: Any, pattern: ShapeRecord, pattern_edges: Edges, turns: Any, shape: Any, edges: Edges
) -> None:
    """Write a body's shape and its edges; ``shape.first`` says where they begin."""
    kind = pattern.kind
    turn = figure.turn % _FULL
    if kind in (PARTICLE, AXIS_ALIGNED_RECTANGLE):
        turn = 0
    elif kind == AXIS_ALIGNED_HALF_PLANE:
        turn -= turn % _QUARTER
    height = figure.width if kind == CONVEX else figure.height
    shape.kind = kind
    shape.count = pattern.count
    shape.radius = pattern.radius * figure.width
    figure.radius = shape.radius
    for number in range(pattern.count):
        _turn_edge(
            pattern_edges[pattern.first + number],
            figure.width,
            height,
            turns[turn, 0],
            turns[turn, 1],
            edges[shape.first + number],
        )
        if kind in (AXIS_ALIGNED_RECTANGLE, RECTANGLE):
            # Half of a measure, as rectangles have it.
            extent = figure.width if number % 2 == 0 else height
            edges[shape.first + number].offset = (
                extent * pattern_edges[pattern.first + number].offset
            )
    shape.lower_x, shape.lower_y, shape.upper_x, shape.upper_y = bounds_of(
        edges, shape.first, shape.count, shape.radius
    )


@kernel
def _turn_edge(
    pattern: EdgeRecord, width: float, height: float, cos: float, sin: float, edge: Any
) -> None:
    """Write a pattern's edge, enlarged and turned.

    Widths and heights differ only where all normals are along the pattern's axes.
    """
    normal_x, normal_y = _turned(pattern.normal_x, pattern.normal_y, cos, sin)
    start_x, start_y = _turned(width * pattern.start_x, height * pattern.start_y, cos, sin)
    end_x, end_y = _turned(width * pattern.end_x, height * pattern.end_y, cos, sin)
    edge.normal_x = normal_x
    edge.normal_y = normal_y
    edge.start_x = start_x
    edge.start_y = start_y
    edge.end_x = end_x
    edge.end_y = end_y
    # By rounding the ends differ a little in their distance: take the middle.
    first = normal_x * start_x + normal_y * start_y
    edge.offset = 0.5 * (first + (normal_x * end_x + normal_y * end_y)) + 0.0
    edge.has_start = pattern.has_start
    edge.has_end = pattern.has_end


@inlined
def _turned(x: float, y: float, cos: float, sin: float) -> tuple[float, float]:
    # Adding 0 turns -0 into 0, as for other edges.
    return cos * x - sin * y + 0.0, sin * x + cos * y + 0.0


@kernel
def outline_figure(figure: Any, shape: ShapeRecord, edges: Edges, scratch: Any) -> None:
    """Write the corners of a body's core, counterclockwise; what is open ends far outside."""
    outline = figure.outline
    figure.corners = 0
    if shape.count == 0:
        return
    count = 4
    for corner in range(4):
        outline[2 * corner] = _FAR if corner in (1, 2) else -_FAR
        outline[2 * corner + 1] = _FAR if corner >= 2 else -_FAR
    for number in range(shape.first, shape.first + shape.count):
        for index in range(2 * count):
            scratch[index] = outline[index]
        count = _cut(scratch, count, edges[number], outline)
    figure.corners = count


@kernel
def _cut(given: Any, count: int, edge: EdgeRecord, left: Any) -> int:
    """Write the part of a convex polygon inside an edge's line; return its number of corners."""
    kept = 0
    last = count - 1
    last_gap = _gap(edge, given[2 * last], given[2 * last + 1])
    for index in range(count):
        x, y = given[2 * index], given[2 * index + 1]
        gap = _gap(edge, x, y)
        if (gap > 0.0) != (last_gap > 0.0):
            part = last_gap / (last_gap - gap)
            left[2 * kept] = given[2 * last] + part * (x - given[2 * last])
            left[2 * kept + 1] = given[2 * last + 1] + part * (y - given[2 * last + 1])
            kept += 1
        if gap <= 0.0:
            left[2 * kept] = x
            left[2 * kept + 1] = y
            kept += 1
        last = index
        last_gap = gap
    return kept


@inlined
def _gap(edge: EdgeRecord, x: float, y: float) -> float:
    gap: float = edge.normal_x * x + edge.normal_y * y - edge.offset
    return gap
