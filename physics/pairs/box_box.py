"""Axis-aligned rectangle against another one: two intervals."""

from ..kernels import kernel
from .results import NO_IMPACT, NO_OVERLAP
from .touching import interval_times


@kernel
def contact_box_box(
    reach_x: float, reach_y: float, dx: float, dy: float, margin_x: float, margin_y: float
) -> tuple[bool, float, float, float]:
    """Return (found, normal_x, normal_y, depth); reach is the sum of the half sizes."""
    depth_x = reach_x - abs(dx)
    depth_y = reach_y - abs(dy)
    if depth_x <= margin_x or depth_y <= margin_y:
        return NO_OVERLAP
    if depth_x <= depth_y:
        return True, 1.0 if dx >= 0.0 else -1.0, 0.0, depth_x
    return True, 0.0, 1.0 if dy >= 0.0 else -1.0, depth_y


@kernel
def sweep_box_box(
    reach_x: float,
    reach_y: float,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); box b starts at (dx, dy) and moves with (vx, vy)."""
    found, normal_x, normal_y, _ = contact_box_box(reach_x, reach_y, dx, dy, margin_x, margin_y)
    if found:
        return 0.0, normal_x, normal_y
    sign_x = 1.0 if dx >= 0.0 else -1.0
    sign_y = 1.0 if dy >= 0.0 else -1.0
    vx *= sign_x
    vy *= sign_y
    touches_x, sinks_x, parts_x = interval_times(abs(dx), reach_x, vx, margin_x)
    touches_y, sinks_y, parts_y = interval_times(abs(dy), reach_y, vy, margin_y)
    time = max(touches_x, touches_y)
    if max(sinks_x, sinks_y) >= min(parts_x, parts_y) or time > duration:
        return NO_IMPACT
    is_x = touches_x >= touches_y
    if sinks_x > time and sinks_y > time and vx != vy:
        # Corner meets corner: either side may be met, and the slower one changes less. So a box
        # that comes down almost along a floor does not meet the side of the next tile.
        is_x = vx > vy
    if is_x:
        return time, sign_x, 0.0
    return time, 0.0, sign_y
