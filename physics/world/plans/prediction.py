"""What every moving body does next, if nothing interferes: the core of the event-driven step.

Each body has one plan, its earliest event (Lubachevsky, How to simulate billiards and similar
systems, J. Comput. Phys. 94, 1991). A plan holds until one of its two bodies changes its course.
"""

import math

from ...kernels import kernel
from ...pairs.touching import margin_along
from ...tolerances import FLATTEST, MOST_RESTS, TOUCH
from ..lookup.boxes import fit_all, time_to_leave
from ..lookup.neighbours import find_near, has_list
from ..lookup.tree import NO_ONE
from ..meetings.contacts import solid_contact
from ..meetings.impact import impact_of, may_meet
from ..meetings.passing import passes_by
from ..meetings.sensors import is_inside
from ..meetings.stages import has_reached
from ..meetings.ties import is_straighter
from ..state.clock_time import elapsed, is_earlier, later
from ..state.courses import margins_of, motion_at, place_at, short_way
from ..state.records import HELD, INDEX_BITS, LEAVE, LOOK, MEET, NOTHING, TraitRecord
from ..state.view import (
    WorldView,
    clock_of,
    list_of,
    motions_of,
    moving_of,
    near_of,
    plans_of,
    progress_of,
    shapes_of,
    traits_of,
    winners_of,
)
from .suitors import forget_partner, join_suitors
from .tournament import replay, start_tournament

# This is added to the number of a pair that does not bounce.
WITH_SENSOR = 1 << 62
# What is far from meeting a body is sorted out with this room, a fraction of the coordinates, and
# the same fraction of the time.
SPARE = 1e-9
# A body that reaches a static one at the flattest angle may slide this fraction of the coordinates
# until rounding no longer hides whether they touch, see `_meeting`.
FLAT_WAY = 2.0 * TOUCH / FLATTEST


@kernel
def predict(world: WorldView, slot: int, now: float, now_low: float, only_later: bool) -> None:
    """Make a new plan for a body: its first event from now on.

    Args:
        world, slot: the body.
        now, now_low: the time.
        only_later: consider only moving bodies with later slots (whose plans then need not
            consider this one).
    """
    plan = plans_of(world)[slot]
    forget_partner(world, slot)
    plan.time = math.inf
    plan.time_low = 0.0
    plan.slack = 0.0
    plan.tied = 0
    _find_event(world, slot, now, now_low, only_later)
    body = moving_of(world)[slot]
    partner = plan.partner if plan.kind == MEET else body
    plan.pair = _pair_of(world, body, partner)
    if plan.kind == MEET:
        join_suitors(world, slot)
    replay(winners_of(world), plans_of(world), slot)


@kernel
def _pair_of(world: WorldView, a: int, b: int) -> int:
    """Return the number of a pair of bodies. At one time, the pair with the lowest comes first.

    What bounces comes before what a sensor notices: a body that is turned away where the sensor
    begins does not enter it.
    """
    traits = traits_of(world)
    pair = (min(a, b) << INDEX_BITS) | max(a, b)
    return pair if traits[a].sensor < 0 and traits[b].sensor < 0 else pair + WITH_SENSOR


@kernel
def _meeting(
    world: WorldView,
    slot: int,
    other: int,
    since: float,
    since_low: float,
    best: float,
    best_low: float,
) -> tuple[float, float, float, float]:
    """Return (duration, normal_x, normal_y, slack) of when two bodies meet, seen from a time.

    The duration is inf if they don't meet before the time ``best``, or so soon after it that
    rounding decides. Bodies that touch or overlap meet only if they have to bounce. For so much as
    the slack before they meet, they touch already.
    """
    motions = motions_of(world)
    body = moving_of(world)[slot]
    own, trait = traits_of(world)[body], traits_of(world)[other]
    motion, plan = motions[slot], plans_of(world)[slot]
    x, y = place_at(motion, since, since_low)
    their_x, their_y, ux, uy = trait.home_x, trait.home_y, -motion.vx, -motion.vy
    late = plan.slack
    if trait.slot >= 0:
        theirs = motions[trait.slot]
        their_x, their_y = place_at(theirs, since, since_low)
        ux, uy = theirs.vx - motion.vx, theirs.vy - motion.vy
    dx, dy = their_x - x, their_y - y
    if trait.slot < 0 and ux * ux + uy * uy > 0.0:
        coordinates = abs(x) + abs(y) + abs(dx) + abs(dy)
        late = max(late, TOUCH * coordinates / (FLATTEST * math.sqrt(ux * ux + uy * uy)))
    left = elapsed(best, best_low, since, since_low) + late
    if not may_meet(world, body, other, dx, dy, ux, uy, left):
        return math.inf, 0.0, 0.0, 0.0
    margin_x, margin_y = margins_of(world, body, other, x, y, their_x, their_y)
    time, normal_x, normal_y = impact_of(
        world, body, other, dx, dy, ux, uy, left, margin_x, margin_y
    )
    if time == math.inf:
        return math.inf, 0.0, 0.0, 0.0
    closing = -(ux * normal_x + uy * normal_y)
    margin = margin_along(normal_x, normal_y, margin_x, margin_y)
    if own.sensor < 0 and trait.sensor < 0:
        if progress_of(world).inert and has_reached(world, body, other, HELD):
            # So every meeting has a body that it brings closer to being held.
            return math.inf, 0.0, 0.0, 0.0
        if time * closing <= margin and passes_by(world, body, other, closing):
            return math.inf, 0.0, 0.0, 0.0
    # For no longer than a flat angle explains: a plan to leave the box must not come before that.
    slowest = FLATTEST * _speed_of(world, slot, trait.slot)
    return time, normal_x, normal_y, margin / max(closing, slowest) if closing > 0.0 else 0.0


