"""A group that is resolved together: the hits that it has, and what its bodies do next."""

from ...kernels import kernel
from ...tolerances import NO_APPROACH, NO_TURN, RESOLVED, ROUGHLY, STEPS_OF_ALL, STEPS_PER_TOUCH
from ..meetings.bounces import turn_velocity
from ..meetings.events import contact_point, write_event
from ..meetings.passing import slowest_hit
from ..meetings.sensors import leave_sensors
from ..meetings.stages import count_hit, count_rest, reach_stage
from ..plans.changes import predict_stale, shrink_box
from ..plans.prediction import predict
from ..plans.suitors import find_stale, forget_partner
from ..state.courses import is_short_way, move_to
from ..state.records import CRUSHED, HELD, HIT, Hits
from ..state.view import (
    WorldView,
    inside_of,
    members_of,
    motions_of,
    plans_of,
    progress_of,
    touches_of,
    traits_of,
)
from .gathering import gather_due, join_neighbours
from .order import sort_group
from .solver import group_speed, inverse_masses, lacking, resolve


@kernel
def meet_together(
    world: WorldView,
    hits: Hits,
    count: int,
    world_index: int,
    slot: int,
    now: float,
    now_low: float,
) -> int:
    """Let a body meet its partner, and all meet that do so at the same time; return the hits.

    Nothing happens yet if there is no room for the hits.
    """
    gather_due(world, slot, now, now_low)
    join_neighbours(world, now, now_low)
    sort_group(world)
    has_room_for_all = True
    tolerance = ROUGHLY  # until it is known who is in the group
    for _ in range(2 * touches_of(world).shape[0]):  # two rounds at least add a touch, or end it
        has_room_for_all = resolve(world, tolerance, STEPS_PER_TOUCH, STEPS_OF_ALL)
        if not has_room_for_all:
            break
        if not join_neighbours(world, now, now_low):
            if tolerance == RESOLVED:
                break
            tolerance = RESOLVED
    progress = progress_of(world)
    # What the hits may write, and all that members may leave.
    if hits.shape[0] - count <= progress.touches + inside_of(world).count:
        progress.full = 1
        return count
    count = _move_on(world, hits, count, world_index, now, now_low)
    if not has_room_for_all:
        _crush(world)
    _plan_anew(world, now, now_low)
    return count


@kernel
def _move_on(
    world: WorldView, hits: Hits, count: int, world_index: int, now: float, now_low: float
) -> int:
    """Give all members their velocities, and write the hits; return how many there are."""
    progress, members, touches = progress_of(world), members_of(world), touches_of(world)
    speed = group_speed(world)
    # Velocities are as exact as the group is resolved.
    exactness = NO_TURN if progress.touches == 1 else NO_APPROACH
    _add_up(world)
    for index in range(progress.members):
        member = members[index]
        slot = traits_of(world)[member.body].slot
        motion = motions_of(world)[slot]
        # If nothing comes of a meeting, its bodies begin new courses all the same: the old ones say
        # that they still have to meet.
        if (member.met > 0 or member.due) and member.inverse_mass > 0.0:
            count = leave_sensors(world, hits, count, world_index, member.body, now, now_low)
            move_to(world, member.body, now, now_low)
            rest_x, rest_y = exactness * member.turn_x, exactness * member.turn_y
            turn_velocity(world, slot, member.vx, member.vy, rest_x, rest_y)
        motion.speed = max(motion.speed, speed)
    for index in range(progress.touches):
        touch = touches[index]
        a, b = touch.a, touch.b
        if touch.change > slowest_hit(world, a, b):
            x, y = contact_point(world, a, b, now, now_low, touch.normal_x, touch.normal_y)
            count = write_event(
                world,
                hits,
                count,
                world_index,
                HIT,
                now,
                a,
                b,
                touch.normal_x,
                touch.normal_y,
                x,
                y,
                -touch.change / inverse_masses(world, touch),
            )
    return count


@kernel
def _add_up(world: WorldView) -> None:
    """Count the hits of each member, and add up how they change its velocity, without signs."""
    members = members_of(world)
    for index in range(progress_of(world).members):
        members[index].met = 0
        members[index].turn_x = members[index].turn_y = 0.0
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        if touch.change == 0.0:
            continue
        share = touch.share_a
        for place in (touch.one, touch.other):
            if place >= 0:
                member = members[place]
                member.met += 1
                member.turn_x += abs(touch.change * share * touch.normal_x)
                member.turn_y += abs(touch.change * share * touch.normal_y)
                if touch.restitution == 0.0:
                    member.rests = 1
            share = touch.share_b


@kernel
def _crush(world: WorldView) -> None:
    """Let those have no room, for the rest of the step, that still approach without a bounce."""
    members = members_of(world)
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        if touch.restitution > 0.0 or lacking(world, touch) <= slowest_hit(world, touch.a, touch.b):
            continue
        for place in (touch.one, touch.other):
            if place >= 0 and members[place].inverse_mass > 0.0:
                slot = traits_of(world)[members[place].body].slot
                if plans_of(world)[slot].stage < CRUSHED:
                    reach_stage(world, slot, CRUSHED)


@kernel
def _plan_anew(world: WorldView, now: float, now_low: float) -> None:
    """Count the members' hits; make new plans for them, and for who planned to meet them."""
    progress, members, traits = progress_of(world), members_of(world), traits_of(world)
    is_short = True
    for index in range(progress.members):
        if members[index].met > 0:
            is_short = is_short and is_short_way(world, members[index].body)
    for index in range(progress.members):
        slot = traits[members[index].body].slot
        if members[index].inverse_mass > 0.0:
            # For those who had planned it, a meeting counts even if nothing came of it: each one
            # brings a body closer to `max_hits`, so a step ends.
            for _ in range(max(members[index].met, members[index].due)):
                count_hit(world, slot, is_short)
            if members[index].rests:
                count_rest(world, slot)
    for index in range(progress.members):
        forget_partner(world, traits[members[index].body].slot)  # each would be planned for twice
    count = 0
    for index in range(progress.members):
        if members[index].inverse_mass == 0.0:
            continue
        slot = traits[members[index].body].slot
        if members[index].met > 0 or members[index].due or plans_of(world)[slot].stage == HELD:
            count = find_stale(world, slot, count)
            shrink_box(world, slot, now, now_low)
    for index in range(progress.members):
        predict(world, traits[members[index].body].slot, now, now_low, False)
    predict_stale(world, count, now, now_low)
