"""The events of a continuous step, each at its exact time, in the order of time."""

import math

from ..kernels import kernel
from ..pairs.response import bounce_velocities
from .clock_time import is_earlier
from .events import contact_point, enter_sensor, has_room, leave_sensors, write_event
from .lookup.boxes import fit_here, margin_after_hit, next_margin
from .lookup.overrides import find_override
from .prediction import find_stale, is_capped, is_inside, motion_at, predict
from .records import HIT, MEET, Hits
from .view import (
    WorldView,
    clock_of,
    motions_of,
    moving_of,
    overrides_of,
    plans_of,
    progress_of,
    stale_of,
    traits_of,
    winners_of,
)


@kernel
def run_events(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """Carry out all plans until the step ends, the earliest first; return how many hits there are.

    It stops earlier if there is no room for more hits, and can be called again to continue. It
    always ends: a body has no more hits than `max_hits`, and between two of them it enters each
    sensor at most once, and leaves boxes of which each is twice as large as the one before.
    """
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
            count = _meet(world, hits, count, world_index, slot)
        else:
            _leave_box(world, slot)
    return count


@kernel
def _leave_box(world: WorldView, slot: int) -> None:
    """Let a body leave its box and get another one, as it planned."""
    plan = plans_of(world)[slot]
    now, now_low = plan.time, plan.time_low
    margin = next_margin(world, slot)
    fit_here(world, slot, now, now_low, margin)
    predict(world, slot, now, now_low, False)


@kernel
def _meet(world: WorldView, hits: Hits, count: int, world_index: int, slot: int) -> int:
    """Let a body meet its partner, as it planned; return how many hits there are."""
    plan = plans_of(world)[slot]
    a = moving_of(world)[slot]
    b = plan.partner
    now, now_low = plan.time, plan.time_low
    normal_x, normal_y = plan.normal_x, plan.normal_y
    if a > b:  # Either of the two may have planned it. No bit depends on which.
        a, b, normal_x, normal_y = b, a, -normal_x, -normal_y
    one, other = traits_of(world)[a], traits_of(world)[b]
    if one.sensor >= 0 or other.sensor >= 0:
        # If both move, both may have planned it: the second one finds it done.
        if not is_inside(world, one, a, other, b):
            count = enter_sensor(
                world, hits, count, world_index, a, b, now, now_low, normal_x, normal_y
            )
        predict(world, slot, now, now_low, False)
        return count
    count = leave_sensors(world, hits, count, world_index, a, now, now_low)
    count = leave_sensors(world, hits, count, world_index, b, now, now_low)
    for body in (a, b):
        if traits_of(world)[body].inverse_mass > 0.0:
            move_to(world, body, now, now_low)
    impulse = bounce_pair(world, a, b, normal_x, normal_y)
    x, y = contact_point(world, a, b, now, now_low, normal_x, normal_y)
    count = write_event(
        world, hits, count, world_index, HIT, now, a, b, normal_x, normal_y, x, y, impulse
    )
    _plan_after_hit(world, a, b, now, now_low)
    return count


@kernel
def bounce_pair(world: WorldView, a: int, b: int, normal_x: float, normal_y: float) -> float:
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
def _velocity(world: WorldView, slot: int) -> tuple[float, float]:
    """Return the velocity of the body with this slot; a static body (-1) has none."""
    if slot < 0:
        return 0.0, 0.0
    return motions_of(world)[slot].vx, motions_of(world)[slot].vy


@kernel
def _restitution(world: WorldView, a: int, b: int) -> float:
    """Return the restitution of a pair: its own, or the product of the bodies' values."""
    own = find_override(overrides_of(world), min(a, b), max(a, b))
    if math.isnan(own):
        return float(traits_of(world)[a].restitution * traits_of(world)[b].restitution)
    return own


@kernel
def move_to(world: WorldView, body: int, now: float, now_low: float) -> None:
    """Move a body to its position at a time within the step."""
    slot = traits_of(world)[body].slot
    if slot >= 0:
        x, y, _, _ = motion_at(world, body, now, now_low)
        motions_of(world)[slot].x = x
        motions_of(world)[slot].y = y
        plans_of(world)[slot].at = now
        plans_of(world)[slot].at_low = now_low


@kernel
def _plan_after_hit(world: WorldView, a: int, b: int, now: float, now_low: float) -> None:
    """Make new plans for two bodies that have bounced, and for all that planned to meet them."""
    traits = traits_of(world)
    plans = plans_of(world)
    stale = stale_of(world)
    for body in (a, b):
        trait = traits[body]
        # A body of infinite mass keeps its course: plans to meet it still hold.
        if trait.inverse_mass > 0.0:
            plans[trait.slot].hits += 1
            if is_capped(world, trait.slot):
                clock_of(world).capped += 1
    count = 0
    for body in (a, b):
        slot = traits[body].slot
        if traits[body].inverse_mass > 0.0:
            count = find_stale(world, slot, count)
            margin = margin_after_hit(world, slot)
            if margin < plans[slot].margin:
                fit_here(world, slot, now, now_low, margin)
    for body in (a, b):
        if traits[body].slot >= 0:
            predict(world, traits[body].slot, now, now_low, False)
    for index in range(count):
        predict(world, stale[index], now, now_low, False)
