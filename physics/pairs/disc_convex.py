"""Disc against convex region, closed or open: the farthest face decides, then its corners."""

import math

from ..kernels import kernel
from ..shapes.records import EdgeRecord, Edges
from ..shapes.vectors import unit_vector
from .disc_face import sweep_disc_face
from .results import NO_CONTACT, NO_IMPACT


@kernel
def separation_from_edge(edge: EdgeRecord, dx: float, dy: float) -> float:
    """Return the signed distance of the disc's centre from an edge's line; region at (dx, dy)."""
    separation: float = -(edge.normal_x * dx + edge.normal_y * dy) - edge.offset
    return separation


@kernel
def farthest_edge(edges: Edges, first: int, count: int, dx: float, dy: float) -> tuple[int, float]:
    """Return the edge from whose line the disc's centre is farthest outward, and how far.

    If the centre is outside, the region's nearest point is on this edge: the direction to a corner
    lies between the normals of that corner's edges.
    """
    farthest = first
    separation = separation_from_edge(edges[first], dx, dy)
    for index in range(first + 1, first + count):
        candidate = separation_from_edge(edges[index], dx, dy)
        if candidate > separation:
            farthest, separation = index, candidate
    return farthest, separation


@kernel
def nearest_corner(edge: EdgeRecord, dx: float, dy: float) -> tuple[bool, float, float]:
    """Return whether the disc's centre lies beyond an end of the edge, and that end (else 0)."""
    start_x = dx + edge.start_x
    start_y = dy + edge.start_y
    if edge.has_start and edge.normal_x * start_y - edge.normal_y * start_x > 0.0:
        return True, start_x, start_y
    end_x = dx + edge.end_x
    end_y = dy + edge.end_y
    if edge.has_end and edge.normal_x * end_y - edge.normal_y * end_x < 0.0:
        return True, end_x, end_y
    return False, 0.0, 0.0


@kernel
def contact_disc_convex(
    radius: float, edges: Edges, first: int, count: int, dx: float, dy: float
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, point_x, point_y).

    The region has ``count`` edges from index ``first`` on; its body lies at (dx, dy).
    """
    index, separation = farthest_edge(edges, first, count, dx, dy)
    if separation >= radius:
        return NO_CONTACT
    edge = edges[index]
    normal_x = -edge.normal_x
    normal_y = -edge.normal_y
    if separation > 0.0:
        beyond, corner_x, corner_y = nearest_corner(edge, dx, dy)
        if beyond:
            if corner_x * corner_x + corner_y * corner_y > radius * radius:
                return NO_CONTACT
            corner_normal_x, corner_normal_y, distance = unit_vector(corner_x, corner_y)
            if distance > 0.0:
                separation = distance
                normal_x = corner_normal_x
                normal_y = corner_normal_y
    depth = radius - separation
    if depth <= 0.0:
        return NO_CONTACT
    middle = radius - 0.5 * depth
    return True, normal_x, normal_y, depth, normal_x * middle, normal_y * middle


@kernel
def _sweep_edge(
    radius: float, edge: EdgeRecord, dx: float, dy: float, vx: float, vy: float
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) for the edge that the disc meets, if any."""
    # The face's own axes: across it toward the region, and along it, to the left of that.
    across_x = -edge.normal_x
    across_y = -edge.normal_y
    along_x = -across_y
    along_y = across_x
    low = -math.inf
    high = math.inf
    if edge.has_end:
        low = along_x * (dx + edge.end_x) + along_y * (dy + edge.end_y)
    if edge.has_start:
        high = along_x * (dx + edge.start_x) + along_y * (dy + edge.start_y)
    time, across, along = sweep_disc_face(
        radius,
        separation_from_edge(edge, dx, dy),
        low,
        high,
        across_x * vx + across_y * vy,
        along_x * vx + along_y * vy,
    )
    return time, across * across_x + along * along_x, across * across_y + along * along_y


@kernel
def sweep_disc_convex(
    radius: float,
    edges: Edges,
    first: int,
    count: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); the region's body starts at (dx, dy), moves (vx, vy)."""
    enter = -1.0
    last = -1
    for index in range(first, first + count):
        edge = edges[index]
        gap = separation_from_edge(edge, dx, dy) - radius
        if gap >= 0.0:
            approach = edge.normal_x * vx + edge.normal_y * vy
            if approach <= 0.0:
                return NO_IMPACT
            time = gap / approach
            if time > enter:
                enter, last = time, index
    if enter > duration:
        return NO_IMPACT
    if last < 0:
        found, normal_x, normal_y, _, _, _ = contact_disc_convex(
            radius, edges, first, count, dx, dy
        )
        if found:
            return 0.0, normal_x, normal_y
        # The disc reaches every face's line but not the region: it is beyond a corner.
        last, _ = farthest_edge(edges, first, count, dx, dy)
    time, normal_x, normal_y = _sweep_edge(radius, edges[last], dx, dy, vx, vy)
    if time > duration:
        return NO_IMPACT
    return time, normal_x, normal_y
