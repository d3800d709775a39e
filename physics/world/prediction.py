"""What every moving body does next, if nothing interferes: the core of the event-driven step.

Each body has one plan, its earliest event (Lubachevsky, How to simulate billiards and similar
systems, J. Comput. Phys. 94, 1991). A plan holds until one of its two bodies changes its course.
"""

import math

from ..kernels import kernel
from ..pairs.table import impact_between, may_touch
from ..shapes.records import Edges, ShapeRecord
from ..tolerances import NO_APPROACH, SAME_POINT
from .clock_time import elapsed, is_earlier, later
from .lookup.boxes import time_to_leave
from .lookup.inside import find_inside
from .lookup.neighbours import find_near
from .lookup.tree import NO_ONE
from .records import LEAVE, MEET, NOTHING, MotionRecord, PlanRecord, TraitRecord
from .tournament import replay
from .view import (
    WorldView,
    edges_of,
    header_of,
    motions_of,
    moving_of,
    near_of,
    plans_of,
    progress_of,
    shapes_of,
    stale_of,
    traits_of,
    winners_of,
)

# What is far from meeting a body is sorted out with this room, a fraction of the coordinates, and
# the same fraction of the time.
SPARE = 1e-9


@kernel
def is_capped(world: WorldView, slot: int) -> bool:
    """Return whether a body has used up its hits of this step, and so stays where it is."""
    return bool(slot >= 0 and plans_of(world)[slot].hits >= header_of(world).max_hits)


@kernel
def motion_at(
    world: WorldView, body: int, now: float, now_low: float
) -> tuple[float, float, float, float]:
    """Return (x, y, vx, vy) of a body at a time within the step."""
    trait = traits_of(world)[body]
    if trait.slot < 0:
        return trait.home_x, trait.home_y, 0.0, 0.0
    motion = motions_of(world)[trait.slot]
    plan = plans_of(world)[trait.slot]
    since = 0.0 if is_capped(world, trait.slot) else elapsed(now, now_low, plan.at, plan.at_low)
    return motion.x + motion.vx * since, motion.y + motion.vy * since, motion.vx, motion.vy


@kernel
def is_inside(world: WorldView, one: TraitRecord, a: int, other: TraitRecord, b: int) -> bool:
    """Return whether one of two bodies (with their traits) is a sensor and contains the other."""
    if one.sensor >= 0:
        return find_inside(world, a, b) != NO_ONE
    if other.sensor >= 0:
        return find_inside(world, b, a) != NO_ONE
    return False


@kernel
def _approaches(vx: float, vy: float, normal_x: float, normal_y: float, speed: float) -> bool:
    """Return whether two bodies that touch or overlap, perhaps only by rounding, have to bounce.

    Args:
        vx, vy: velocity of the second body, to which the normal points, relative to the first.
        normal_x, normal_y: the normal.
        speed: the sum of both bodies' speeds, on which the rounding of the velocity depends.
    """
    return bool(-(vx * normal_x + vy * normal_y) > NO_APPROACH * speed)


@kernel
def _skewness(shape: ShapeRecord, edges: Edges, x: float, y: float) -> float:
    """Return the sine of the angle between the unit vector (x, y) and the nearest edge's normal."""
    least = 1.0
    for index in range(shape.first, shape.first + shape.count):
        edge = edges[index]
        least = min(least, abs(edge.normal_x * y - edge.normal_y * x))
    return least


@kernel
def _is_straighter(
    world: WorldView, plan: PlanRecord, other: int, normal_x: float, normal_y: float
) -> bool:
    """Return whether a body is met more along a face's normal than the partner that is planned.

    This decides between two bodies that are met at the same time, within rounding. A disc that
    lands on the seam of two boxes meets the face of one and not the corner of the other.
    """
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    rank = _skewness(shapes[traits[other].collider], edges, normal_x, normal_y)
    partner = shapes[traits[plan.partner].collider]
    best_rank = _skewness(partner, edges, plan.normal_x, plan.normal_y)
    return bool(rank < best_rank or (rank == best_rank and other < plan.partner))


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
    _forget_partner(world, slot)
    plan.time = math.inf
    plan.time_low = 0.0
    if not is_capped(world, slot):
        _find_event(world, slot, now, now_low, only_later)
    if plan.kind == MEET:
        _join_suitors(world, slot)
    replay(winners_of(world), plans_of(world), slot)


