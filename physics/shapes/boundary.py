"""From half-planes and polygons to the edges of the region that they bound.

This runs when shapes are built, in Python floats. It may use what stepping may not, angles for
instance.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..arguments import Vector
from ..tolerances import NO_LENGTH, PARALLEL


class BoundaryEdge(NamedTuple):
    """One edge, field by field as in the records' ``Edge``."""

    normal_x: float
    normal_y: float
    offset: float
    start_x: float
    start_y: float
    end_x: float
    end_y: float
    has_start: bool
    has_end: bool


class Line(NamedTuple):
    """The half-plane ``normal . p <= offset``, and the ends of its edge as far as they are known.

    An end that both neighbours know is kept to the bit; others are computed.
    """

    normal: Vector
    offset: float
    start: Vector | None = None
    end: Vector | None = None


def line_through(start: Vector, end: Vector) -> Line:
    """Return the half-plane to the left of the line from one point to another."""
    x = end[0] - start[0]
    y = end[1] - start[1]
    length = math.hypot(x, y)
    normal = (y / length, -x / length)
    # By rounding the ends differ a little in their distance: take the middle.
    return Line(normal, 0.5 * (dot(normal, start) + dot(normal, end)), start, end)


def dot(a: Vector, b: Vector) -> float:
    """Return a . b."""
    return a[0] * b[0] + a[1] * b[1]


def cross(a: Vector, b: Vector) -> float:
    """Return a x b: positive if b is to the left of a."""
    return a[0] * b[1] - a[1] * b[0]


def boundary(lines: Sequence[Line]) -> tuple[BoundaryEdge, ...]:
    """Return the edges of the intersection of half-planes, counterclockwise, none redundant.

    Raises:
        ValueError: if the intersection is empty, or has no inside.
    """
    scale = max(abs(line.offset) for line in lines)
    kept = [line for index, line in enumerate(lines) if _is_on_boundary(index, lines, scale)]
    if not kept:
        raise ValueError(
            "the half-planes have no inside in common: their intersection is empty, a point or a "
            "line. A region needs half-planes that overlap"
        )
    kept.sort(key=lambda line: math.atan2(line.normal[1], line.normal[0]))
    corners = [_corner(line, kept[(index + 1) % len(kept)]) for index, line in enumerate(kept)]
    # An open chain begins with the edge that comes from infinity.
    first = next((i for i in range(len(kept)) if corners[i - 1] is None), 0)
    order = [(first + i) % len(kept) for i in range(len(kept))]
    return tuple(boundary_edge(kept[i], corners[i - 1], corners[i]) for i in order)


def _is_on_boundary(index: int, lines: Sequence[Line], scale: float) -> bool:
    """Return whether a part of this line is on the boundary of the intersection."""
    line = lines[index]
    along = (-line.normal[1], line.normal[0])
    foot = (line.offset * line.normal[0], line.offset * line.normal[1])
    low = -math.inf
    high = math.inf
    for other_index, other in enumerate(lines):
        if other_index == index:
            continue
        rise = dot(other.normal, along)
        if abs(rise) > PARALLEL:
            cut = (other.offset - dot(other.normal, foot)) / rise
            if rise > 0.0:
                high = min(high, cut)
            else:
                low = max(low, cut)
        elif dot(line.normal, other.normal) < 0.0:
            if line.offset + other.offset <= NO_LENGTH * scale:
                return False
        elif (other.offset, other_index) < (line.offset, index):
            return False
    return high - low > NO_LENGTH * scale


def _corner(line: Line, following: Line) -> Vector | None:
    """Return where an edge meets the next one counterclockwise, None if both run to infinity."""
    turn = cross(line.normal, following.normal)
    if turn <= PARALLEL:
        return None
    if line.end is not None and line.end == following.start:
        return line.end
    return (
        (line.offset * following.normal[1] - following.offset * line.normal[1]) / turn,
        (following.offset * line.normal[0] - line.offset * following.normal[0]) / turn,
    )


def boundary_edge(line: Line, start: Vector | None, end: Vector | None) -> BoundaryEdge:
    """Return a line's edge between two corners; a missing one (None) is at infinity."""
    foot = (line.offset * line.normal[0], line.offset * line.normal[1])
    first = start or end or foot
    last = end or start or foot
    # Adding 0 turns -0 into 0, which reads better and hashes the same.
    x, y, offset, *ends = (value + 0.0 for value in (*line.normal, line.offset, *first, *last))
    return BoundaryEdge(
        x, y, offset, ends[0], ends[1], ends[2], ends[3], start is not None, end is not None
    )


def polygon_lines(vertices: Sequence[Vector], open_edges: frozenset[int]) -> list[Line]:
    """Return the lines of a counterclockwise convex polygon's edges, except for missing ones.

    Edges on one line are joined.

    Raises:
        ValueError: if the polygon is degenerate, clockwise or not convex.
    """
    count = len(vertices)
    if len(open_edges) == count:
        raise ValueError("open_edges names every edge: a region needs at least one that is there")
    for index, vertex in enumerate(vertices):
        if vertex == vertices[(index + 1) % count]:
            raise ValueError(
                f"vertices {index} and {(index + 1) % count} are the same point {vertex}: leave "
                "one out"
            )
    if count == 2:
        return [line_through(vertices[i], vertices[1 - i]) for i in (0, 1) if i not in open_edges]
    corners = _turning_corners(vertices)
    lines = []
    for position, corner in enumerate(corners):
        following = corners[(position + 1) % len(corners)]
        pieces = range(corner, following + (count if following <= corner else 0))
        # If any piece of a divided edge is there, its whole line bounds the region.
        present = [piece for piece in pieces if piece % count not in open_edges]
        if present:
            line = line_through(vertices[corner], vertices[following])
            lines.append(line)
    return lines


def _turning_corners(vertices: Sequence[Vector]) -> list[int]:
    """Check that a polygon is convex, and return the indices of the vertices at which it turns."""
    count = len(vertices)
    area = 0.5 * sum(
        cross(_between(vertices[0], vertices[i]), _between(vertices[0], vertices[i + 1]))
        for i in range(1, count - 1)
    )
    perimeter = sum(math.dist(vertices[i - 1], vertices[i]) for i in range(count))
    if area <= -NO_LENGTH * perimeter**2:
        raise ValueError(
            f"the vertices {tuple(vertices)} run clockwise (area {area:g}): reverse their order"
        )
    corners = []
    turned = 0.0
    for index in range(count):
        incoming = _between(vertices[index - 1], vertices[index])
        outgoing = _between(vertices[index], vertices[(index + 1) % count])
        turn = math.atan2(cross(incoming, outgoing), dot(incoming, outgoing))
        if abs(turn) >= math.pi - PARALLEL or area <= NO_LENGTH * perimeter**2:
            raise ValueError(
                f"the polygon {tuple(vertices)} is degenerate (area {area:g}, it doubles back at "
                f"vertex {index}): it needs an inside"
            )
        if turn < -PARALLEL:
            raise ValueError(
                f"the polygon is not convex: it turns to the right at vertex {index}, "
                f"{vertices[index]}. Split it into convex pieces"
            )
        turned += turn
        if turn > PARALLEL:
            corners.append(index)
    if turned > 3.0 * math.pi:
        raise ValueError(
            f"the polygon {tuple(vertices)} is not convex: it winds more than once about its "
            "inside. Split it into convex pieces"
        )
    return corners


def _between(a: Vector, b: Vector) -> Vector:
    """Return the vector from a to b."""
    return (b[0] - a[0], b[1] - a[1])
