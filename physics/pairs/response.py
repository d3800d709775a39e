"""How a pair responds to a collision: the shares of a separation, the exchange of momentum."""

from ..kernels import kernel


@kernel
def shares(inverse_mass_a: float, inverse_mass_b: float) -> tuple[float, float]:
    """Return each body's share of a separation: reciprocal to its mass, 0 for a static body."""
    total = inverse_mass_a + inverse_mass_b
    if total == 0.0:
        return 0.0, 0.0
    return inverse_mass_a / total, inverse_mass_b / total


@kernel
def reflect(
    vx: float, vy: float, normal_x: float, normal_y: float, restitution: float
) -> tuple[float, float]:
    """Return a velocity after a bounce off something that never moves.

    The sign of the normal does not matter. The result is exact for a normal along an axis and
    restitution 1.
    """
    # Rounding leaves a normal a little longer or shorter than 1. Without the division the speed
    # would drift, the same way at every bounce.
    along = (vx * normal_x + vy * normal_y) / (normal_x * normal_x + normal_y * normal_y)
    change = (restitution + 1.0) * along
    return vx - change * normal_x, vy - change * normal_y


@kernel
def bounce_velocities(
    v1x: float,
    v1y: float,
    v2x: float,
    v2y: float,
    inverse_mass_1: float,
    inverse_mass_2: float,
    normal_x: float,
    normal_y: float,
    restitution: float,
) -> tuple[float, float, float, float, float]:
    """Return (v1x, v1y, v2x, v2y, impulse) after a bounce along the unit normal from 1 to 2.

    The impulse is J = -(e + 1) (v1 - v2) / (1/m1 + 1/m2) with speeds along the normal; body 1 gets
    J/m1, body 2 -J/m2. Nothing changes, and J is 0, unless the two approach and one has a mass.
    """
    share_1, share_2 = shares(inverse_mass_1, inverse_mass_2)
    approach = (v1x - v2x) * normal_x + (v1y - v2y) * normal_y
    if approach <= 0.0 or share_1 + share_2 == 0.0:
        return v1x, v1y, v2x, v2y, 0.0
    # The division prevents a drift, as in `reflect`.
    change = (restitution + 1.0) * (approach / (normal_x * normal_x + normal_y * normal_y))
    return (
        v1x - change * share_1 * normal_x,
        v1y - change * share_1 * normal_y,
        v2x + change * share_2 * normal_x,
        v2y + change * share_2 * normal_y,
        -change / (inverse_mass_1 + inverse_mass_2),
    )
