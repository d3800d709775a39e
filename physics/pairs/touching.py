"""What touching is: decided here once, for contacts, impacts, relaxation and queries.

Along an axis from a to b there is a gap between the two, negative if they overlap. Rounding hides
whether a gap of a few of the last digits is one, so two bodies *touch* along an axis if the gap is
at most a margin, on either side of 0. They *overlap* if they do so by more than the margin along
every axis, and an impact is the touch after which they will. A box that slides along a row of boxes
therefore meets none of them: along the vertical axis it touches each, and no more.

Margins are two lengths, along x and along y. With margins of 0, numbers are compared as they are.
"""

import math

from ..kernels import kernel
from ..shapes.records import Edges, ShapeRecord, Shapes
from ..tolerances import NO_APPROACH, TOUCH


@kernel
def _extents(shape: ShapeRecord, edges: Edges) -> tuple[float, float]:
    """Return the largest coordinates, along x and y, from which a shape is made."""
    x: float = max(-shape.lower_x, shape.upper_x)
    y: float = max(-shape.lower_y, shape.upper_y)
    if x == math.inf or y == math.inf:
        x = y = 0.0
        for index in range(shape.first, shape.first + shape.count):
            edge = edges[index]
            x = max(x, max(abs(edge.start_x), abs(edge.end_x)))
            y = max(y, max(abs(edge.start_y), abs(edge.end_y)))
    return x, y


@kernel
def touch_margins(
    shapes: Shapes, edges: Edges, a: int, b: int, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float]:
    """Return the margins (along x, along y) of shape a at (ax, ay) and shape b at (bx, by)."""
    a_x, a_y = _extents(shapes[a], edges)
    b_x, b_y = _extents(shapes[b], edges)
    return (
        TOUCH * (abs(ax) + abs(bx) + (a_x + b_x)),
        TOUCH * (abs(ay) + abs(by) + (a_y + b_y)),
    )


@kernel
def margin_along(x: float, y: float, margin_x: float, margin_y: float) -> float:
    """Return the margin along the unit vector (x, y)."""
    return abs(x) * margin_x + abs(y) * margin_y


@kernel
def closing_speed(x: float, y: float, vx: float, vy: float, margin: float) -> float:
    """Return how fast b, with velocity (vx, vy) relative to a, comes closer along an axis (x, y).

    It is 0 if rounding alone may make the two approach, and negative if they recede.
    """
    closing = -(x * vx + y * vy)
    if 0.0 < closing <= NO_APPROACH * (abs(x * vx) + abs(y * vy)) and margin > 0.0:
        return 0.0
    return closing


@kernel
def axis_times(gap: float, closing: float, margin: float) -> tuple[float, float, float]:
    """Return (touches, sinks, parts): when two bodies, as far as an axis tells, begin and end.

    The gap is closed at ``touches`` and deeper than the margin from ``sinks`` to ``parts``. The
    first two are inf if that never happens, and -1 if they overlap already.
    """
    if gap >= -margin:
        if closing <= 0.0:
            return math.inf, math.inf, -math.inf
        return max(gap, 0.0) / closing, (gap + margin) / closing, math.inf
    if closing < 0.0:
        return -1.0, -1.0, (gap + margin) / closing
    return -1.0, -1.0, math.inf


@kernel
def interval_times(
    distance: float, reach: float, velocity: float, margin: float
) -> tuple[float, float, float]:
    """Return (touches, sinks, parts) of intervals ``distance >= 0`` apart, which touch at reach.

    The second one moves away with the velocity. These are the axes to both of its sides.
    """
    touches, sinks, parts = axis_times(distance - reach, -velocity, margin)
    parts = min(parts, axis_times(-(distance + reach), velocity, margin)[2])
    return touches, sinks, parts
