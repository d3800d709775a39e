"""What happens, written down: hits, and the bodies that enter or leave a sensor."""

import math

from ..kernels import kernel
from ..pairs.table import impact_between, overlap_between
from ..pairs.touching_point import touching_point
from .clock_time import is_earlier, later
from .courses import motion_at
from .records import BEGIN, END, Hits
from .view import (
    WorldView,
    clock_of,
    edges_of,
    header_of,
    inside_of,
    motions_after_step_of,
    motions_of,
    moving_of,
    progress_of,
    sensing_of,
    shapes_of,
    traits_of,
)


@kernel
def has_room(world: WorldView, hits: Hits, count: int) -> bool:
    """Return whether there is room for all that one event may cause; note it if not."""
    # A hit, and the sensors that its two bodies leave.
    if hits.shape[0] - count > 2 * header_of(world).sensors:
        return True
    progress_of(world).full = 1
    return False


@kernel
def write_event(
    world: WorldView,
    hits: Hits,
    count: int,
    world_index: int,
    kind: int,
    time: float,
    a: int,
    b: int,
    normal_x: float,
    normal_y: float,
    point_x: float,
    point_y: float,
    impulse: float,
) -> int:
    """Write an event of two bodies; return how many events there are now."""
    if a > b:
        a, b, normal_x, normal_y = b, a, -normal_x, -normal_y
    hit = hits[count]
    hit.world = world_index
    hit.kind = kind
    hit.time = time
    hit.a = a
    hit.b = b
    hit.normal[0] = normal_x
    hit.normal[1] = normal_y
    hit.point[0] = point_x
    hit.point[1] = point_y
    hit.impulse = impulse
    return count + 1


@kernel
def contact_point(
    world: WorldView, a: int, b: int, now: float, now_low: float, normal_x: float, normal_y: float
) -> tuple[float, float]:
    """Return the point at which two bodies touch along the normal from a to b."""
    ax, ay, _, _ = motion_at(world, a, now, now_low)
    bx, by, _, _ = motion_at(world, b, now, now_low)
    x, y = touching_point(
        shapes_of(world),
        edges_of(world),
        traits_of(world)[a].collider,
        traits_of(world)[b].collider,
        bx - ax,
        by - ay,
        normal_x,
        normal_y,
    )
    return ax + x, ay + y


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
    bodies = traits_of(world).shape[0]
    if traits_of(world)[a].sensor >= 0:
        inside_of(world)[traits_of(world)[a].sensor * bodies + b] = 1
    else:
        inside_of(world)[traits_of(world)[b].sensor * bodies + a] = 1
    x, y = contact_point(world, a, b, now, now_low, normal_x, normal_y)
    return write_event(
        world, hits, count, world_index, BEGIN, now, a, b, normal_x, normal_y, x, y, 0.0
    )


@kernel
def forget_moved(world: WorldView) -> None:
    """Empty the sensors of bodies that the user moved between two steps, and moved sensors."""
    bodies = traits_of(world).shape[0]
    motions, after_step = motions_of(world), motions_after_step_of(world)
    inside = inside_of(world)
    for slot in range(motions.shape[0]):
        if motions[slot].x == after_step[slot].x and motions[slot].y == after_step[slot].y:
            continue
        moved = moving_of(world)[slot]
        own = traits_of(world)[moved].sensor
        for row in range(sensing_of(world).shape[0]):
            inside[row * bodies + moved] = 0
            if row == own:
                inside[row * bodies : (row + 1) * bodies] = 0


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
    here. (Or relaxation moved it out, as the step began.)
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
    inside_of(world)[here.sensor * traits_of(world).shape[0] + body] = 0
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
    bodies = traits_of(world).shape[0]
    for row in range(sensing_of(world).shape[0]):
        if inside_of(world)[row * bodies + body]:
            sensor = sensing_of(world)[row]
            count = leave_sensor(world, hits, count, world_index, sensor, body, now, now_low)
    return count


@kernel
def leave_all_sensors(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """Note which bodies left which sensors in this step; return how many events there are."""
    progress = progress_of(world)
    sensing = sensing_of(world)
    inside = inside_of(world)
    bodies = traits_of(world).shape[0]
    end, end_low = progress.end, progress.end_low
    for row in range(sensing.shape[0]):
        for body in range(bodies):
            if inside[row * bodies + body]:
                if progress.full or not has_room(world, hits, count):
                    return count
                count = leave_sensor(
                    world, hits, count, world_index, sensing[row], body, end, end_low
                )
    return count
