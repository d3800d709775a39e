"""A group: moving bodies, and the touches between them that have to be resolved together."""

import math

from ...kernels import kernel
from ...pairs.response import shares
from ...pairs.touching import margin_along
from ..lookup.ground import move_as_one
from ..lookup.tree import NO_ONE
from ..meetings.bounces import restitution_of
from ..meetings.impact import impact_of, may_meet
from ..meetings.passing import passes_by, slowest_hit
from ..meetings.stages import inverse_mass_of
from ..meetings.ties import is_straighter
from ..state.courses import margins_of, motion_at, velocity_of
from ..state.view import (
    WorldView,
    members_of,
    moving_of,
    places_of,
    progress_of,
    touches_of,
    traits_of,
)

# How far two bodies may be apart that are tested, in units of what counts as touching. Those that
# pass each other closely need some way to touch.
_WAY = 1e4
NONE = -1  # no touch


@kernel
def clear_group(world: WorldView) -> None:
    """Let no body be a member."""
    progress, members = progress_of(world), members_of(world)
    for index in range(progress.members):
        places_of(world)[traits_of(world)[members[index].body].slot] = 0
    progress.members = 0
    progress.touches = 0
    progress.elastic = 0
    progress.receding = 0


@kernel
def add_member(world: WorldView, slot: int) -> int:
    """Let a moving body be a member; return its index, or -1 if there is no room."""
    place = places_of(world)[slot]
    if place > 0:
        return int(place - 1)
    progress, members = progress_of(world), members_of(world)
    index = int(progress.members)
    if index == members.shape[0]:
        return -1
    progress.members = index + 1
    places_of(world)[slot] = index + 1
    member = members[index]
    member.body = moving_of(world)[slot]
    member.inverse_mass = inverse_mass_of(world, member.body)
    vx, vy = velocity_of(world, slot)
    member.old_vx = member.vx = vx
    member.old_vy = member.vy = vy
    member.seen = 0
    member.met = member.rests = member.due = 0
    member.first = member.last = NONE
    return index


@kernel
def velocities_of(world: WorldView, body: int) -> tuple[float, float, float, float]:
    """Return a body's velocity before the group is resolved, and after, as far as it is known."""
    slot = traits_of(world)[body].slot
    if slot >= 0 and places_of(world)[slot] > 0:
        member = members_of(world)[places_of(world)[slot] - 1]
        return member.old_vx, member.old_vy, member.vx, member.vy
    vx, vy = velocity_of(world, slot)
    return vx, vy, vx, vy


@kernel
def are_joined(world: WorldView, a: int, b: int) -> bool:
    """Return whether there is a touch of two bodies."""
    return _is_listed(world, a, b) or _is_listed(world, b, a)


@kernel
def _is_listed(world: WorldView, a: int, b: int) -> bool:
    """Return whether there is a touch of which body a is the first one, and b the other."""
    slot = traits_of(world)[a].slot
    if slot < 0 or places_of(world)[slot] == 0:
        return False
    touches = touches_of(world)
    index = members_of(world)[places_of(world)[slot] - 1].first
    while index != NONE:
        if touches[index].b == b:
            return True
        index = touches[index].next
    return False


@kernel
def list_touch(world: WorldView, index: int) -> None:
    """Append a touch to the list of its first member."""
    touches = touches_of(world)
    member = members_of(world)[touches[index].one]
    touches[index].next = NONE
    if member.first == NONE:
        member.first = index
    else:
        touches[member.last].next = index
    member.last = index


@kernel
def join(
    world: WorldView,
    a: int,
    b: int,
    normal_x: float,
    normal_y: float,
    now: float,
    now_low: float,
) -> bool:
    """Add the touch of two bodies, if they have to bounce; return whether it was added.

    They have to if they approached. They also have to if they approach as the others leave them,
    and their hit is inelastic: then they rest on each other, and a rest is a constraint. (Those
    that receded at first, and would gain energy from a bounce of the group, wait for their turn.)

    Args:
        world, a, b: a body of finite mass, and another one.
        normal_x, normal_y: unit vector from a to b.
        now, now_low: the time.
    """
    progress = progress_of(world)
    old_ax, old_ay, ax, ay = velocities_of(world, a)
    old_bx, old_by, bx, by = velocities_of(world, b)
    approach = (old_ax - old_bx) * normal_x + (old_ay - old_by) * normal_y
    least = slowest_hit(world, a, b)
    remains = (ax - bx) * normal_x + (ay - by) * normal_y
    restitution = restitution_of(world, a, b, approach if approach > least else remains)
    if approach > least:
        if restitution > 0.0 and progress.receding:
            return False
    else:
        if restitution > 0.0 or not remains > least:
            return False
        if approach < -least and progress.elastic:
            return False
    aim = restitution * max(approach, 0.0)
    if traits_of(world)[b].inverse_mass == 0.0:
        vx, vy = (old_ax, old_ay) if approach > least else (ax, ay)
        if _is_same_wall(world, a, b, normal_x, normal_y, vx, vy, restitution, aim, now, now_low):
            return False
    if not append(world, a, b, normal_x, normal_y, restitution, aim):
        return False
    if restitution > 0.0:
        progress.elastic = 1
    if approach < -least:
        progress.receding = 1
    return True


