"""A step of a world: from event to event, each at its exact time, in the order of time."""

import math
from typing import Any

from ..kernels import kernel
from ..kernels.borrowed import borrowed
from ..pairs.response import bounce_velocities
from ..pairs.table import contact_between
from .clock_time import elapsed, is_earlier, later
from .events import (
    contact_place,
    enter_sensor,
    forget_moved,
    has_room,
    leave_sensor,
    leave_sensors,
    write_event,
)
from .grid import enter, enter_all, find_near, leave
from .memory import (
    clock_of,
    edges_of,
    header_of,
    inside_of,
    left_as_of,
    motions_of,
    moving_of,
    near_of,
    open_world,
    overrides_of,
    plans_of,
    progress_of,
    sensing_of,
    shapes_of,
    stale_of,
    traits_of,
    winners_of,
)
from .overlaps import move_apart, relax_overlaps
from .prediction import find_stale, is_inside, place, predict, rests
from .records import CROSS_X, HIT, MEET, NOTHING, Hit
from .tournament import start_tournament

# What `step_worlds` returns if a number is not finite.
INVALID = -(1 << 62)

HIT_SIZE = Hit.itemsize


@kernel
def step_worlds(states: Any, desk: Any, buffer: Any, count: int, dt: float, steps: int) -> int:
    """Let every world make ``steps`` steps of ``dt``; return how many hits are in the buffer.

    If the buffer is full it has stopped before the end, and returns -1 - count: call it again with
    a larger buffer that holds the same hits, and it goes on from there. It returns `INVALID` if it
    came to a world in which a position or velocity is not finite, or has become so.

    Args:
        states: uint8 [worlds, bytes]; desk: uint8 [bytes], see `world_records`.
        buffer: uint8 [bytes], room for `Hit` records, of which ``count`` are there already.
    """
    hits = borrowed(buffer, 0, buffer.shape[0] // HIT_SIZE, Hit)
    for number in range(states.shape[0]):
        world = open_world(states[number], desk)
        progress = progress_of(world)
        if number < progress.world:
            continue
        progress.world = number
        progress.full = 0
        while progress.step < steps:
            if progress.running == 0 and not begin_step(world, dt):
                progress.step = 0
                progress.world = 0
                return INVALID
            progress.running = 1
            if header_of(world).continuous:
                count = run_events(world, hits, count, number)
            else:
                count = meet_in_place(world, hits, count, number)
            count = finish_step(world, hits, count, number)
            if progress.full:
                return -1 - count
            progress.running = 0
            progress.step += 1
            if count == INVALID:
                progress.step = 0
                progress.world = 0
                return INVALID
        progress.step = 0
        progress.world = 0
    return count


@kernel
def begin_step(world: Any, dt: float) -> bool:
    """Make sure that the plans hold; return False, and do nothing, if a number is not finite."""
    clock = clock_of(world)
    progress = progress_of(world)
    progress.end, progress.end_low = later(clock.time, clock.time_low, dt)
    progress.crowded = 0
    if clock.planned and _are_as_left(motions_of(world), left_as_of(world)):
        return True
    if not _are_finite(motions_of(world)):
        return False
    if header_of(world).sensors > 0:
        forget_moved(world)
    clock.planned = 0
    plans = plans_of(world)
    for slot in range(plans.shape[0]):
        plan = plans[slot]
        plan.at = clock.time
        plan.at_low = clock.time_low
        plan.hits = 0
        plan.time = math.inf
        plan.time_low = 0.0
        plan.kind = NOTHING
    if header_of(world).continuous:
        enter_all(world)
        _predict_all(world)
        if progress.touching and relax_overlaps(world):
            _predict_all(world)
    else:
        progress.slot = 0
        progress.near = 0
        _move_all(world)
        enter_all(world)
    return True


@kernel
def _are_as_left(motions: Any, left_as: Any) -> bool:
    """Tell whether the motions are as the last step left them: nobody has written to them."""
    for slot in range(motions.shape[0]):
        motion, left = motions[slot], left_as[slot]
        if motion.x != left.x or motion.y != left.y:
            return False
        if motion.vx != left.vx or motion.vy != left.vy:
            return False
    return True


@kernel
def _are_finite(motions: Any) -> bool:
    """Tell whether all motions are of numbers."""
    for slot in range(motions.shape[0]):
        motion = motions[slot]
        # What is infinite or no number at all differs from itself.
        total = abs(motion.x) + abs(motion.y) + abs(motion.vx) + abs(motion.vy)
        if total - total != 0.0:
            return False
    return True


@kernel
def _move_all(world: Any) -> None:
    """Let every body be where it is at the end of the step."""
    progress = progress_of(world)
    moving = moving_of(world)
    for slot in range(moving.shape[0]):
        _move_to(world, moving[slot], progress.end, progress.end_low)


@kernel
def _predict_all(world: Any) -> None:
    """Make all plans, at the beginning of a step."""
    clock = clock_of(world)
    progress_of(world).touching = 0
    start_tournament(winners_of(world), plans_of(world))
    for slot in range(plans_of(world).shape[0]):
        predict(world, slot, clock.time, clock.time_low, True)


@kernel
def run_events(world: Any, hits: Any, count: int, number: int) -> int:
    """Let everything happen that is planned, the earliest first; return how many hits there are."""
    progress = progress_of(world)
    plans = plans_of(world)
    winners = winners_of(world)
    while has_room(world, hits, count):
        slot = winners[1]
        if slot < 0:
            break
        plan = plans[slot]
        if is_earlier(progress.end, progress.end_low, plan.time, plan.time_low):
            break
        if plan.kind == MEET:
            count = _meet(world, hits, count, number, slot)
        else:
            _cross(world, slot)
    return count


@kernel
def _cross(world: Any, slot: int) -> None:
    """Take a body over into the next cell that it planned to enter."""
    plan = plans_of(world)[slot]
    motion = motions_of(world)[slot]
    leave(world, slot)
    if plan.kind == CROSS_X:
        plan.column += 1 if motion.vx > 0.0 else -1
    else:
        plan.row += 1 if motion.vy > 0.0 else -1
    enter(world, slot)
    predict(world, slot, plan.time, plan.time_low, False)


@kernel
def _meet(world: Any, hits: Any, count: int, number: int, slot: int) -> int:
    """Let a body meet its partner as planned; return how many hits there are."""
    plan = plans_of(world)[slot]
    a = moving_of(world)[slot]
    b = plan.partner
    now, now_low = plan.time, plan.time_low
    normal_x, normal_y = plan.normal_x, plan.normal_y
    one, other = traits_of(world)[a], traits_of(world)[b]
    if one.sensor >= 0 or other.sensor >= 0:
        # If both move, both may have planned it: the second one finds it done.
        if not is_inside(world, one, a, other, b):
            count = enter_sensor(world, hits, count, number, a, b, now, now_low, normal_x, normal_y)
        predict(world, slot, now, now_low, False)
        return count
    count = leave_sensors(world, hits, count, number, a, now, now_low)
    count = leave_sensors(world, hits, count, number, b, now, now_low)
    for body in (a, b):
        if traits_of(world)[body].inverse_mass > 0.0:
            _move_to(world, body, now, now_low)
    impulse = bounce_pair(world, a, b, normal_x, normal_y)
    x, y = contact_place(world, a, b, now, now_low, normal_x, normal_y)
    count = write_event(
        world, hits, count, number, HIT, now, a, b, normal_x, normal_y, x, y, impulse
    )
    _make_plans(world, a, b, now, now_low)
    return count


@kernel
def bounce_pair(world: Any, a: int, b: int, normal_x: float, normal_y: float) -> float:
    """Exchange the momentum of two bodies along the normal from a to b; return the impulse."""
    one = traits_of(world)[a]
    other = traits_of(world)[b]
    vx_a, vy_a = _velocity(world, one.slot)
    vx_b, vy_b = _velocity(world, other.slot)
    vx_a, vy_a, vx_b, vy_b, impulse = bounce_velocities(
        vx_a,
        vy_a,
        vx_b,
        vy_b,
        one.inverse_mass,
        other.inverse_mass,
        normal_x,
        normal_y,
        _restitution(world, a, b),
    )
    if one.inverse_mass > 0.0:
        motions_of(world)[one.slot].vx = vx_a
        motions_of(world)[one.slot].vy = vy_a
    if other.inverse_mass > 0.0:
        motions_of(world)[other.slot].vx = vx_b
        motions_of(world)[other.slot].vy = vy_b
    return impulse


@kernel
def _velocity(world: Any, slot: int) -> tuple[float, float]:
    """Return the velocity of what has this slot; a static body has none."""
    if slot < 0:
        return 0.0, 0.0
    return motions_of(world)[slot].vx, motions_of(world)[slot].vy


@kernel
def _restitution(world: Any, a: int, b: int) -> float:
    """Return a pair's restitution: its own, or the product of the bodies'."""
    low, high = min(a, b), max(a, b)
    for index in range(overrides_of(world).shape[0]):
        override = overrides_of(world)[index]
        if override.a == low and override.b == high:
            return float(override.restitution)
    return float(traits_of(world)[a].restitution * traits_of(world)[b].restitution)


@kernel
def _move_to(world: Any, body: int, now: float, now_low: float) -> None:
    """Let a body be where it is at a time of the step."""
    slot = traits_of(world)[body].slot
    if slot >= 0:
        x, y, _, _ = place(world, body, now, now_low)
        motions_of(world)[slot].x = x
        motions_of(world)[slot].y = y
        plans_of(world)[slot].at = now
        plans_of(world)[slot].at_low = now_low


@kernel
def _make_plans(world: Any, a: int, b: int, now: float, now_low: float) -> None:
    """After a hit, make anew the plans of the two, and of all who planned to meet one of them."""
    traits = traits_of(world)
    plans = plans_of(world)
    stale = stale_of(world)
    for body in (a, b):
        trait = traits[body]
        if trait.slot >= 0:
            plans[trait.slot].kind = NOTHING
        # What has infinite mass keeps its course: plans to meet it still hold.
        if trait.inverse_mass > 0.0:
            plans[trait.slot].hits += 1
            if rests(world, trait.slot):
                clock_of(world).capped += 1
    count = 0
    for body in (a, b):
        if traits[body].inverse_mass > 0.0:
            count = find_stale(world, traits[body].slot, count)
    for body in (a, b):
        if traits[body].slot >= 0:
            predict(world, traits[body].slot, now, now_low, False)
    for index in range(count):
        predict(world, stale[index], now, now_low, False)


@kernel
def meet_in_place(world: Any, hits: Any, count: int, number: int) -> int:
    """Relax and bounce, pair by pair, what overlaps after all have moved; return the hits.

    The lecture's procedure: no times of impact, so that what is fast may pass through what is thin.
    """
    progress = progress_of(world)
    while progress.slot < plans_of(world).shape[0]:
        body = moving_of(world)[progress.slot]
        near = find_near(world, progress.slot, True)
        while progress.near < near:
            if not has_room(world, hits, count):
                return count
            count = _meet_here(world, hits, count, number, body, near_of(world)[progress.near])
            progress.near += 1
        progress.near = 0
        progress.slot += 1
    return count


@kernel
def _meet_here(world: Any, hits: Any, count: int, number: int, a: int, b: int) -> int:
    """Let two bodies meet if they overlap; return how many hits there are."""
    one, other = traits_of(world)[a], traits_of(world)[b]
    now, now_low = progress_of(world).end, progress_of(world).end_low
    ax, ay, _, _ = place(world, a, now, now_low)
    bx, by, _, _ = place(world, b, now, now_low)
    found, normal_x, normal_y, depth, x, y = contact_between(
        shapes_of(world), edges_of(world), one.collider, other.collider, bx - ax, by - ay
    )
    if not found:
        return count
    if one.sensor >= 0 or other.sensor >= 0:
        if is_inside(world, one, a, other, b):
            return count
        return enter_sensor(world, hits, count, number, a, b, now, now_low, normal_x, normal_y)
    move_apart(world, a, b, normal_x, normal_y, depth)
    impulse = bounce_pair(world, a, b, normal_x, normal_y)
    return write_event(
        world, hits, count, number, HIT, now, a, b, normal_x, normal_y, ax + x, ay + y, impulse
    )


@kernel
def finish_step(world: Any, hits: Any, count: int, number: int) -> int:
    """Let every body be where it is at the end; return how many hits there are.

    It returns `INVALID` if a body has outgrown the numbers.
    """
    header, clock, progress = header_of(world), clock_of(world), progress_of(world)
    if header.sensors > 0:
        count = _leave_all_sensors(world, hits, count, number)
    if progress.full:
        return count
    end, end_low = progress.end, progress.end_low
    clock.time, clock.time_low = end, end_low
    clock.planned = header.continuous and not progress.crowded
    motions, left_as, plans = motions_of(world), left_as_of(world), plans_of(world)
    for slot in range(header.movers):
        motion, left, plan = motions[slot], left_as[slot], plans[slot]
        if plan.hits < header.max_hits:
            since = elapsed(end, end_low, plan.at, plan.at_low)
            motion.x += motion.vx * since
            motion.y += motion.vy * since
            plan.at, plan.at_low = end, end_low
        else:
            # It stays where it is for the rest of this step, and the next one makes new plans.
            clock.planned = 0
        plan.hits = 0
        left.x, left.y, left.vx, left.vy = motion.x, motion.y, motion.vx, motion.vy
    if not _are_finite(motions):
        clock.planned = 0
        return INVALID
    return count


@kernel
def _leave_all_sensors(world: Any, hits: Any, count: int, number: int) -> int:
    """Note who has left which sensor in the course of the step; return how many hits there are."""
    progress = progress_of(world)
    sensing = sensing_of(world)
    inside = inside_of(world)
    bodies = traits_of(world).shape[0]
    for row in range(sensing.shape[0]):
        for body in range(bodies):
            if inside[row * bodies + body]:
                if progress.full or not has_room(world, hits, count):
                    return count
                count = leave_sensor(
                    world, hits, count, number, sensing[row], body, progress.end, progress.end_low
                )
    return count
