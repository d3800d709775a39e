"""Disc against axis-aligned rectangle: after mirroring, only two faces and a corner count."""

from ..kernels import kernel
from ..shapes.vectors import unit_vector
from .disc_face import sweep_disc_face
from .results import NO_CONTACT, NO_IMPACT
from .touching import interval_times, margin_along


@kernel
def contact_disc_box(
    radius: float,
    half_width: float,
    half_height: float,
    dx: float,
    dy: float,
    margin_x: float,
    margin_y: float,
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, point_x, point_y); the box lies at (dx, dy)."""
    gap_x = abs(dx) - half_width
    gap_y = abs(dy) - half_height
    if gap_x >= radius or gap_y >= radius:
        return NO_CONTACT
    if gap_x > 0.0 and gap_y > 0.0:
        normal_x, normal_y, gap = unit_vector(gap_x, gap_y)
    elif gap_x >= gap_y:
        normal_x, normal_y, gap = 1.0, 0.0, gap_x
    else:
        normal_x, normal_y, gap = 0.0, 1.0, gap_y
    depth = radius - gap
    if depth <= margin_along(normal_x, normal_y, margin_x, margin_y):
        return NO_CONTACT
    if dx < 0.0:
        normal_x = -normal_x
    if dy < 0.0:
        normal_y = -normal_y
    middle = radius - 0.5 * depth
    return True, normal_x, normal_y, depth, normal_x * middle, normal_y * middle


@kernel
def sweep_disc_box(
    radius: float,
    half_width: float,
    half_height: float,
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y); the box starts at (dx, dy) and moves with (vx, vy)."""
    # Mirrored so that the box lies up and to the right: only its left and lower face can be hit.
    sign_x = 1.0
    sign_y = 1.0
    if dx < 0.0:
        sign_x = -1.0
    if dy < 0.0:
        sign_y = -1.0
    vx *= sign_x
    vy *= sign_y
    gap_x = (abs(dx) - half_width) - radius
    gap_y = (abs(dy) - half_height) - radius
    if (gap_x >= -margin_x and vx >= 0.0) or (gap_y >= -margin_y and vy >= 0.0):
        return NO_IMPACT
    if abs(gap_x) < margin_x or abs(gap_y) < margin_y:
        # It touches a face: perhaps it has passed the box before it overlaps it.
        _, sinks_x, parts_x = interval_times(abs(dx), half_width + radius, vx, margin_x)
        _, sinks_y, parts_y = interval_times(abs(dy), half_height + radius, vy, margin_y)
        if max(sinks_x, sinks_y) >= min(parts_x, parts_y):
            return NO_IMPACT
    # The face entered last is the one that is hit (compared without a division). Within reach of
    # both, but not of the box, the disc is beyond their corner.
    is_x_last = gap_y < 0.0 or gap_x * vy <= gap_y * vx
    if gap_x < 0.0:
        is_x_last = gap_x >= gap_y
        if gap_y < 0.0:
            found, normal_x, normal_y, _, _, _ = contact_disc_box(
                radius, half_width, half_height, dx, dy, margin_x, margin_y
            )
            if found:
                return 0.0, normal_x, normal_y
    if is_x_last:
        low = abs(dy) - half_height
        high = abs(dy) + half_height
        time, normal_x, normal_y = sweep_disc_face(
            radius, abs(dx) - half_width, low, high, vx, vy, margin_x + margin_y
        )
    else:
        low = abs(dx) - half_width
        high = abs(dx) + half_width
        time, normal_y, normal_x = sweep_disc_face(
            radius, abs(dy) - half_height, low, high, vy, vx, margin_x + margin_y
        )
    if time > duration:
        return NO_IMPACT
    return time, sign_x * normal_x, sign_y * normal_y
