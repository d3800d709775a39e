"""Two bodies that meet: their restitution, and the momentum that they exchange."""

import math

from ...kernels import kernel
from ...pairs.response import bounce_velocities
from ...tolerances import LONGEST_SERIES, NO_TURN
from ..lookup.overrides import find_override
from ..state.courses import velocity_of
from ..state.records import INERT
from ..state.view import (
    WorldView,
    entries_of,
    header_of,
    motions_of,
    overrides_of,
    plans_of,
    progress_of,
    traits_of,
)
from .stages import has_reached, inverse_mass_of


@kernel
def turn_velocity(
    world: WorldView, slot: int, vx: float, vy: float, rest_x: float, rest_y: float
) -> None:
    """Give a moving body another velocity, or 0 for what is only the rounding of the change.

    Args:
        world, slot: the body.
        vx, vy: the velocity.
        rest_x, rest_y: what rounding may have left of each.
    """
    motion = motions_of(world)[slot]
    # What is too large for a number stays so, and is noticed as the step ends.
    motion.vx = 0.0 if abs(vx) <= rest_x < math.inf else vx
    motion.vy = 0.0 if abs(vy) <= rest_y < math.inf else vy
    motion.speed = max(motion.speed, abs(vx) + abs(vy))


@kernel
def restitution_of(world: WorldView, a: int, b: int, closing: float) -> float:
    """Return the restitution of a pair: its own, or the product of the bodies' values.

    It is 0 if none of the two may bounce any more in this step. What loses speed by its hits also
    rests if it is slow, or at the end of a series of hits that go nowhere.

    Args:
        world, a, b: the bodies.
        closing: the speed at which they approach, along the normal.
    """
    overrides, restitution = overrides_of(world), math.nan
    if overrides.shape[0] > 0:
        one, other = entries_of(world)[a].handle, entries_of(world)[b].handle
        restitution = find_override(overrides, min(one, other), max(one, other))
    if math.isnan(restitution):
        restitution = float(traits_of(world)[a].restitution * traits_of(world)[b].restitution)
    if restitution < 1.0 and closing <= header_of(world).rest_speed:
        return 0.0
    if progress_of(world).inert:
        is_lost = restitution < 1.0 and _end_series(world, a, b)
        if is_lost or has_reached(world, a, b, INERT):
            return 0.0
    return restitution


@kernel
def _end_series(world: WorldView, a: int, b: int) -> bool:
    """Return whether those of two bodies that have a mass have had many hits that go nowhere."""
    traits = traits_of(world)
    for body in (a, b):
        slot = traits[body].slot
        if traits[body].inverse_mass > 0.0 and plans_of(world)[slot].series < LONGEST_SERIES:
            return False
    return True


@kernel
def bounce_pair(world: WorldView, a: int, b: int, normal_x: float, normal_y: float) -> float:
    """Exchange the momentum of two bodies along the normal from a to b; return the impulse."""
    one, other = traits_of(world)[a].slot, traits_of(world)[b].slot
    inverse_mass_a, inverse_mass_b = inverse_mass_of(world, a), inverse_mass_of(world, b)
    vx_a, vy_a = velocity_of(world, one)
    vx_b, vy_b = velocity_of(world, other)
    closing = (vx_a - vx_b) * normal_x + (vy_a - vy_b) * normal_y
    vx_a, vy_a, vx_b, vy_b, impulse = bounce_velocities(
        vx_a,
        vy_a,
        vx_b,
        vy_b,
        inverse_mass_a,
        inverse_mass_b,
        normal_x,
        normal_y,
        restitution_of(world, a, b, closing),
    )
    rest_x, rest_y = NO_TURN * abs(impulse * normal_x), NO_TURN * abs(impulse * normal_y)
    if inverse_mass_a > 0.0:
        turn_velocity(world, one, vx_a, vy_a, rest_x * inverse_mass_a, rest_y * inverse_mass_a)
    if inverse_mass_b > 0.0:
        turn_velocity(world, other, vx_b, vy_b, rest_x * inverse_mass_b, rest_y * inverse_mass_b)
    return impulse
