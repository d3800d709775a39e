"""Disc against disc: two centres closer than the radii's sum."""

import math

from ..kernels import kernel
from ..shapes.vectors import cross, direction, squared_excess
from ..tolerances import REST


@kernel
def contact_disc_disc(
    radius_a: float, radius_b: float, dx: float, dy: float
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, point_x, point_y); b's centre is at (dx, dy)."""
    reach = radius_a + radius_b
    if dx * dx + dy * dy > reach * reach:
        return False, 0.0, 0.0, 0.0, 0.0, 0.0
    # Coincident centres: any direction is as good, and this one is fixed.
    normal_x, normal_y, distance = direction(dx, dy)
    depth = reach - distance
    if depth <= 0.0:
        return False, 0.0, 0.0, 0.0, 0.0, 0.0
    middle = radius_a - 0.5 * depth
    return True, normal_x, normal_y, depth, normal_x * middle, normal_y * middle


@kernel
def sweep_point_disc(
    radius: float, x: float, y: float, vx: float, vy: float
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) at which a point outside enters the disc about 0, or inf.

    Distances along and across the line of flight, not the quadratic's coefficients: the larger
    root's sum never cancels, and normal and miss are right however far away the point starts.
    """
    along = x * vx + y * vy
    squared_speed = vx * vx + vy * vy
    if along >= 0.0 or squared_speed < REST:
        return math.inf, 0.0, 0.0
    speed = math.sqrt(squared_speed)
    offset = cross(x, y, vx, vy) / speed
    if not abs(offset) < radius:
        return math.inf, 0.0, 0.0
    half_chord = math.sqrt((radius - abs(offset)) * (radius + abs(offset)))
    excess = max(squared_excess(x, y, radius), 0.0)
    time = excess / ((half_chord - along / speed) * speed)
    scale = radius * speed
    normal_x = (offset * vy - half_chord * vx) / scale
    normal_y = -(offset * vx + half_chord * vy) / scale
    return time, normal_x, normal_y


@kernel
def sweep_disc_disc(
    radius_a: float,
    radius_b: float,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); disc b starts at (dx, dy), flies with (vx, vy)."""
    reach = radius_a + radius_b
    # The squares decide the rule; only discs as good as touching need the careful answer.
    if dx * dx + dy * dy <= reach * reach:
        found, normal_x, normal_y, _, _, _ = contact_disc_disc(radius_a, radius_b, dx, dy)
        if found:
            return 0.0, normal_x, normal_y
    time, normal_x, normal_y = sweep_point_disc(reach, dx, dy, vx, vy)
    if time > duration:
        return math.inf, 0.0, 0.0
    return time, normal_x, normal_y
