"""Disc against convex region, closed or open: the farthest face decides, then its corners."""

import math

from ..kernels import kernel
from ..shapes.records import EdgeRecord, Edges
from ..shapes.vectors import unit_vector
from .disc_face import sweep_disc_face
from .results import NO_CONTACT, NO_IMPACT
from .touching import axis_times, closing_speed, margin_along


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
    radius: float,
    edges: Edges,
    first: int,
    count: int,
    dx: float,
    dy: float,
    margin_x: float,
    margin_y: float,
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
    if depth <= margin_along(normal_x, normal_y, margin_x, margin_y):
        return NO_CONTACT
    middle = radius - 0.5 * depth
    return True, normal_x, normal_y, depth, normal_x * middle, normal_y * middle


@kernel
def _sweep_edge(
    radius: float, edge: EdgeRecord, dx: float, dy: float, vx: float, vy: float, margin: float
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
        margin,
    )
    return time, across * across_x + along * along_x, across * across_y + along * along_y


@kernel
def _region_times(
    radius: float,
    edge: EdgeRecord,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return (touches, sinks, parts) of a disc and the line of an edge, as of `axis_times`."""
    margin = margin_along(edge.normal_x, edge.normal_y, margin_x, margin_y)
    closing = closing_speed(-edge.normal_x, -edge.normal_y, vx, vy, margin)
    return axis_times(separation_from_edge(edge, dx, dy) - radius, closing, margin)


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
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); the region's body starts at (dx, dy), moves (vx, vy)."""
    enter, sinks, parts = -1.0, -1.0, math.inf
    last = -1
    for index in range(first, first + count):
        touches, edge_sinks, edge_parts = _region_times(
            radius, edges[index], dx, dy, vx, vy, margin_x, margin_y
        )
        if touches == math.inf:
            return NO_IMPACT
        if touches > enter:
            enter, last = touches, index
        sinks = max(sinks, edge_sinks)
        parts = min(parts, edge_parts)
    if enter > duration:
        return NO_IMPACT
    if last < 0:
        found, normal_x, normal_y, _, _, _ = contact_disc_convex(
            radius, edges, first, count, dx, dy, margin_x, margin_y
        )
        if found:
            return 0.0, normal_x, normal_y
        # The disc reaches every face's line but not the region: it is beyond a corner.
        last, _ = farthest_edge(edges, first, count, dx, dy)
    elif sinks >= parts and sinks > enter:
        # It has passed before it overlaps the region by more than the margin.
        return NO_IMPACT
    time, normal_x, normal_y = _sweep_edge(radius, edges[last], dx, dy, vx, vy, margin_x + margin_y)
    if time > duration:
        return NO_IMPACT
    return time, normal_x, normal_y


@kernel
def _corner_normal(
    edges: Edges,
    first: int,
    count: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    margin_x: float,
    margin_y: float,
    time: float,
) -> tuple[float, float]:
    """Return the outward normal at which a point meets a region at a time.

    Of a face it is the face's. Of a corner it is what a small disc meets that flies at the corner:
    against its motion, but no further turned than the normals of the corner's edges.
    """
    x, y, _ = unit_vector(vx, vy)
    has_right, has_left = False, False
    right_x, right_y, left_x, left_y = x, y, x, y
    for index in range(first, first + count):
        edge = edges[index]
        _, sinks, _ = _region_times(0.0, edge, dx, dy, vx, vy, margin_x, margin_y)
        if sinks < time:
            continue
        # All of these are within a right angle of (x, y). On either side, the nearest counts.
        turn = x * edge.normal_y - y * edge.normal_x
        if turn == 0.0:
            return edge.normal_x, edge.normal_y
        if turn < 0.0 and (
            not has_right or right_x * edge.normal_y - right_y * edge.normal_x > 0.0
        ):
            right_x, right_y, has_right = edge.normal_x, edge.normal_y, True
        if turn > 0.0 and (not has_left or left_x * edge.normal_y - left_y * edge.normal_x < 0.0):
            left_x, left_y, has_left = edge.normal_x, edge.normal_y, True
    if has_right and has_left:
        return x, y
    if has_left:
        return left_x, left_y
    return right_x, right_y


@kernel
def sweep_point_convex(
    edges: Edges,
    first: int,
    count: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return what `sweep_disc_convex` returns, for a disc of radius 0.

    It enters through a corner, too, and one that only grazes a corner misses: so the time in the
    region decides, not where it meets the boundary.
    """
    time, sinks, parts = -1.0, -1.0, math.inf
    for index in range(first, first + count):
        edge_touches, edge_sinks, edge_parts = _region_times(
            0.0, edges[index], dx, dy, vx, vy, margin_x, margin_y
        )
        time = max(time, edge_touches)
        sinks = max(sinks, edge_sinks)
        parts = min(parts, edge_parts)
    if time < 0.0:
        _, normal_x, normal_y, _, _, _ = contact_disc_convex(
            0.0, edges, first, count, dx, dy, margin_x, margin_y
        )
        return 0.0, normal_x, normal_y
    if sinks >= parts or time > duration:
        return NO_IMPACT
    normal_x, normal_y = _corner_normal(
        edges, first, count, dx, dy, vx, vy, margin_x, margin_y, time
    )
    return time, -normal_x, -normal_y
