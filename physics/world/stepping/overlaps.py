"""Bodies that overlap: relaxation as a step begins, and the lecture's procedure for a whole step.

The lecture on collisions in games has three parts: detection, relaxation, bounce.
"""

import math

from ...kernels import kernel
from ...pairs.response import shares
from ...tolerances import RELAX_PAIRWISE, RELAX_REACH, RELAX_ROUNDS, RELAX_STEPS, RESOLVED
from ..groups.solver import resolve
from ..groups.touches import append, are_joined, clear_group
from ..lookup.boxes import first_margin, fit, follow
from ..lookup.neighbours import find_near, sort_items
from ..meetings.bounces import bounce_pair
from ..meetings.contacts import contact_at, contact_within, solid_contact
from ..meetings.events import has_room, write_event
from ..meetings.sensors import enter_sensor, is_inside
from ..state.courses import motion_at, move_to
from ..state.records import HIT, Hits
from ..state.view import (
    WorldView,
    boxes_of,
    clock_of,
    members_of,
    motions_of,
    moving_of,
    near_of,
    order_of,
    progress_of,
    shapes_of,
    touches_of,
    traits_of,
)


@kernel
def relax_overlaps(world: WorldView) -> bool:
    """Move overlapping bodies apart, pair by pair; return whether anything moved.

    Moving one pair apart may push it into others: what was moved is fresh, too. So this repeats
    until no fresh body overlaps another one, or, where there is not enough room for all, for a
    limited number of rounds. Where it takes long, as for a light body between heavy ones, all pairs
    are moved apart together now and then. The overlaps that remain are noted in the progress as
    crowded, and the next step continues with them.
    """
    motions, order, traits = motions_of(world), order_of(world), traits_of(world)
    put_in_order(world)
    _freshen_partners(world)
    has_moved, has_room_for_all = False, True
    for number in range(RELAX_ROUNDS):
        deepest = 0.0
        for index in range(order.shape[0]):
            slot = traits[order[index]].slot
            if motions[slot].fresh:
                deepest = max(deepest, _relax_body(world, slot))
        if deepest == 0.0:
            return has_moved
        has_moved = True
        if has_room_for_all and number % RELAX_PAIRWISE == RELAX_PAIRWISE - 1:
            has_room_for_all = _relax_together(world, deepest)
    progress_of(world).crowded = 1
    return has_moved


@kernel
def _freshen_partners(world: WorldView) -> None:
    """Let those be fresh that a fresh body overlaps: so it does not matter which of them it is."""
    clock, motions, traits = clock_of(world), motions_of(world), traits_of(world)
    near, order = near_of(world), order_of(world)
    for place in range(order.shape[0]):
        body = order[place]
        if not motions[traits[body].slot].fresh:
            continue
        for index in range(_find_close(world, traits[body].slot)):
            other = near[index]
            if traits[other].inverse_mass == 0.0 or motions[traits[other].slot].fresh:
                continue
            if solid_contact(world, body, other, clock.time, clock.time_low)[0]:
                _begin_anew(world, other)


@kernel
def put_in_order(world: WorldView) -> None:
    """Write the moving bodies into ``order``, by index: slots may be in another order by edits."""
    moving, order = moving_of(world), order_of(world)
    for slot in range(moving.shape[0]):
        order[slot] = moving[slot]
    sort_items(order, moving.shape[0])


@kernel
def _relax_together(world: WorldView, deepest: float) -> bool:
    """Move fresh bodies out of all others by the shortest ways, weighted by mass.

    To first order, it is a group whose touches lack the depths of their overlaps, see `solver`; an
    overlap below 0 is a gap that may close. What turns on the way is left to the next rounds. If
    there is no room for all, it returns False and moves nothing.

    Args:
        world: the world.
        deepest: of the last overlaps. Only gaps that are not much wider matter.
    """
    clear_group(world)
    motions, near, order = motions_of(world), near_of(world), order_of(world)
    for place in range(order.shape[0]):
        body = order[place]
        slot = traits_of(world)[body].slot
        if not motions[slot].fresh or traits_of(world)[body].inverse_mass == 0.0:
            continue
        for index in range(_find_close(world, slot)):
            _join_close(world, body, near[index], RELAX_REACH * deepest)
    progress, members = progress_of(world), members_of(world)
    if progress.touches < 2:
        return True
    if not resolve(world, RESOLVED, RELAX_STEPS, 0):
        return False
    for index in range(progress.members):
        member = members[index]
        if member.inverse_mass > 0.0:
            _begin_anew(world, member.body)
            motion = motions_of(world)[traits_of(world)[member.body].slot]
            motion.x += member.vx
            motion.y += member.vy
            _follow(world, member.body)
    return True


@kernel
def _join_close(world: WorldView, a: int, b: int, reach: float) -> None:
    """Join two bodies that overlap, or that are apart by no more than the reach."""
    traits = traits_of(world)
    if traits[a].sensor >= 0 or traits[b].sensor >= 0 or are_joined(world, a, b):
        return
    clock = clock_of(world)
    found, normal_x, normal_y, depth, _, _ = contact_within(
        world, a, b, clock.time, clock.time_low, -reach
    )
    if not found or depth == math.inf:
        return
    if append(world, a, b, normal_x, normal_y, 0.0, depth):
        touch = touches_of(world)[progress_of(world).touches - 1]
        for place in (touch.one, touch.other):
            if place >= 0:
                member = members_of(world)[place]
                member.old_vx = member.old_vy = member.vx = member.vy = 0.0


