"""Where two bodies of a world touch or overlap at a time."""

from ...kernels import kernel
from ...pairs.results import NO_CONTACT
from ...pairs.table import contact_between
from ..state.courses import margins_of, motion_at
from ..state.view import WorldView, edges_of, shapes_of, traits_of


@kernel
def solid_contact(
    world: WorldView, a: int, b: int, now: float, now_low: float
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, x, y) of two bodies, if neither is a sensor."""
    if traits_of(world)[a].sensor >= 0 or traits_of(world)[b].sensor >= 0:
        return NO_CONTACT
    return contact_at(world, a, b, now, now_low)


@kernel
def contact_at(
    world: WorldView, a: int, b: int, now: float, now_low: float
) -> tuple[bool, float, float, float, float, float]:
    """Return the contact of two bodies at a time, with the point in the world's coordinates."""
    return contact_within(world, a, b, now, now_low, 0.0)


@kernel
def contact_within(
    world: WorldView, a: int, b: int, now: float, now_low: float, least: float
) -> tuple[bool, float, float, float, float, float]:
    """Return the same of two bodies that overlap by more than a depth; below 0 it is a gap."""
    ax, ay, _, _ = motion_at(world, a, now, now_low)
    bx, by, _, _ = motion_at(world, b, now, now_low)
    first, second = traits_of(world)[a].collider, traits_of(world)[b].collider
    margin_x, margin_y = margins_of(world, a, b, ax, ay, bx, by)
    margin_x, margin_y = margin_x + least, margin_y + least
    found, normal_x, normal_y, depth, x, y = contact_between(
        shapes_of(world), edges_of(world), first, second, bx - ax, by - ay, margin_x, margin_y
    )
    return found, normal_x, normal_y, depth, ax + x, ay + y
