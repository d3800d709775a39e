"""The events of a continuous step, each at its exact time, in the order of time."""

from ...kernels import kernel
from ..groups.gathering import meets_alone
from ..groups.outcome import meet_together
from ..lookup.boxes import fit_here, next_margin
from ..meetings.bounces import bounce_pair
from ..meetings.events import contact_point, has_room, write_event
from ..meetings.passing import slowest_hit
from ..meetings.sensors import enter_sensor, is_inside, leave_sensors
from ..meetings.stages import count_hit, inverse_mass_of
from ..plans.changes import plan_after_hit, predict_stale
from ..plans.prediction import predict
from ..plans.suitors import find_stale
from ..state.clock_time import is_earlier
from ..state.courses import is_short_way, move_to, velocity_of
from ..state.records import HIT, LOOK, MEET, Hits
from ..state.view import (
    WorldView,
    moving_of,
    plans_of,
    progress_of,
    traits_of,
    winners_of,
)


@kernel
def run_events(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """Carry out all plans until the step ends, the earliest first; return how many hits there are.

    It stops earlier if there is no room for more hits, and can be called again to continue.

    It always ends, whatever the numbers are. Every meeting counts as a hit of a body that is not
    yet held, and no body has more of these than `max_hits` in each of the three stages before.
    Between two of them a body enters each sensor at most once, looks again at most once, and leaves
    boxes of which each is twice as large as the one before.
    """
    progress = progress_of(world)
    plans = plans_of(world)
    winners = winners_of(world)
    while not progress.full and has_room(world, hits, count):
        slot = winners[1].slot
        if slot < 0:
            break
        plan = plans[slot]
        if is_earlier(progress.end, progress.end_low, plan.time, plan.time_low):
            break
        if plan.kind == LOOK:
            _look(world, slot)
        elif plan.kind != MEET:
            _leave_box(world, slot)
        elif _is_sensed(world, slot):
            count = _enter(world, hits, count, world_index, slot)
        elif meets_alone(world, slot):
            count = _meet(world, hits, count, world_index, slot)
        else:
            now, now_low = plan.time, plan.time_low
            count = meet_together(world, hits, count, world_index, slot, now, now_low)
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
def _look(world: WorldView, slot: int) -> None:
    """Let a body look again what it slides into, as it planned."""
    plan = plans_of(world)[slot]
    now, now_low = plan.time, plan.time_low
    move_to(world, moving_of(world)[slot], now, now_low)
    plan.rests = 0
    count = find_stale(world, slot, 0)  # from its new course, times round in another way
    predict(world, slot, now, now_low, False)
    predict_stale(world, count, now, now_low)


@kernel
def _is_sensed(world: WorldView, slot: int) -> bool:
    """Return whether a body or the partner that it will meet is a sensor."""
    traits = traits_of(world)
    own, other = traits[moving_of(world)[slot]], traits[plans_of(world)[slot].partner]
    return bool(own.sensor >= 0 or other.sensor >= 0)


@kernel
def _planned_pair(world: WorldView, slot: int) -> tuple[int, int, float, float]:
    """Return (a, b, normal_x, normal_y) of what a body plans to meet; a is the lower index."""
    plan = plans_of(world)[slot]
    own = moving_of(world)[slot]
    if own > plan.partner:  # Either of the two may have planned it. No bit depends on which.
        return plan.partner, own, -plan.normal_x, -plan.normal_y
    return own, plan.partner, plan.normal_x, plan.normal_y


@kernel
def _enter(world: WorldView, hits: Hits, count: int, world_index: int, slot: int) -> int:
    """Let a body enter a sensor, or a sensor meet it; return how many events there are."""
    a, b, normal_x, normal_y = _planned_pair(world, slot)
    now, now_low = plans_of(world)[slot].time, plans_of(world)[slot].time_low
    # If both move, both may have planned it: the second one finds it done.
    if not is_inside(world, traits_of(world)[a], a, traits_of(world)[b], b):
        count = enter_sensor(
            world, hits, count, world_index, a, b, now, now_low, normal_x, normal_y
        )
    predict(world, slot, now, now_low, False)
    return count


@kernel
def _meet(world: WorldView, hits: Hits, count: int, world_index: int, slot: int) -> int:
    """Let a body meet its partner, as it planned; return how many hits there are."""
    a, b, normal_x, normal_y = _planned_pair(world, slot)
    now, now_low = plans_of(world)[slot].time, plans_of(world)[slot].time_low
    count = leave_sensors(world, hits, count, world_index, a, now, now_low)
    count = leave_sensors(world, hits, count, world_index, b, now, now_low)
    for body in (a, b):
        if traits_of(world)[body].inverse_mass > 0.0:
            move_to(world, body, now, now_low)
    vx, vy = velocity_of(world, traits_of(world)[a].slot)
    other_vx, other_vy = velocity_of(world, traits_of(world)[b].slot)
    approach = (vx - other_vx) * normal_x + (vy - other_vy) * normal_y
    if approach > slowest_hit(world, a, b):
        impulse = bounce_pair(world, a, b, normal_x, normal_y)
        x, y = contact_point(world, a, b, now, now_low, normal_x, normal_y)
        count = write_event(
            world, hits, count, world_index, HIT, now, a, b, normal_x, normal_y, x, y, impulse
        )
    is_short = is_short_way(world, a) and is_short_way(world, b)
    # It also counts if it was no hit, so that a step always ends.
    for body in (a, b):
        if inverse_mass_of(world, body) > 0.0:
            count_hit(world, traits_of(world)[body].slot, is_short)
    plan_after_hit(world, a, b, now, now_low)
    return count
