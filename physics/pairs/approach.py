"""What pairs are asked while they move: do they meet? Most do not: bounding boxes first."""

import math
from typing import Any

from ..kernels import kernel
from .table import impact_between, may_touch


@kernel
def approach_between(
    shapes: Any,
    edges: Any,
    a: int,
    b: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) as `impact_between` does, but inf if the two recede.

    That is for what a rounding error or a response left overlapping: it goes its way.
    """
    if not may_touch(shapes, a, b, dx, dy, vx, vy, duration):
        return math.inf, 0.0, 0.0
    time, normal_x, normal_y = impact_between(shapes, edges, a, b, dx, dy, vx, vy, duration)
    if vx * normal_x + vy * normal_y >= 0.0:
        return math.inf, 0.0, 0.0
    return time, normal_x, normal_y


@kernel
def will_touch(
    shapes: Any,
    edges: Any,
    a: int,
    b: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
) -> bool:
    """Return whether b, at (dx, dy) from a, flying with (vx, vy) past it, meets or overlaps it."""
    if not may_touch(shapes, a, b, dx, dy, vx, vy, duration):
        return False
    return bool(impact_between(shapes, edges, a, b, dx, dy, vx, vy, duration)[0] < math.inf)