@kernel
def _speed_of(world: WorldView, slot: int, other: int) -> float:
    """Return the speed that two bodies may have had to each other; a static one (-1) has none."""
    motions = motions_of(world)
    return float(motions[slot].speed + (motions[other].speed if other >= 0 else 0.0))


@kernel
def comes_close(
    world: WorldView,
    slot: int,
    trait: TraitRecord,
    x: float,
    y: float,
    now: float,
    now_low: float,
    left: float,
) -> bool:
    """Return False only if the bounding boxes of two bodies stay apart.

    This sorts out most bodies around at a low cost. It leaves more room than rounding takes, so
    that it has no influence on any bit.

    Args:
        world, slot: the first body, which moves; x, y: where it is now.
        trait: of the other body.
        now, now_low: the time; left: how much time is left until something else happens.
    """
    if left == math.inf:
        return True
    motion = motions_of(world)[slot]
    their_x, their_y, ux, uy = trait.home_x, trait.home_y, -motion.vx, -motion.vy
    # All numbers from which the places were computed, or half of one.
    far, way = abs(motion.x) + abs(motion.y) + abs(x) + abs(y), 0.0
    if trait.slot >= 0:
        theirs = motions_of(world)[trait.slot]
        their_x, their_y = place_at(theirs, now, now_low)
        ux, uy = theirs.vx - motion.vx, theirs.vy - motion.vy
        far += abs(theirs.x) + abs(theirs.y)
    else:
        way = FLAT_WAY * (far + abs(their_x) + abs(their_y))
    dx, dy = their_x - x, their_y - y
    room = SPARE * (far + abs(their_x) + abs(their_y))
    shapes = shapes_of(world)
    one, other = shapes[traits_of(world)[moving_of(world)[slot]].collider], shapes[trait.collider]
    left_x, right_x = (
        dx + other.lower_x - one.upper_x - room,
        dx + other.upper_x - one.lower_x + room,
    )
    left_y, right_y = (
        dy + other.lower_y - one.upper_y - room,
        dy + other.upper_y - one.lower_y + room,
    )
    way_x, way_y = ux * left, uy * left
    # An interval of distances that stays on one side of 0, on either axis. Without branches, which
    # a processor could not foresee.
    return not (
        ((left_x > 0.0) & (left_x + way_x > way))
        | ((right_x < 0.0) & (right_x + way_x < -way))
        | ((left_y > 0.0) & (left_y + way_y > way))
        | ((right_y < 0.0) & (right_y + way_y < -way))
    )


