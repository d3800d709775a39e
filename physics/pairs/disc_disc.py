"""Disc against disc: two centres closer than the radii's sum."""

import math

from ..kernels import kernel
from ..shapes.vectors import accurate_cross, squared_excess, unit_vector
from ..tolerances import NO_SPEED_SQUARED
from .results import NO_CONTACT, NO_IMPACT
from .touching import margin_along


@kernel
def contact_disc_disc(
    radius_a: float, radius_b: float, dx: float, dy: float, margin_x: float, margin_y: float
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, point_x, point_y); b's centre is at (dx, dy)."""
    reach = radius_a + radius_b
    if dx * dx + dy * dy > reach * reach:
        return NO_CONTACT
    # Coincident centres: any direction is as good, and this one is fixed.
    normal_x, normal_y, distance = unit_vector(dx, dy)
    depth = reach - distance
    if depth <= margin_along(normal_x, normal_y, margin_x, margin_y):
        return NO_CONTACT
    middle = radius_a - 0.5 * depth
    return True, normal_x, normal_y, depth, normal_x * middle, normal_y * middle


@kernel
def sweep_point_disc(
    radius: float, x: float, y: float, vx: float, vy: float, margin: float = 0.0
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) when a point outside enters the disc about the origin.

    The time is inf if it does not, or if it touches the disc, within the margin, and gets no deeper
    than that: after a bounce without restitution, a disc rolls over a corner. This computes with
    distances along and across the point's path, not with the coefficients of a quadratic: the sum
    in the larger root never cancels, and normal and miss are right however far away the point
    starts.
    """
    along = x * vx + y * vy
    squared_speed = vx * vx + vy * vy
    if along >= 0.0 or squared_speed < NO_SPEED_SQUARED:
        return NO_IMPACT
    speed = math.sqrt(squared_speed)
    offset = accurate_cross(x, y, vx, vy) / speed
    if not abs(offset) < radius:
        return NO_IMPACT
    half_chord = math.sqrt((radius - abs(offset)) * (radius + abs(offset)))
    excess = max(squared_excess(x, y, radius), 0.0)
    if excess <= 2.0 * radius * margin and radius - abs(offset) <= margin:
        return NO_IMPACT
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
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); disc b starts at (dx, dy), moves with (vx, vy)."""
    reach = radius_a + radius_b
    # Squares decide nearly always; only discs that almost touch need the careful answer.
    if dx * dx + dy * dy <= reach * reach:
        found, normal_x, normal_y, _, _, _ = contact_disc_disc(
            radius_a, radius_b, dx, dy, margin_x, margin_y
        )
        if found:
            return 0.0, normal_x, normal_y
    time, normal_x, normal_y = sweep_point_disc(reach, dx, dy, vx, vy, margin_x + margin_y)
    if time > duration:
        return NO_IMPACT
    return time, normal_x, normal_y
