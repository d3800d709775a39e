"""Whether a moving pair meets. Most do not: the bounding boxes are compared first."""

import math

from ..kernels import kernel
from ..shapes.records import Edges, Shapes
from .results import NO_IMPACT
from .table import impact_between, may_touch


@kernel
def approach_between(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) as `impact_between` does, but inf if the two recede.

    Two that recede although they overlap, by a rounding error or after a response, go their way.
    """
    if not may_touch(shapes, a, b, dx, dy, vx, vy, duration):
        return NO_IMPACT
    time, normal_x, normal_y = impact_between(shapes, edges, a, b, dx, dy, vx, vy, duration)
    if vx * normal_x + vy * normal_y >= 0.0:
        return NO_IMPACT
    return time, normal_x, normal_y


@kernel
def will_touch(
    shapes: Shapes,
    edges: Edges,
    a: int,
    b: int,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
) -> bool:
    """Return whether b, at (dx, dy) from a and moving with (vx, vy), meets or overlaps a."""
    if not may_touch(shapes, a, b, dx, dy, vx, vy, duration):
        return False
    return bool(impact_between(shapes, edges, a, b, dx, dy, vx, vy, duration)[0] < math.inf)
