"""Which bodies meet at the same time, and so are resolved together."""

from ...kernels import kernel
from ..lookup.neighbours import find_near, sort_items
from ..meetings.stages import inverse_mass_of
from ..plans.tournament import is_far_ahead, next_due
from ..state.clock_time import elapsed, later
from ..state.courses import margins_of, motion_at
from ..state.records import INDEX_BITS, INDEX_MASK, MEET
from ..state.view import (
    WorldView,
    header_of,
    members_of,
    moving_of,
    near_of,
    plans_of,
    progress_of,
    shapes_of,
    stale_of,
    traits_of,
    winners_of,
)
from .touches import add_member, are_joined, clear_group, join, velocities_of, would_hit

# A fraction of the coordinates and sizes: what is so far apart does not touch.
APART = 1e-6


@kernel
def meets_alone(world: WorldView, slot: int) -> bool:
    """Return whether nothing else can have to do with the meeting of a body and its partner."""
    plans, traits = plans_of(world), traits_of(world)
    plan = plans[slot]
    if plan.tied or header_of(world).inelastic or progress_of(world).inert:
        return False
    if header_of(world).rest_speed > 0.0:
        return False
    other = traits[plan.partner].slot
    if other >= 0 and plans[other].partner == moving_of(world)[slot] and plans[other].tied:
        return False
    # If the partner plans something else at the same time, that counts, too.
    if other >= 0 and plans[other].partner != moving_of(world)[slot]:
        other = -1
    return is_far_ahead(winners_of(world), slot, other, plan.time + plan.slack)


@kernel
def _is_solid_meeting(world: WorldView, slot: int) -> bool:
    """Return whether a body plans to meet another one, and none of the two is a sensor."""
    plan, traits = plans_of(world)[slot], traits_of(world)
    if plan.kind != MEET:
        return False
    return bool(traits[moving_of(world)[slot]].sensor < 0 and traits[plan.partner].sensor < 0)


@kernel
def gather_due(world: WorldView, slot: int, now: float, now_low: float) -> None:
    """Begin a group with a meeting that happens now, and all others at the same time.

    They join in the order of their bodies. So no bit depends on which of the two planned to meet.
    """
    clear_group(world)
    plans, winners, pairs = plans_of(world), winners_of(world), stale_of(world)
    pairs[0] = plans[slot].pair
    count = 1
    latest, latest_low = later(now, now_low, plans[slot].slack)
    node = next_due(winners, plans, 0, latest, latest_low)
    while node > 0:
        other = winners[node].slot
        plan = plans[other]
        # The times may differ by what rounding may do to either.
        wait = elapsed(plan.time, plan.time_low, now, now_low)
        if other != slot and wait <= plan.slack and _is_solid_meeting(world, other):
            pairs[count] = plan.pair
            count += 1
        node = next_due(winners, plans, node, latest, latest_low)
    sort_items(pairs, count)
    for index in range(count):
        if index == 0 or pairs[index] != pairs[index - 1]:
            a, b = pairs[index] >> INDEX_BITS, pairs[index] & INDEX_MASK
            _join_planned(world, a, b, now, now_low)


@kernel
def _join_planned(world: WorldView, a: int, b: int, now: float, now_low: float) -> None:
    """Join two bodies of which one, or both, planned to meet the other."""
    plans, traits = plans_of(world), traits_of(world)
    for body in (a, b):
        # It needs a new plan, also if this turns out to be no hit.
        if traits[body].slot >= 0:
            index = add_member(world, traits[body].slot)
            if index >= 0:
                members_of(world)[index].due = 1
    slot = traits[a].slot
    if slot >= 0 and plans[slot].kind == MEET and plans[slot].partner == b:
        normal_x, normal_y = plans[slot].normal_x, plans[slot].normal_y
    else:
        normal_x, normal_y = -plans[traits[b].slot].normal_x, -plans[traits[b].slot].normal_y
    if inverse_mass_of(world, a) == 0.0:
        a, b, normal_x, normal_y = b, a, -normal_x, -normal_y
    if not are_joined(world, a, b):
        join(world, a, b, normal_x, normal_y, now, now_low)


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
    count = find_near(world, own.slot, False)
    sort_items(near, count)
    x, y, _, _ = motion_at(world, body, now, now_low)
    for index in range(count):
        other = near[index]
        if traits[other].sensor >= 0 or _are_apart(world, body, other, x, y, now, now_low):
            continue
        a, b = body, other
        if b < a and inverse_mass_of(world, b) > 0.0:
            a, b = b, a
        if not are_joined(world, a, b):
            _join_touching(world, a, b, now, now_low)


@kernel
def _are_apart(
    world: WorldView, body: int, other: int, x: float, y: float, now: float, now_low: float
) -> bool:
    """Return whether a body at (x, y) is too far from another one to touch it.

    This sorts out most bodies around, and leaves far more room than touching takes.
    """
    their_x, their_y, _, _ = motion_at(world, other, now, now_low)
    traits, shapes = traits_of(world), shapes_of(world)
    one, two = shapes[traits[body].collider], shapes[traits[other].collider]
    lower_x, upper_x = their_x + two.lower_x, their_x + two.upper_x
    lower_y, upper_y = their_y + two.lower_y, their_y + two.upper_y
    width = (one.upper_x - one.lower_x) + (upper_x - lower_x)
    height = (one.upper_y - one.lower_y) + (upper_y - lower_y)
    room = APART * (abs(x) + abs(y) + abs(their_x) + abs(their_y) + width + height)
    return bool(
        (lower_x - (x + one.upper_x) > room)
        | ((x + one.lower_x) - upper_x > room)
        | (lower_y - (y + one.upper_y) > room)
        | ((y + one.lower_y) - upper_y > room)
    )


@kernel
def _join_touching(world: WorldView, a: int, b: int, now: float, now_low: float) -> None:
    """Join a body of finite mass with another one, if they touch and have to bounce."""
    x, y, _, _ = motion_at(world, a, now, now_low)
    their_x, their_y, _, _ = motion_at(world, b, now, now_low)
    dx, dy = their_x - x, their_y - y
    margin_x, margin_y = margins_of(world, a, b, x, y, their_x, their_y)
    old_vx, old_vy, vx, vy = velocities_of(world, a)
    their_old_vx, their_old_vy, their_vx, their_vy = velocities_of(world, b)
    # First as they came, then as they would go on.
    ux, uy = their_old_vx - old_vx, their_old_vy - old_vy
    touches, normal_x, normal_y = would_hit(world, a, b, dx, dy, ux, uy, margin_x, margin_y)
    if not touches and (ux != their_vx - vx or uy != their_vy - vy):
        ux, uy = their_vx - vx, their_vy - vy
        touches, normal_x, normal_y = would_hit(world, a, b, dx, dy, ux, uy, margin_x, margin_y)
    if touches:
        join(world, a, b, normal_x, normal_y, now, now_low)
