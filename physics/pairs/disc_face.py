"""Disc against one face of a convex region: the flat first, then the corner beyond its end."""

import math

from ..kernels import kernel
from ..shapes.vectors import accurate_cross
from .disc_disc import sweep_point_disc


@kernel
def sweep_disc_face(
    radius: float,
    height: float,
    low: float,
    high: float,
    speed: float,
    slide: float,
    margin: float,
) -> tuple[float, float, float]:
    """Return (time, normal_across, normal_along) when a disc about the origin meets a face.

    The face lies across the first axis at ``height``, spans ``low`` to ``high`` along the second
    one (infinite where it is open) and moves with (speed, slide). It must be the face whose line
    the disc meets last (speed < 0): then the disc meets the face itself, one of its corners, or
    nothing (time inf). If height < radius, the disc touches the line or has passed all lines, and
    is beside the face or beyond a corner of it.
    """
    # How far beyond the ends the disc meets the line, times the speed. There is no division: so
    # this is right for motions almost along the face, too, and agrees with the corners' own test.
    reach = radius * slide
    is_near = height < radius
    corner = low
    is_flat = True
    passing = 0.0
    if low > -math.inf:
        passing = accurate_cross(height, low, speed, slide)
        is_flat = low <= 0.0 if is_near else passing <= reach
    if is_flat and high < math.inf:
        corner = high
        passing = accurate_cross(height, high, speed, slide)
        is_flat = high >= 0.0 if is_near else passing >= reach
    if is_flat:
        return max(height - radius, 0.0) / -speed, 1.0, 0.0
    time, across, along = sweep_point_disc(radius, height, corner, speed, slide, margin)
    closing = -(height * speed + corner * slide)
    if time == math.inf and closing > 0.0 and speed < 0.0 and abs(passing) < abs(reach):
        # The disc passes the corner at less than its radius, so it cannot miss; rounding said so,
        # in a motion nearly parallel to the face, and the disc would sink in behind the corner.
        # It meets the corner practically where it is closest, and there the normal is the face's.
        return closing / (speed * speed + slide * slide), 1.0, 0.0
    return time, across, along
