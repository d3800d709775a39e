"""Disc against one face of a convex region: the flat first, then the corner beyond its end."""

import math

from .compilation import kernel
from .disc_disc import sweep_point_disc
from .vectors import cross


@kernel
def sweep_disc_face(
    radius: float, height: float, low: float, high: float, speed: float, slide: float
) -> tuple[float, float, float]:
    """Return (time, normal_across, normal_along) at which a disc about 0 meets a face, or inf.

    The face lies across the first axis at ``height >= radius``, spans ``low`` to ``high`` along
    the second one (infinite where it is open) and flies with (speed < 0, slide). It must be the
    face whose line the disc meets last: then the disc meets the flat, or a corner, or nothing.
    """
    # Where the disc meets the line, times the speed: no division, so that the decision is right
    # for flights almost along the face, and that its ends agree with the corners' own test.
    reach = radius * slide
    if low > -math.inf and cross(height, low, speed, slide) > reach:
        corner, inward = low, slide < 0.0
    elif high < math.inf and cross(height, high, speed, slide) < reach:
        corner, inward = high, slide > 0.0
    else:
        return (height - radius) / -speed, 1.0, 0.0
    time, across, along = sweep_point_disc(radius, height, corner, speed, slide)
    if inward and time == math.inf:
        # Beyond the end and flying inward the disc cannot miss: rounding did. Nearly parallel to
        # the face, it passes the corner as good as at its closest, and would sink in behind it.
        time = -(height * speed + corner * slide) / (speed * speed + slide * slide)
        return max(time, 0.0), 1.0, 0.0
    return time, across, along
