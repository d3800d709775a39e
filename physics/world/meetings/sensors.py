"""Sensors: which bodies enter and leave them, and when."""

import math

from ...kernels import kernel
from ...pairs.table import impact_between, overlap_between
from ..lookup.inside import find_inside, put_inside, take_outside
from ..lookup.tree import NO_ONE
from ..state.clock_time import is_earlier, later
from ..state.courses import margins_of, motion_at
from ..state.records import BEGIN, END, Hits, TraitRecord
from ..state.view import (
    WorldView,
    clock_of,
    edges_of,
    first_inside_of,
    header_of,
    inside_of,
    motions_of,
    pairs_of,
    progress_of,
    shapes_of,
    traits_of,
)
from .events import contact_point, has_room, write_event


@kernel
def enter_sensor(
    world: WorldView,
    hits: Hits,
    count: int,
    world_index: int,
    a: int,
    b: int,
    now: float,
    now_low: float,
    normal_x: float,
    normal_y: float,
) -> int:
    """Note that a body enters a sensor, in either order; return how many events there are."""
    if traits_of(world)[a].sensor >= 0:
        put_inside(world, a, b)
    else:
        put_inside(world, b, a)
    x, y = contact_point(world, a, b, now, now_low, normal_x, normal_y)
    return write_event(
        world, hits, count, world_index, BEGIN, now, a, b, normal_x, normal_y, x, y, 0.0
    )


@kernel
def leave_placed(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """Note which sensors bodies are no longer inside as a step begins, because one was moved.

    Somebody has placed it, or relaxation has moved it. It returns how many events there are. A body
    that was placed inside again has not left.
    """
    clock, firsts, pairs = clock_of(world), first_inside_of(world), pairs_of(world)
    if inside_of(world).count == 0:
        return count
    for body in range(firsts.shape[0]):
        place = firsts[body] if traits_of(world)[body].sensor < 0 else NO_ONE
        while place != NO_ONE:
            pair = pairs[place]
            sensor, moved = pair.sensor, pair.moved
            place = pair.next
            pair.moved = 0
            if not (moved or _is_fresh(world, body) or _is_fresh(world, sensor)):
                continue
            if not _overlap(world, sensor, body):
                take_outside(world, sensor, body)
                x, y, _, _ = motion_at(world, body, clock.time, clock.time_low)
                count = write_event(
                    world,
                    hits,
                    count,
                    world_index,
                    END,
                    clock.time,
                    sensor,
                    body,
                    0.0,
                    0.0,
                    x,
                    y,
                    0.0,
                )
    return count


@kernel
def _is_fresh(world: WorldView, body: int) -> bool:
    """Return whether a body has begun a new course since the last step."""
    slot = traits_of(world)[body].slot
    return bool(slot >= 0 and motions_of(world)[slot].fresh)


@kernel
def _overlap(world: WorldView, a: int, b: int) -> bool:
    """Return whether two bodies overlap, or touch and are about to, as a step begins."""
    now, now_low = clock_of(world).time, clock_of(world).time_low
    one, other = traits_of(world)[a].collider, traits_of(world)[b].collider
    x, y, vx, vy = motion_at(world, a, now, now_low)
    their_x, their_y, their_vx, their_vy = motion_at(world, b, now, now_low)
    dx, dy, ux, uy = their_x - x, their_y - y, their_vx - vx, their_vy - vy
    shapes, edges = shapes_of(world), edges_of(world)
    margin_x, margin_y = margins_of(world, a, b, x, y, their_x, their_y)
    if overlap_between(shapes, edges, one, other, dx, dy, margin_x, margin_y):
        return True
    time, _, _ = impact_between(shapes, edges, one, other, dx, dy, ux, uy, 0.0, margin_x, margin_y)
    return bool(time == 0.0)


@kernel
def leave_sensor(
    world: WorldView,
    hits: Hits,
    count: int,
    world_index: int,
    sensor: int,
    body: int,
    now: float,
    now_low: float,
) -> int:
    """Note that a body has left a sensor, if it has; return how many events there are.

    Both have moved in straight lines: it left when it would enter if both moved backwards from
    here.
    """
    here = traits_of(world)[sensor]
    there = traits_of(world)[body]
    x, y, vx, vy = motion_at(world, sensor, now, now_low)
    body_x, body_y, body_vx, body_vy = motion_at(world, body, now, now_low)
    dx, dy, vx, vy = body_x - x, body_y - y, body_vx - vx, body_vy - vy
    if overlap_between(shapes_of(world), edges_of(world), here.collider, there.collider, dx, dy):
        return count
    if not header_of(world).continuous:
        vx = vy = 0.0
    ahead, _, _ = impact_between(
        shapes_of(world), edges_of(world), here.collider, there.collider, dx, dy, vx, vy, math.inf
    )
    if ahead < math.inf:
        # It touches and is about to move in: it has only just entered.
        return count
    back, normal_x, normal_y = impact_between(
        shapes_of(world), edges_of(world), here.collider, there.collider, dx, dy, -vx, -vy, math.inf
    )
    if back == math.inf:
        back = 0.0
    take_outside(world, sensor, body)
    exit_time, exit_low = later(now, now_low, -back)
    begin, begin_low = clock_of(world).time, clock_of(world).time_low
    if is_earlier(exit_time, exit_low, begin, begin_low):
        exit_time, exit_low = begin, begin_low
    x, y = contact_point(world, sensor, body, exit_time, exit_low, normal_x, normal_y)
    return write_event(
        world, hits, count, world_index, END, exit_time, sensor, body, normal_x, normal_y, x, y, 0.0
    )


@kernel
def leave_sensors(
    world: WorldView,
    hits: Hits,
    count: int,
    world_index: int,
    body: int,
    now: float,
    now_low: float,
) -> int:
    """Note which sensors a body has left, before it changes its course."""
    if header_of(world).sensors == 0:
        return count
    pairs = pairs_of(world)
    place = first_inside_of(world)[body]
    while place != NO_ONE:
        pair = pairs[place]
        place = pair.next
        count = leave_sensor(world, hits, count, world_index, pair.sensor, body, now, now_low)
    return count


@kernel
def leave_all_sensors(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """Note which bodies left which sensors in this step; return how many events there are."""
    progress = progress_of(world)
    if inside_of(world).count == 0:
        return count
    if progress.full or not has_room(world, hits, count):
        return count
    for body in range(first_inside_of(world).shape[0]):
        if traits_of(world)[body].sensor < 0:
            count = leave_sensors(
                world, hits, count, world_index, body, progress.end, progress.end_low
            )
    return count


@kernel
def is_inside(world: WorldView, one: TraitRecord, a: int, other: TraitRecord, b: int) -> bool:
    """Return whether one of two bodies (with their traits) is a sensor and contains the other."""
    if one.sensor >= 0:
        return find_inside(world, a, b) != NO_ONE
    if other.sensor >= 0:
        return find_inside(world, b, a) != NO_ONE
    return False