@kernel
def append(
    world: WorldView,
    a: int,
    b: int,
    normal_x: float,
    normal_y: float,
    restitution: float,
    aim: float,
) -> bool:
    """Write a touch; return False if there is no room."""
    progress, touches = progress_of(world), touches_of(world)
    if progress.touches == touches.shape[0] - 1:  # the last one is for sorting
        return False
    one = add_member(world, traits_of(world)[a].slot)
    other = -1
    if traits_of(world)[b].slot >= 0:
        other = add_member(world, traits_of(world)[b].slot)
        if other < 0:
            return False
    if one < 0:
        return False
    touch = touches[progress.touches]
    progress.touches += 1
    touch.one, touch.other = one, other
    touch.a, touch.b = a, b
    touch.normal_x, touch.normal_y = normal_x, normal_y
    inverse_mass_a, inverse_mass_b = inverse_mass_of(world, a), inverse_mass_of(world, b)
    touch.share_a, touch.share_b = shares(inverse_mass_a, inverse_mass_b)
    touch.restitution, touch.aim = restitution, aim
    touch.change = 0.0
    list_touch(world, progress.touches - 1)
    return True


@kernel
def would_hit(
    world: WorldView,
    a: int,
    b: int,
    dx: float,
    dy: float,
    ux: float,
    uy: float,
    margin_x: float,
    margin_y: float,
) -> tuple[bool, float, float]:
    """Return (whether they do, normal_x, normal_y) of bodies a and b, if they touch and would hit.

    Args:
        world: the world.
        a, b: bodies; b is at (dx, dy) from a and moves with (ux, uy).
        margin_x, margin_y: their margins.
    """
    speed = max(abs(ux), abs(uy))
    if speed == 0.0:
        return False, 0.0, 0.0
    duration = _WAY * (margin_x + margin_y) / speed
    if not may_meet(world, a, b, dx, dy, ux, uy, duration):
        return False, 0.0, 0.0
    time, normal_x, normal_y = impact_of(world, a, b, dx, dy, ux, uy, duration, margin_x, margin_y)
    if time == math.inf:
        return False, 0.0, 0.0
    closing = -(ux * normal_x + uy * normal_y)
    if time * closing > margin_along(normal_x, normal_y, margin_x, margin_y):
        return False, 0.0, 0.0
    return not passes_by(world, a, b, closing), normal_x, normal_y


@kernel
def _is_same_wall(
    world: WorldView,
    a: int,
    b: int,
    normal_x: float,
    normal_y: float,
    vx: float,
    vy: float,
    restitution: float,
    aim: float,
    now: float,
    now_low: float,
) -> bool:
    """Return whether a body touches another body that is one wall with b, as at a seam.

    Then it would not hit the one if it slid along the other, with that velocity (vx, vy) with which
    it meets b: as it came, or as the group leaves it. Of two that are so, the one that is met more
    along a face stays.
    """
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        if touch.a != a or not move_as_one(world, touch.b, b):
            continue
        is_behind = not _hits_along(
            world, a, b, touch.normal_x, touch.normal_y, vx, vy, now, now_low
        )
        is_before = not _hits_along(world, a, touch.b, normal_x, normal_y, vx, vy, now, now_low)
        if is_behind and is_before:
            is_before = is_straighter(
                world,
                a,
                b,
                normal_x,
                normal_y,
                touch.b,
                touch.normal_x,
                touch.normal_y,
                now,
                now_low,
            )
        if is_before and touch.change == 0.0:
            other = NO_ONE
            if traits_of(world)[b].slot >= 0:
                other = add_member(world, traits_of(world)[b].slot)
                if other < 0:
                    return True
            touch.b, touch.other = b, other
            touch.normal_x, touch.normal_y = normal_x, normal_y
            touch.restitution, touch.aim = restitution, aim
            return True
        if is_behind:
            return True
    return False


@kernel
def _hits_along(
    world: WorldView,
    a: int,
    b: int,
    normal_x: float,
    normal_y: float,
    vx: float,
    vy: float,
    now: float,
    now_low: float,
) -> bool:
    """Return whether a body with a velocity hits one without mass, b, if it slides along a face."""
    x, y, _, _ = motion_at(world, a, now, now_low)
    their_x, their_y, their_vx, their_vy = motion_at(world, b, now, now_low)
    vx, vy = vx - their_vx, vy - their_vy
    margin_x, margin_y = margins_of(world, a, b, x, y, their_x, their_y)
    along = vx * normal_x + vy * normal_y
    ux, uy = along * normal_x - vx, along * normal_y - vy
    hits, _, _ = would_hit(world, a, b, their_x - x, their_y - y, ux, uy, margin_x, margin_y)
    return hits