@kernel
def _find_event(world: WorldView, slot: int, now: float, now_low: float, only_later: bool) -> None:
    """Set a body's plan to its first event, if there is one.

    A pair's time of impact is computed from when both bodies began their courses, whenever that is.
    So nothing but the two courses has an influence on it: no bit depends on the broad phase, or on
    the length of steps.
    """
    traits, motions = traits_of(world), motions_of(world)
    plan, motion = plans_of(world)[slot], motions[slot]
    body = moving_of(world)[slot]
    own = traits[body]
    if not only_later and has_list(world, slot):
        count, near = plan.near, list_of(world, slot)
    else:
        count, near = find_near(world, slot, only_later), near_of(world)
    x, y, vx, vy = motion_at(world, body, now, now_low)
    best, best_low = _plan_alone(world, slot, x, y, vx, vy, now, now_low)
    left = elapsed(best, best_low, now, now_low)
    for index in range(count):
        other = near[index]
        trait = traits[other]
        if not comes_close(world, slot, trait, x, y, now, now_low, left):
            continue
        since, since_low = motion.at, motion.at_low
        is_fresh = bool(motion.fresh)
        if trait.slot >= 0:
            theirs = motions[trait.slot]
            is_fresh = is_fresh or bool(theirs.fresh)
            if is_earlier(since, since_low, theirs.at, theirs.at_low):
                since, since_low = theirs.at, theirs.at_low
        if is_fresh and not progress_of(world).overlapping:
            progress_of(world).overlapping = _overlap(world, body, other, now, now_low)
        time, normal_x, normal_y, slack = _meeting(
            world, slot, other, since, since_low, best, best_low
        )
        if time == math.inf or is_inside(world, own, body, trait, other):
            continue
        begin, begin_low = later(since, since_low, time)
        if is_earlier(begin, begin_low, now, now_low):
            # That meeting is over: the body has left the sensor, for instance.
            time, normal_x, normal_y, slack = _meeting(
                world, slot, other, now, now_low, best, best_low
            )
            if time == math.inf:
                continue
            begin, begin_low = later(now, now_low, time)
        wait = elapsed(begin, begin_low, best, best_low)
        # At the same time as the best so far: then the later one is touched already.
        pair = _pair_of(world, body, other)
        best_pair = _pair_of(world, body, plan.partner) if plan.kind == MEET else WITH_SENSOR
        is_tied = max(pair, best_pair) < WITH_SENSOR and -plan.slack <= wait <= slack
        are_static = trait.slot < 0 and traits[plan.partner].slot < 0
        if is_tied and (wait == 0.0 or are_static):
            is_first = is_straighter(
                world,
                body,
                other,
                normal_x,
                normal_y,
                plan.partner,
                plan.normal_x,
                plan.normal_y,
                best,
                best_low,
            )
            # It is met at the first of the two times: until the other, the body might sink in.
            if wait > 0.0:
                begin, begin_low, slack = best, best_low, slack - wait
            else:
                best, best_low = begin, begin_low
                plan.slack += wait
        else:
            # At the same time, a meeting comes before what a body does alone.
            is_before = plan.kind != MEET or pair < best_pair
            is_first = wait < 0.0 or (wait == 0.0 and is_before)
        if is_tied:
            plan.tied = 1
        elif is_first:
            plan.tied = 0
        if is_first:
            best, best_low = begin, begin_low
            plan.kind = MEET
            plan.partner = other
            plan.normal_x = normal_x
            plan.normal_y = normal_y
            plan.slack = slack
            left = elapsed(best, best_low, now, now_low) * (1.0 + SPARE) + slack
    if plan.kind != NOTHING:
        plan.time, plan.time_low = best, best_low


@kernel
def _overlap(world: WorldView, a: int, b: int, now: float, now_low: float) -> bool:
    """Return whether two solid bodies overlap by more than touching, also if they fly apart."""
    ax, ay, _, _ = motion_at(world, a, now, now_low)
    bx, by, _, _ = motion_at(world, b, now, now_low)
    one = shapes_of(world)[traits_of(world)[a].collider]
    other = shapes_of(world)[traits_of(world)[b].collider]
    # Most boxes do not overlap; that costs little to see.
    if bx + other.lower_x > ax + one.upper_x or bx + other.upper_x < ax + one.lower_x:
        return False
    if by + other.lower_y > ay + one.upper_y or by + other.upper_y < ay + one.lower_y:
        return False
    return bool(solid_contact(world, a, b, now, now_low)[0])


@kernel
def _plan_alone(
    world: WorldView,
    slot: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    now: float,
    now_low: float,
) -> tuple[float, float]:
    """Plan what a body does alone: to leave its box, or to look again what it slides into.

    It is at (x, y) with the velocity (vx, vy). This returns when, as a time in two numbers.
    """
    plan, motion = plans_of(world)[slot], motions_of(world)[slot]
    duration, end, end_low = time_to_leave(plan, x, y, vx, vy), math.inf, 0.0
    if duration < math.inf:
        plan.kind = LEAVE
        end, end_low = later(now, now_low, duration)
    speed = abs(vx) + abs(vy)
    if plan.rests >= MOST_RESTS and speed > 0.0:
        # From when its course began, whenever this is asked: so no bit depends on its box.
        duration = short_way(world, moving_of(world)[slot]) / speed
        look, look_low = later(motion.at, motion.at_low, duration)
        if is_earlier(look, look_low, end, end_low):
            plan.kind = LOOK
            end, end_low = look, look_low
    return end, end_low


@kernel
def plan_all(world: WorldView) -> None:
    """Make all boxes and all plans."""
    clock = clock_of(world)
    plans = plans_of(world)
    for slot in range(plans.shape[0]):
        plan = plans[slot]
        plan.time = math.inf
        plan.time_low = 0.0
        plan.kind = NOTHING
        plan.suitor = NO_ONE
    fit_all(world, clock.time, clock.time_low)
    start_tournament(winners_of(world), plans)
    for slot in range(plans.shape[0]):
        predict(world, slot, clock.time, clock.time_low, True)
