"""Which bodies meet at the same time, and so are resolved together."""

import math

from ...kernels import kernel
from ...pairs.table import impact_between, may_touch
from ...tolerances import SAME_TIME
from ..clock_time import elapsed, later
from ..grid import find_near
from ..prediction import motion_at, passes_by
from ..records import MEET
from ..tournament import is_far_ahead, next_due
from ..view import (
    WorldView,
    edges_of,
    header_of,
    members_of,
    motions_of,
    moving_of,
    near_of,
    plans_of,
    progress_of,
    shapes_of,
    traits_of,
    winners_of,
)
from .touches import add_member, are_joined, clear_group, join, velocities_of

# How far two bodies may be apart that are tested, in units of what counts as touching. Those that
# pass each other closely need some way to touch.
_WAY = 1e4


@kernel
def meets_alone(world: WorldView, slot: int) -> bool:
    """Return whether nothing else can have to do with the meeting of a body and its partner."""
    plans, traits = plans_of(world), traits_of(world)
    plan = plans[slot]
    if plan.tied or header_of(world).inelastic or progress_of(world).inert:
        return False
    other = traits[plan.partner].slot
    if other >= 0 and plans[other].partner == moving_of(world)[slot] and plans[other].tied:
        return False
    # If the partner plans something else at the same time, that counts, too.
    if other >= 0 and plans[other].partner != moving_of(world)[slot]:
        other = -1
    return is_far_ahead(winners_of(world), plans, slot, other, plan.time + plan.slack)


@kernel
def _is_solid_meeting(world: WorldView, slot: int) -> bool:
    """Return whether a body plans to meet another one, and none of the two is a sensor."""
    plan, traits = plans_of(world)[slot], traits_of(world)
    if plan.kind != MEET:
        return False
    return bool(traits[moving_of(world)[slot]].sensor < 0 and traits[plan.partner].sensor < 0)


@kernel
def gather_due(world: WorldView, slot: int, now: float, now_low: float) -> None:
    """Begin a group with a meeting that happens now, and all others at the same time."""
    clear_group(world)
    plans, winners = plans_of(world), winners_of(world)
    _join_planned(world, slot, now, now_low)
    latest, latest_low = later(now, now_low, plans[slot].slack)
    node = next_due(winners, plans, 0, latest, latest_low)
    while node > 0:
        other = winners[node]
        plan = plans[other]
        # The times may differ by what rounding may do to either.
        wait = elapsed(plan.time, plan.time_low, now, now_low)
        if other != slot and wait <= plan.slack and _is_solid_meeting(world, other):
            _join_planned(world, other, now, now_low)
        node = next_due(winners, plans, node, latest, latest_low)


@kernel
def _join_planned(world: WorldView, slot: int, now: float, now_low: float) -> None:
    """Join a body with the partner that it planned to meet."""
    plan = plans_of(world)[slot]
    a, b = moving_of(world)[slot], plan.partner
    normal_x, normal_y = plan.normal_x, plan.normal_y
    # They need new plans, also if this turns out to be no hit.
    add_member(world, slot)
    if traits_of(world)[b].slot >= 0:
        add_member(world, traits_of(world)[b].slot)
    if traits_of(world)[a].inverse_mass == 0.0:
        a, b, normal_x, normal_y = b, a, -normal_x, -normal_y
    if not are_joined(world, a, b):
        reach = _coordinates(world, a, now, now_low) + _coordinates(world, b, now, now_low)
        join(world, a, b, normal_x, normal_y, reach)


@kernel
def _coordinates(world: WorldView, body: int, now: float, now_low: float) -> float:
    """Return the sum of the coordinates of where a body is and where it came from."""
    x, y, _, _ = motion_at(world, body, now, now_low)
    slot = traits_of(world)[body].slot
    if slot < 0:
        return abs(x) + abs(y)
    motion = motions_of(world)[slot]
    return float(abs(x) + abs(y) + abs(motion.x) + abs(motion.y))


@kernel
def join_neighbours(world: WorldView, now: float, now_low: float) -> bool:
    """Join the members with what else they touch and have to bounce off; return if any did.

    This tests the neighbours of those members that have not been tested with their present
    velocities, also of the ones that join meanwhile.
    """
    progress, members = progress_of(world), members_of(world)
    before = progress.touches
    index = 0
    while index < progress.members:
        member = members[index]
        if member.inverse_mass > 0.0 and not (
            member.seen and member.seen_vx == member.vx and member.seen_vy == member.vy
        ):
            member.seen = 1
            member.seen_vx, member.seen_vy = member.vx, member.vy
            _join_around(world, member.body, now, now_low)
        index += 1
    return bool(progress.touches > before)


@kernel
def _join_around(world: WorldView, body: int, now: float, now_low: float) -> None:
    """Join a body with all that it touches and has to bounce off."""
    traits, near = traits_of(world), near_of(world)
    own = traits[body]
    if own.sensor >= 0:
        return
    x, y, _, _ = motion_at(world, body, now, now_low)
    own_reach = _coordinates(world, body, now, now_low)
    old_vx, old_vy, vx, vy = velocities_of(world, body)
    for index in range(find_near(world, own.slot, False)):
        other = near[index]
        trait = traits[other]
        if trait.sensor >= 0:
            continue
        their_x, their_y, _, _ = motion_at(world, other, now, now_low)
        dx, dy = their_x - x, their_y - y
        their_old_vx, their_old_vy, their_vx, their_vy = velocities_of(world, other)
        reach = own_reach + _coordinates(world, other, now, now_low)
        # First as they came, then as they would go on.
        ux, uy = their_old_vx - old_vx, their_old_vy - old_vy
        touches, normal_x, normal_y = _touch(world, body, other, dx, dy, ux, uy, reach)
        if not touches and (ux != their_vx - vx or uy != their_vy - vy):
            ux, uy = their_vx - vx, their_vy - vy
            touches, normal_x, normal_y = _touch(world, body, other, dx, dy, ux, uy, reach)
        if touches and not are_joined(world, body, other):
            join(world, body, other, normal_x, normal_y, reach)


@kernel
def _touch(
    world: WorldView, a: int, b: int, dx: float, dy: float, ux: float, uy: float, reach: float
) -> tuple[bool, float, float]:
    """Return (whether they do, normal_x, normal_y) of bodies a and b, if they touch and would hit.

    Args:
        world: the world.
        a, b: bodies; b is at (dx, dy) from a and moves with (ux, uy).
        reach: the sum of the coordinates on which the rounding of their gap depends.
    """
    speed = max(abs(ux), abs(uy))
    if speed == 0.0:
        return False, 0.0, 0.0
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    one, other = traits[a].collider, traits[b].collider
    tolerance = SAME_TIME * reach
    duration = _WAY * tolerance / speed
    if not may_touch(shapes, one, other, dx, dy, ux, uy, duration):
        return False, 0.0, 0.0
    time, normal_x, normal_y = impact_between(shapes, edges, one, other, dx, dy, ux, uy, duration)
    if time == math.inf or -time * (ux * normal_x + uy * normal_y) > tolerance:
        return False, 0.0, 0.0
    if passes_by(world, a, b, ux, uy, normal_x, normal_y, reach):
        return False, 0.0, 0.0
    return True, normal_x, normal_y