@kernel
def _relax_body(world: WorldView, slot: int) -> float:
    """Move a fresh body out of others; return the depth of the deepest overlap."""
    traits, motions, near = traits_of(world), motions_of(world), near_of(world)
    clock, body = clock_of(world), moving_of(world)[slot]
    deepest = 0.0
    for index in range(_find_close(world, slot)):
        other = near[index]
        theirs = traits[other].slot
        if theirs >= 0 and other < body and motions[theirs].fresh:
            continue  # it was its turn
        found, normal_x, normal_y, depth, _, _ = solid_contact(
            world, body, other, clock.time, clock.time_low
        )
        if found:
            _begin_anew(world, body)
            _begin_anew(world, other)
            _move_apart(world, body, other, normal_x, normal_y, depth)
            _follow(world, body)
            _follow(world, other)
            deepest = max(deepest, depth)
    return deepest


@kernel
def _find_close(world: WorldView, slot: int) -> int:
    """Write the bodies into ``near`` that are in a body's box now; return how many.

    Unlike `find_near`, this does not depend on the boxes of others, and so not on history.
    """
    clock, shapes, near = clock_of(world), shapes_of(world), near_of(world)
    box = boxes_of(world)[slot]
    count = 0
    for index in range(find_near(world, slot, False)):
        other = near[index]
        trait = traits_of(world)[other]
        x, y, _, _ = motion_at(world, other, clock.time, clock.time_low)
        shape = shapes[trait.collider]
        if (
            x + shape.lower_x <= box.upper_x
            and x + shape.upper_x >= box.lower_x
            and y + shape.lower_y <= box.upper_y
            and y + shape.upper_y >= box.lower_y
        ):
            near[count] = other
            count += 1
    sort_items(near, count)
    return count


@kernel
def _begin_anew(world: WorldView, body: int) -> None:
    """Let a body with a mass begin a new course here and now, because it is moved."""
    trait = traits_of(world)[body]
    if trait.inverse_mass > 0.0:
        move_to(world, body, clock_of(world).time, clock_of(world).time_low)
        if not motions_of(world)[trait.slot].fresh:
            motion = motions_of(world)[trait.slot]
            motions_of(world)[trait.slot].fresh = 1
            fit(world, trait.slot, motion.x, motion.y, first_margin(world, trait.slot))


@kernel
def _follow(world: WorldView, body: int) -> None:
    """Let the box of a body follow it, if it was moved."""
    trait = traits_of(world)[body]
    if trait.inverse_mass > 0.0:
        motion = motions_of(world)[trait.slot]
        follow(world, trait.slot, motion.x, motion.y)


@kernel
def _move_apart(
    world: WorldView, a: int, b: int, normal_x: float, normal_y: float, depth: float
) -> None:
    """Move two bodies apart along the normal from a to b, in shares reciprocal to mass."""
    one = traits_of(world)[a]
    other = traits_of(world)[b]
    share_a, share_b = shares(one.inverse_mass, other.inverse_mass)
    if share_a > 0.0:
        motion = motions_of(world)[one.slot]
        motion.x -= depth * share_a * normal_x
        motion.y -= depth * share_a * normal_y
    if share_b > 0.0:
        motion = motions_of(world)[other.slot]
        motion.x += depth * share_b * normal_x
        motion.y += depth * share_b * normal_y


@kernel
def resolve_overlaps(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """After all bodies have moved, detect, relax and bounce pair by pair; return the hits.

    This is the lecture's procedure. It has no times of impact, so that a fast body may pass through
    a thin one. It stops early if there is no room for more hits, and can be called again.
    """
    progress, traits, order = progress_of(world), traits_of(world), order_of(world)
    while progress.next_body < order.shape[0]:
        body = order[progress.next_body]
        near = find_near(world, traits[body].slot, False)
        sort_items(near_of(world), near)
        while progress.next_near < near:
            if not has_room(world, hits, count):
                return count
            other = near_of(world)[progress.next_near]
            if other > body or traits[other].slot < 0:  # Of two that move, the first one's turn.
                count = _resolve_pair(world, hits, count, world_index, body, other)
            progress.next_near += 1
        progress.next_near = 0
        progress.next_body += 1
    return count


@kernel
def _resolve_pair(
    world: WorldView, hits: Hits, count: int, world_index: int, a: int, b: int
) -> int:
    """Relax and bounce two bodies if they overlap; return how many hits there are."""
    one, other = traits_of(world)[a], traits_of(world)[b]
    now, now_low = progress_of(world).end, progress_of(world).end_low
    found, normal_x, normal_y, depth, x, y = contact_at(world, a, b, now, now_low)
    if not found:
        return count
    if one.sensor >= 0 or other.sensor >= 0:
        if is_inside(world, one, a, other, b):
            return count
        return enter_sensor(world, hits, count, world_index, a, b, now, now_low, normal_x, normal_y)
    _move_apart(world, a, b, normal_x, normal_y, depth)
    impulse = bounce_pair(world, a, b, normal_x, normal_y)
    return write_event(
        world, hits, count, world_index, HIT, now, a, b, normal_x, normal_y, x, y, impulse
    )
