"""What every moving body does next, if nothing interferes: the core of the event-driven step.

Each body has one plan, its earliest event (Lubachevsky, How to simulate billiards and similar
systems, J. Comput. Phys. 94, 1991). A plan holds until one of its two bodies changes its course.
"""

import math

from ..kernels import kernel
from ..pairs.table import impact_between, may_touch
from ..pairs.touching import touch_margins
from ..pairs.touching_point import shared_stretch
from ..shapes.records import Edges, ShapeRecord
from ..tolerances import NO_APPROACH, SAME_POINT
from .clock_time import elapsed, later
from .grid import find_near, time_to_cross
from .records import CROSS_X, CROSS_Y, MEET, NOTHING, PlanRecord, TraitRecord
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
    bodies = traits_of(world).shape[0]
    if one.sensor >= 0:
        return bool(inside_of(world)[one.sensor * bodies + b])
    if other.sensor >= 0:
        return bool(inside_of(world)[other.sensor * bodies + a])
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
def _facing_length(
    world: WorldView,
    a: int,
    b: int,
    now: float,
    now_low: float,
    ahead: float,
    normal_x: float,
    normal_y: float,
) -> float:
    """Return along which length two bodies face each other some time ahead, when they meet."""
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    x, y, vx, vy = motion_at(world, a, now, now_low)
    their_x, their_y, their_vx, their_vy = motion_at(world, b, now, now_low)
    dx = (their_x - x) + (their_vx - vx) * ahead
    dy = (their_y - y) + (their_vy - vy) * ahead
    one, other = traits[a].collider, traits[b].collider
    _, low, high = shared_stretch(shapes, edges, one, other, dx, dy, normal_x, normal_y)
    return high - low


@kernel
def _is_straighter(
    world: WorldView,
    plan: PlanRecord,
    body: int,
    other: int,
    now: float,
    now_low: float,
    ahead: float,
    normal_x: float,
    normal_y: float,
) -> bool:
    """Return whether a body is met more along a face than the partner that is planned.

    This decides between two bodies that are met at the same time, within rounding, some time ahead.
    A disc that lands on the seam of two boxes meets the face of one and not the corner of the
    other. A box that lands there meets the one on which it lies, and not the other's side.
    """
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    rank = _skewness(shapes[traits[other].collider], edges, normal_x, normal_y)
    partner = shapes[traits[plan.partner].collider]
    best_rank = _skewness(partner, edges, plan.normal_x, plan.normal_y)
    if rank == best_rank:
        rank = -_facing_length(world, body, other, now, now_low, ahead, normal_x, normal_y)
        best_rank = -_facing_length(
            world, body, plan.partner, now, now_low, ahead, plan.normal_x, plan.normal_y
        )
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
    if not is_capped(world, slot):
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
    for index in range(find_near(world, slot, only_later)):
        other = near[index]
        trait = traits[other]
        their_x, their_y, their_vx, their_vy = motion_at(world, other, now, now_low)
        dx, dy, ux, uy = their_x - x, their_y - y, their_vx - vx, their_vy - vy
        slack = 0.0
        if trait.slot < 0 and ux * ux + uy * uy > 0.0:
            coordinates = abs(x) + abs(y) + abs(dx) + abs(dy)
            slack = SAME_POINT * coordinates / math.sqrt(ux * ux + uy * uy)
        if not may_touch(shapes, own.collider, trait.collider, dx, dy, ux, uy, best + slack):
            continue
        if is_capped(world, trait.slot) or is_inside(world, own, body, trait, other):
            continue
        margin_x, margin_y = touch_margins(
            shapes, edges, own.collider, trait.collider, x, y, their_x, their_y
        )
        time, normal_x, normal_y = impact_between(
            shapes,
            edges,
            own.collider,
            trait.collider,
            dx,
            dy,
            ux,
            uy,
            best + slack,
            margin_x,
            margin_y,
        )
        if time == math.inf:
            continue
        if time == 0.0 and own.sensor < 0 and trait.sensor < 0:
            progress_of(world).touching = 1
            speed = abs(vx) + abs(vy) + abs(their_vx) + abs(their_vy)
            if not _approaches(ux, uy, normal_x, normal_y, speed):
                continue
        if plan.kind == MEET and abs(time - best) <= slack:
            is_first = _is_straighter(
                world, plan, body, other, now, now_low, best, normal_x, normal_y
            )
        else:
            # At the same time, a meeting comes before a crossing. Of two meetings, the order of the
            # bodies decides, not the order of the grid.
            is_first = time < best or plan.kind != MEET or other < plan.partner
        if is_first:
            best = time
            plan.kind = MEET
            plan.partner = other
            plan.normal_x = normal_x
            plan.normal_y = normal_y
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