@kernel
def _join_suitors(world: WorldView, slot: int) -> None:
    """Put a body into the list of those that plan to meet its partner, if the partner moves."""
    plans = plans_of(world)
    plan = plans[slot]
    theirs = traits_of(world)[plan.partner].slot
    if theirs < 0:
        return
    partner = plans[theirs]
    plan.previous_suitor = NO_ONE
    plan.next_suitor = partner.suitor
    if partner.suitor != NO_ONE:
        plans[partner.suitor].previous_suitor = slot
    partner.suitor = slot


@kernel
def _forget_partner(world: WorldView, slot: int) -> None:
    """Let a body plan nothing, and take it out of the list in which it is."""
    plans = plans_of(world)
    plan = plans[slot]
    if plan.kind == MEET:
        theirs = traits_of(world)[plan.partner].slot
        if theirs >= 0:
            if plan.next_suitor != NO_ONE:
                plans[plan.next_suitor].previous_suitor = plan.previous_suitor
            if plan.previous_suitor != NO_ONE:
                plans[plan.previous_suitor].next_suitor = plan.next_suitor
            else:
                plans[theirs].suitor = plan.next_suitor
    plan.kind = NOTHING


@kernel
def _place(
    motion: MotionRecord, plan: PlanRecord, now: float, now_low: float
) -> tuple[float, float]:
    """Return the position at a time of a body that is not capped."""
    since = elapsed(now, now_low, plan.at, plan.at_low)
    return motion.x + motion.vx * since, motion.y + motion.vy * since


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

    The duration is inf if they don't meet before the time ``best`` plus the slack, within which two
    meetings with static bodies count as simultaneous. Bodies that touch or overlap meet only if
    they have to bounce.
    """
    shapes, plans, motions = shapes_of(world), plans_of(world), motions_of(world)
    own, trait = traits_of(world)[moving_of(world)[slot]], traits_of(world)[other]
    motion = motions[slot]
    x, y = _place(motion, plans[slot], since, since_low)
    dx, dy, ux, uy, speed = trait.home_x - x, trait.home_y - y, -motion.vx, -motion.vy, 0.0
    slack = 0.0
    if trait.slot >= 0:
        theirs = motions[trait.slot]
        their_x, their_y = _place(theirs, plans[trait.slot], since, since_low)
        dx, dy, ux, uy = their_x - x, their_y - y, theirs.vx - motion.vx, theirs.vy - motion.vy
        speed = abs(theirs.vx) + abs(theirs.vy)
    elif ux * ux + uy * uy > 0.0:
        coordinates = abs(x) + abs(y) + abs(dx) + abs(dy)
        slack = SAME_POINT * coordinates / math.sqrt(ux * ux + uy * uy)
    left = elapsed(best, best_low, since, since_low) + slack
    if not may_touch(shapes, own.collider, trait.collider, dx, dy, ux, uy, left):
        return math.inf, 0.0, 0.0, slack
    time, normal_x, normal_y = impact_between(
        shapes, edges_of(world), own.collider, trait.collider, dx, dy, ux, uy, left
    )
    if time == 0.0 and own.sensor < 0 and trait.sensor < 0:
        progress_of(world).touching = 1
        speed += abs(motion.vx) + abs(motion.vy)
        if not _approaches(ux, uy, normal_x, normal_y, speed):
            return math.inf, 0.0, 0.0, slack
    return time, normal_x, normal_y, slack


@kernel
def _may_meet(
    world: WorldView,
    slot: int,
    trait: TraitRecord,
    x: float,
    y: float,
    now: float,
    now_low: float,
    left: float,
) -> bool:
    """Return False only if the bounding boxes of two moving bodies stay apart.

    This sorts out most bodies around at a low cost. It leaves more room than rounding takes, so
    that it has no influence on any bit.

    Args:
        world, slot: the first body; x, y: where it is now.
        trait: of the other body.
        now, now_low: the time; left: how much time is left.
    """
    motion, theirs = motions_of(world)[slot], motions_of(world)[trait.slot]
    plan = plans_of(world)[trait.slot]
    since = elapsed(now, now_low, plan.at, plan.at_low)
    their_x, their_y = theirs.x + theirs.vx * since, theirs.y + theirs.vy * since
    dx, dy, ux, uy = their_x - x, their_y - y, theirs.vx - motion.vx, theirs.vy - motion.vy
    # All numbers from which the places were computed, or half of one.
    far = abs(theirs.x) + abs(theirs.y) + abs(motion.x) + abs(motion.y)
    far += abs(their_x) + abs(their_y) + abs(x) + abs(y)
    room = SPARE * far
    shapes = shapes_of(world)
    one, other = shapes[traits_of(world)[moving_of(world)[slot]].collider], shapes[trait.collider]
    return not (
        _stays_apart(
            dx + other.lower_x - one.upper_x - room,
            dx + other.upper_x - one.lower_x + room,
            ux,
            left,
        )
        or _stays_apart(
            dy + other.lower_y - one.upper_y - room,
            dy + other.upper_y - one.lower_y + room,
            uy,
            left,
        )
    )


@kernel
def _stays_apart(lower: float, upper: float, velocity: float, left: float) -> bool:
    """Return whether an interval that moves does not meet 0 in the time that is left."""
    if lower > 0.0:
        return not (velocity < 0.0 and lower + velocity * left <= 0.0)
    if upper < 0.0:
        return not (velocity > 0.0 and upper + velocity * left >= 0.0)
    return False


@kernel
def _find_event(world: WorldView, slot: int, now: float, now_low: float, only_later: bool) -> None:
    """Set a body's plan to its first event, if there is one.

    A pair's time of impact is computed from when both bodies began their courses, whenever that is.
    So nothing but the two courses has an influence on it: no bit depends on the broad phase, or on
    the length of steps.
    """
    traits, plans, near = traits_of(world), plans_of(world), near_of(world)
    plan = plans[slot]
    body = moving_of(world)[slot]
    own = traits[body]
    x, y, vx, vy = motion_at(world, body, now, now_low)
    best, best_low = _plan_to_leave(plan, x, y, vx, vy, now, now_low)
    left = elapsed(best, best_low, now, now_low)
    for index in range(find_near(world, slot, only_later)):
        other = near[index]
        trait = traits[other]
        since, since_low = plan.at, plan.at_low
        if trait.slot >= 0:
            theirs = plans[trait.slot]
            if theirs.hits >= header_of(world).max_hits:
                continue
            if not _may_meet(world, slot, trait, x, y, now, now_low, left):
                continue
            if is_earlier(since, since_low, theirs.at, theirs.at_low):
                since, since_low = theirs.at, theirs.at_low
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
        if plan.kind == MEET and abs(elapsed(begin, begin_low, best, best_low)) <= slack:
            is_first = _is_straighter(world, plan, other, normal_x, normal_y)
        else:
            # At the same time, a meeting comes before leaving. Of two meetings, the order of the
            # bodies decides.
            is_first = is_earlier(begin, begin_low, best, best_low) or (
                begin == best
                and begin_low == best_low
                and (plan.kind != MEET or other < plan.partner)
            )
        if is_first:
            best, best_low = begin, begin_low
            left = elapsed(best, best_low, now, now_low) * (1.0 + SPARE)
            plan.kind = MEET
            plan.partner = other
            plan.normal_x = normal_x
            plan.normal_y = normal_y
    if plan.kind != NOTHING:
        plan.time, plan.time_low = best, best_low


@kernel
def _plan_to_leave(
    plan: PlanRecord, x: float, y: float, vx: float, vy: float, now: float, now_low: float
) -> tuple[float, float]:
    """Plan to leave the box, if the body does; return when, as a time in two numbers."""
    duration = time_to_leave(plan, x, y, vx, vy)
    if duration == math.inf:
        return math.inf, 0.0
    plan.kind = LEAVE
    return later(now, now_low, duration)


@kernel
def find_stale(world: WorldView, slot: int, count: int) -> int:
    """Append the bodies to ``stale`` that plan to meet one whose course has changed."""
    plans, stale = plans_of(world), stale_of(world)
    suitor = plans[slot].suitor
    while suitor != NO_ONE:
        stale[count] = suitor
        count += 1
        suitor = plans[suitor].next_suitor
    return count
