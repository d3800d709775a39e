"""Axis-aligned rectangle against another one: two intervals."""

import math

from ..kernels import kernel
from .results import NO_IMPACT, NO_OVERLAP


@kernel
def contact_box_box(
    reach_x: float, reach_y: float, dx: float, dy: float
) -> tuple[bool, float, float, float]:
    """Return (found, normal_x, normal_y, depth); reach is the sum of the half sizes."""
    depth_x = reach_x - abs(dx)
    depth_y = reach_y - abs(dy)
    if depth_x <= 0.0 or depth_y <= 0.0:
        return NO_OVERLAP
    if depth_x <= depth_y:
        return True, 1.0 if dx >= 0.0 else -1.0, 0.0, depth_x
    return True, 0.0, 1.0 if dy >= 0.0 else -1.0, depth_y


@kernel
def _passage(reach: float, distance: float, velocity: float) -> tuple[float, float]:
    """Return when, from 0 on, an interval overlaps one at ``distance >= 0`` that moves away.

    It is (first time, last time), infinite where there is no such time.
    """
    gap = distance - reach
    if gap >= 0.0:
        if velocity >= 0.0:
            return math.inf, math.inf
        return gap / -velocity, (distance + reach) / -velocity
    if velocity > 0.0:
        return -math.inf, gap / -velocity
    if velocity < 0.0:
        return -math.inf, (distance + reach) / -velocity
    return -math.inf, math.inf


@kernel
def sweep_box_box(
    reach_x: float, reach_y: float, dx: float, dy: float, vx: float, vy: float, duration: float
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); box b starts at (dx, dy) and moves with (vx, vy)."""
    found, normal_x, normal_y, _ = contact_box_box(reach_x, reach_y, dx, dy)
    if found:
        return 0.0, normal_x, normal_y
    sign_x = 1.0 if dx >= 0.0 else -1.0
    sign_y = 1.0 if dy >= 0.0 else -1.0
    enter_x, leave_x = _passage(reach_x, abs(dx), sign_x * vx)
    enter_y, leave_y = _passage(reach_y, abs(dy), sign_y * vy)
    time = max(enter_x, enter_y)
    if time >= min(leave_x, leave_y) or time > duration:
        return NO_IMPACT
    if enter_x >= enter_y:
        return time, sign_x, 0.0
    return time, 0.0, sign_y
