"""What every moving body does next, if nothing interferes: the core of the event-driven step.

Each body has one plan, its earliest event (Lubachevsky, How to simulate billiards and similar
systems, J. Comput. Phys. 94, 1991). A plan holds until one of its two bodies changes its course.
"""

import math

from ..kernels import kernel
from ..pairs.table import impact_between, may_touch
from ..pairs.touching import margin_along
from ..tolerances import FLATTEST, MOST_RESTS, TOUCH
from .clock_time import later
from .courses import margins_of, motion_at, short_way
from .grid import find_near, time_to_cross
from .meetings.passing import passes_by
from .meetings.ties import is_straighter
from .records import CROSS_X, CROSS_Y, LOOK, MEET, NOTHING, PlanRecord, TraitRecord
from .tournament import replay
from .view import (
    WorldView,
    edges_of,
    header_of,
    inside_of,
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
def is_inside(world: WorldView, one: TraitRecord, a: int, other: TraitRecord, b: int) -> bool:
    """Return whether one of two bodies (with their traits) is a sensor and contains the other."""
    bodies = traits_of(world).shape[0]
    if one.sensor >= 0:
        return bool(inside_of(world)[one.sensor * bodies + b])
    if other.sensor >= 0:
        return bool(inside_of(world)[other.sensor * bodies + a])
    return False


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
        latest = best + plan.slack
        if trait.slot < 0 and ux * ux + uy * uy > 0.0:
            coordinates = abs(x) + abs(y) + abs(dx) + abs(dy)
            flat = TOUCH * coordinates / (FLATTEST * math.sqrt(ux * ux + uy * uy))
            latest = best + max(flat, plan.slack)
        if not may_touch(shapes, own.collider, trait.collider, dx, dy, ux, uy, latest):
            continue
        if is_inside(world, own, body, trait, other):
            continue
        margin_x, margin_y = margins_of(world, body, other, x, y, their_x, their_y)
        time, normal_x, normal_y = impact_between(
            shapes,
            edges,
            own.collider,
            trait.collider,
            dx,
            dy,
            ux,
            uy,
            latest,
            margin_x,
            margin_y,
        )
        if time == math.inf:
            continue
        closing = -(ux * normal_x + uy * normal_y)
        margin = margin_along(normal_x, normal_y, margin_x, margin_y)
        if own.sensor < 0 and trait.sensor < 0:
            if time == 0.0:
                progress_of(world).touching = 1
            if time * closing <= margin and passes_by(world, body, other, closing):
                continue
        slack = margin / closing if closing > 0.0 else 0.0
        # At the same time as the best so far: then the later one is touched already.
        is_tied = plan.kind == MEET and -plan.slack <= time - best <= slack
        both_rest = trait.slot < 0 and traits[plan.partner].slot < 0
        if is_tied and (time == best or both_rest):
            when, when_low = later(now, now_low, best)
            is_first = is_straighter(
                world,
                body,
                other,
                normal_x,
                normal_y,
                plan.partner,
                plan.normal_x,
                plan.normal_y,
                when,
                when_low,
            )
        else:
            # At the same time, a meeting comes before a crossing.
            is_first = time < best or (time == best and plan.kind != MEET)
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
            plan.slack = slack
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
    way = short_way(world, body)
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
