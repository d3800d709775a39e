"""What every moving body does next, if nothing interferes: the core of the event-driven step.

Each body has one plan, its earliest event (Lubachevsky, How to simulate billiards and similar
systems, J. Comput. Phys. 94, 1991). A plan holds until one of its two bodies changes its course.
"""

import math

from ..kernels import kernel
from ..pairs.table import impact_between, may_touch
from ..shapes.records import Edges, ShapeRecord
from ..tolerances import MOST_RESTS, NO_APPROACH, NO_WAY, PARALLEL, SAME_POINT, SAME_TIME, SLIDE
from .clock_time import elapsed, later
from .grid import find_near, time_to_cross
from .records import (
    CROSS_X,
    CROSS_Y,
    CRUSHED,
    FREE,
    HELD,
    LOOK,
    MEET,
    NOTHING,
    PlanRecord,
    TraitRecord,
)
from .tournament import replay
from .view import (
    WorldView,
    edges_of,
    header_of,
    inside_of,
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


@kernel
def stage_of(world: WorldView, slot: int) -> int:
    """Return how far a body has used up its hits of this step: FREE for a static one (-1)."""
    return FREE if slot < 0 else int(plans_of(world)[slot].stage)


@kernel
def inverse_mass_of(world: WorldView, body: int) -> float:
    """Return a body's inverse mass for hits: 0 also if it is held where it is."""
    trait = traits_of(world)[body]
    return 0.0 if stage_of(world, trait.slot) >= HELD else float(trait.inverse_mass)


@kernel
def has_reached(world: WorldView, a: int, b: int, stage: int) -> bool:
    """Return whether those of two bodies that have a mass have all reached a stage."""
    traits = traits_of(world)
    for body in (a, b):
        if traits[body].inverse_mass > 0.0 and stage_of(world, traits[body].slot) < stage:
            return False
    return True


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
    since = elapsed(now, now_low, plan.at, plan.at_low)
    return motion.x + motion.vx * since, motion.y + motion.vy * since, motion.vx, motion.vy


@kernel
def move_to(world: WorldView, body: int, now: float, now_low: float) -> None:
    """Move a body to its position at a time within the step."""
    slot = traits_of(world)[body].slot
    if slot >= 0:
        motion, plan = motions_of(world)[slot], plans_of(world)[slot]
        x, y, _, _ = motion_at(world, body, now, now_low)
        way = abs(x - motion.x) + abs(y - motion.y)
        if way > SAME_TIME * (abs(x) + abs(y)):
            plan.instant = 0
        size = _size_of(world, body)
        if 2.0 * way > SLIDE * size:
            plan.rests = 0
        plan.nowhere = not way > NO_WAY * size
        motion.x, motion.y = x, y
        plan.at, plan.at_low = now, now_low


@kernel
def _size_of(world: WorldView, body: int) -> float:
    """Return the width or the height of a body, whichever is less."""
    shape = shapes_of(world)[traits_of(world)[body].collider]
    return float(min(shape.upper_x - shape.lower_x, shape.upper_y - shape.lower_y))


@kernel
def is_short_way(world: WorldView, body: int) -> bool:
    """Return whether a body went next to nowhere when it was moved last, or has no mass."""
    trait = traits_of(world)[body]
    return bool(trait.inverse_mass == 0.0 or plans_of(world)[trait.slot].nowhere)


@kernel
def slowest_hit(world: WorldView, a: int, b: int) -> float:
    """Return the speed of approach that rounding could make of the speeds of two bodies so far."""
    speed = 0.0
    for body in (a, b):
        slot = traits_of(world)[body].slot
        if slot >= 0:
            speed += plans_of(world)[slot].speed
    return NO_APPROACH * speed


@kernel
def is_inside(world: WorldView, one: TraitRecord, a: int, other: TraitRecord, b: int) -> bool:
    """Return whether one of two bodies (with their traits) is a sensor and contains the other."""
    bodies = traits_of(world).shape[0]
    if one.sensor >= 0:
        return bool(inside_of(world)[one.sensor * bodies + b])
    if other.sensor >= 0:
        return bool(inside_of(world)[other.sensor * bodies + a])
    return False


@kernel
def skewness(shape: ShapeRecord, edges: Edges, x: float, y: float) -> float:
    """Return the sine of the angle between the unit vector (x, y) and the nearest edge's normal."""
    least = 1.0
    for index in range(shape.first, shape.first + shape.count):
        edge = edges[index]
        least = min(least, abs(edge.normal_x * y - edge.normal_y * x))
    return least


@kernel
def passes_by(
    world: WorldView,
    a: int,
    b: int,
    ux: float,
    uy: float,
    normal_x: float,
    normal_y: float,
    reach: float,
) -> bool:
    """Return whether two solid bodies that touch and approach do not hit each other.

    They rest if they approach more slowly than rounding can tell. They slide by if they have come
    to rest again and again, and are slow; or if both are round there, and would overlap by less
    than a rounding. (At the angle x it is R x^2 / 2, where R is the sum of the radii. So x is not
    known to 1e-8.) And what has no room moves into what presses it, until the step ends.

    Args:
        world, a, b: the bodies.
        ux, uy: the velocity of b relative to a.
        normal_x, normal_y: unit vector from a to b.
        reach: the sum of the coordinates on which the rounding of the gap depends.
    """
    closing = -(ux * normal_x + uy * normal_y)
    least = slowest_hit(world, a, b)
    if closing <= least:
        return True
    if progress_of(world).inert:
        if has_reached(world, a, b, CRUSHED):
            return True
        if closing <= SLIDE / NO_APPROACH * least and _are_sliding(world, a, b):
            return True
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    one, other = shapes[traits[a].collider], shapes[traits[b].collider]
    radius = one.radius + other.radius
    # In units of the speed, because its square may overflow.
    largest = max(abs(ux), abs(uy))
    sine, x, y = closing / largest, ux / largest, uy / largest
    if radius == 0.0 or sine * sine * radius > 2.0 * SAME_TIME * reach * (x * x + y * y):
        return False
    # A corner is round, too, but a face is not.
    return bool(
        skewness(one, edges, normal_x, normal_y) > PARALLEL
        and skewness(other, edges, normal_x, normal_y) > PARALLEL
    )


@kernel
def _are_held(world: WorldView, a: int, b: int) -> bool:
    """Return whether two bodies that are no sensors have lost their masses in this step.

    So every meeting has a body that it brings closer to being held.
    """
    if not progress_of(world).inert or not has_reached(world, a, b, HELD):
        return False
    traits = traits_of(world)
    return bool(traits[a].sensor < 0 and traits[b].sensor < 0)


@kernel
def _are_sliding(world: WorldView, a: int, b: int) -> bool:
    """Return whether those of two bodies that have a mass have come to rest again and again."""
    traits = traits_of(world)
    for body in (a, b):
        slot = traits[body].slot
        if traits[body].inverse_mass > 0.0 and plans_of(world)[slot].rests < MOST_RESTS:
            return False
    return True


@kernel
def _is_straighter(
    world: WorldView, plan: PlanRecord, other: int, normal_x: float, normal_y: float
) -> bool:
    """Return whether a body is met more along a face's normal than the partner that is planned.

    This decides between two bodies that are met at the same time, within rounding. A disc that
    lands on the seam of two boxes meets the face of one and not the corner of the other.
    """
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    rank = skewness(shapes[traits[other].collider], edges, normal_x, normal_y)
    partner = shapes[traits[plan.partner].collider]
    best_rank = skewness(partner, edges, plan.normal_x, plan.normal_y)
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
    plan.kind = NOTHING
    plan.time = math.inf
    plan.time_low = 0.0
    plan.slack = 0.0
    plan.tied = 0
    _find_event(world, slot, now, now_low, only_later)
    replay(winners_of(world), plans_of(world), slot)


@kernel
def _find_event(world: WorldView, slot: int, now: float, now_low: float, only_later: bool) -> None:
    """Set a body's plan to its first event, if there is one."""
    shapes = shapes_of(world)
    edges = edges_of(world)
    traits = traits_of(world)
    near = near_of(world)
    plan = plans_of(world)[slot]
    body = moving_of(world)[slot]
    own = traits[body]
    x, y, vx, vy = motion_at(world, body, now, now_low)
    best = math.inf if own.roams else _find_crossing(world, plan, x, y, vx, vy)
    if plan.rests >= MOST_RESTS:
        best = _look_again(world, plan, body, abs(vx) + abs(vy), best)
    for index in range(find_near(world, slot, only_later)):
        other = near[index]
        trait = traits[other]
        their_x, their_y, their_vx, their_vy = motion_at(world, other, now, now_low)
        dx, dy, ux, uy = their_x - x, their_y - y, their_vx - vx, their_vy - vy
        slack = 0.0
        if trait.slot < 0 and ux * ux + uy * uy > 0.0:
            coordinates = abs(x) + abs(y) + abs(dx) + abs(dy)
            slack = SAME_POINT * coordinates / math.sqrt(ux * ux + uy * uy)
        latest = best + max(slack, plan.slack)
        if not may_touch(shapes, own.collider, trait.collider, dx, dy, ux, uy, latest):
            continue
        if is_inside(world, own, body, trait, other) or _are_held(world, body, other):
            continue
        time, normal_x, normal_y = impact_between(
            shapes, edges, own.collider, trait.collider, dx, dy, ux, uy, latest
        )
        if time == math.inf:
            continue
        closing = -(ux * normal_x + uy * normal_y)
        coordinates = abs(x) + abs(y) + abs(dx) + abs(dy)
        if own.sensor < 0 and trait.sensor < 0:
            if time == 0.0:
                progress_of(world).touching = 1
            if time * closing <= SAME_TIME * coordinates and passes_by(
                world, body, other, ux, uy, normal_x, normal_y, coordinates
            ):
                continue
        is_tied = plan.kind == MEET and abs(time - best) <= max(slack, plan.slack)
        if plan.kind == MEET and abs(time - best) <= slack:
            is_first = _is_straighter(world, plan, other, normal_x, normal_y)
        else:
            # At the same time, a meeting comes before a crossing. Of two meetings, the bodies and
            # not the order of the grid decide.
            is_first = time < best or plan.kind != MEET
        if is_tied:
            plan.tied = 1
        elif is_first:
            plan.tied = 0
        if is_first:
            best = time
            plan.kind = MEET
            plan.partner = other
            plan.normal_x = normal_x
            plan.normal_y = normal_y
            plan.slack = SAME_TIME * coordinates / closing if closing > 0.0 else 0.0
    if plan.kind != NOTHING:
        plan.time, plan.time_low = later(now, now_low, best)


@kernel
def _find_crossing(
    world: WorldView, plan: PlanRecord, x: float, y: float, vx: float, vy: float
) -> float:
    """Plan to leave the cell, if the body does; return in how long."""
    header = header_of(world)
    time_x = time_to_cross(x, vx, header.left, header.cell, plan.column, header.columns)
    time_y = time_to_cross(y, vy, header.bottom, header.cell, plan.row, header.rows)
    time = min(time_x, time_y)
    if time < math.inf:
        plan.kind = CROSS_X if time_x <= time_y else CROSS_Y
    return time


@kernel
def _look_again(world: WorldView, plan: PlanRecord, body: int, speed: float, best: float) -> float:
    """Plan to look again what a body slides into, if that is its first event; return in how long.

    Args:
        world, plan, body: the body.
        speed: its speed, |vx| + |vy|.
        best: in how long its first event is so far.
    """
    way = SLIDE * _size_of(world, body)
    if speed > 0.0 and way < best * speed:
        plan.kind = LOOK
        return way / speed
    return best


@kernel
def find_stale(world: WorldView, slot: int, count: int) -> int:
    """Append the bodies to ``stale`` that planned to meet one whose course has changed."""
    body = moving_of(world)[slot]
    for index in range(find_near(world, slot, False)):
        other = traits_of(world)[near_of(world)[index]].slot
        if other < 0:
            continue
        plan = plans_of(world)[other]
        if plan.kind == MEET and plan.partner == body:
            plan.kind = NOTHING
            stale_of(world)[count] = other
            count += 1
    return count
