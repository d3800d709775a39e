"""Disc against half-plane: one signed distance."""

from ..kernels import kernel
from .results import NO_CONTACT, NO_IMPACT
from .touching import closing_speed, margin_along


@kernel
def contact_disc_half_plane(
    radius: float,
    normal_x: float,
    normal_y: float,
    offset: float,
    dx: float,
    dy: float,
    margin_x: float,
    margin_y: float,
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, point_x, point_y).

    The half-plane is normal . p <= offset about its body, which is at (dx, dy) from the disc.
    """
    depth = radius + (offset + (normal_x * dx + normal_y * dy))
    if depth <= margin_along(normal_x, normal_y, margin_x, margin_y):
        return NO_CONTACT
    middle = radius - 0.5 * depth
    return True, -normal_x, -normal_y, depth, -normal_x * middle, -normal_y * middle


@kernel
def sweep_disc_half_plane(
    radius: float,
    normal_x: float,
    normal_y: float,
    offset: float,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
    margin_x: float = 0.0,
    margin_y: float = 0.0,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); the half-plane's body moves with (vx, vy)."""
    depth = radius + (offset + (normal_x * dx + normal_y * dy))
    margin = margin_along(normal_x, normal_y, margin_x, margin_y)
    if depth > margin:
        return 0.0, -normal_x, -normal_y
    closing = closing_speed(-normal_x, -normal_y, vx, vy, margin)
    if closing <= 0.0:
        return NO_IMPACT
    time = max(0.0 - depth, 0.0) / closing
    if time > duration:
        return NO_IMPACT
    return time, -normal_x, -normal_y
