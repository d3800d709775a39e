"""A step of a world: its beginning, its events, its end."""

import math

from ..kernels import kernel
from ..kernels.borrowed import borrowed
from .clock_time import elapsed, later
from .events import forget_moved, leave_all_sensors
from .grid import enter_all
from .impacts import run_events
from .overlaps import relax_overlaps, resolve_overlaps
from .prediction import move_to, predict
from .records import FREE, NOTHING, Block, Blocks, Hit, Hits, Motions
from .tournament import start_tournament
from .view import (
    WorldView,
    clock_of,
    header_of,
    motions_after_step_of,
    motions_of,
    moving_of,
    open_world,
    plans_of,
    progress_of,
    winners_of,
)

# What `step_worlds` returns if a number is not finite.
INVALID = -(1 << 62)

HIT_SIZE = Hit.itemsize


@kernel
def step_worlds(
    states: Blocks, workspace: Block, buffer: Block, count: int, dt: float, steps: int
) -> int:
    """Step every world ``steps`` times by ``dt``; return how many hits are in the buffer.

    If the buffer is full, it stops early and returns -1 - count. Call it again with a larger buffer
    that holds the same hits, and it continues. It returns `INVALID` if a position or velocity of a
    world is not finite, or has become so, or its time.

    Args:
        states: uint8 [worlds, bytes]; workspace: uint8 [bytes], see `records`.
        buffer: uint8 [bytes], room for `Hit` records, of which ``count`` are there already.
        count, dt, steps: see above.
    """
    hits = borrowed(buffer, 0, buffer.shape[0] // HIT_SIZE, Hit)
    for world_index in range(states.shape[0]):
        world = open_world(states[world_index], workspace)
        progress = progress_of(world)
        if world_index < progress.world:
            continue
        progress.world = world_index
        progress.full = 0
        while progress.step < steps:
            if progress.running == 0 and not begin_step(world, dt):
                progress.step = 0
                progress.world = 0
                return INVALID
            progress.running = 1
            if header_of(world).continuous:
                count = run_events(world, hits, count, world_index)
            else:
                count = resolve_overlaps(world, hits, count, world_index)
            count = finish_step(world, hits, count, world_index)
            if progress.full:
                return -1 - count
            progress.running = 0
            progress.step += 1
            if count == INVALID:
                progress.step = 0
                progress.world = 0
                return INVALID
        progress.step = 0
        progress.world = 0
    return count


@kernel
def begin_step(world: WorldView, dt: float) -> bool:
    """Prepare the plans of a step; return False, and do nothing, if a number is not finite.

    Plans from the last step still hold if nobody has written to the motions since.
    """
    clock = clock_of(world)
    progress = progress_of(world)
    progress.end, progress.end_low = later(clock.time, clock.time_low, dt)
    if not abs(progress.end) < math.inf:
        return False
    progress.crowded = 0
    progress.hits = 0
    progress.inert = 0
    if clock.planned and _are_equal(motions_of(world), motions_after_step_of(world)):
        return True
    if not _are_finite(motions_of(world)):
        return False
    if header_of(world).sensors > 0:
        forget_moved(world)
    clock.planned = 0
    _clear_plans(world)
    if header_of(world).continuous:
        enter_all(world)
        _predict_all(world)
        if progress.touching and relax_overlaps(world):
            _predict_all(world)
    else:
        progress.next_slot = 0
        progress.next_near = 0
        _move_all(world)
        enter_all(world)
    return True


@kernel
def _are_equal(motions: Motions, others: Motions) -> bool:
    """Return whether the same bodies have the same positions and velocities."""
    for slot in range(motions.shape[0]):
        motion, other = motions[slot], others[slot]
        if motion.x != other.x or motion.y != other.y:
            return False
        if motion.vx != other.vx or motion.vy != other.vy:
            return False
    return True


@kernel
def _are_finite(motions: Motions) -> bool:
    """Return whether all positions and velocities are finite numbers."""
    for slot in range(motions.shape[0]):
        motion = motions[slot]
        # inf - inf and nan - nan are nan, and differ from 0.
        total = abs(motion.x) + abs(motion.y) + abs(motion.vx) + abs(motion.vy)
        if total - total != 0.0:
            return False
    return True


@kernel
def _clear_plans(world: WorldView) -> None:
    """Let every body plan nothing, and be where its motion says now."""
    clock = clock_of(world)
    plans = plans_of(world)
    for slot in range(plans.shape[0]):
        plan = plans[slot]
        plan.at = clock.time
        plan.at_low = clock.time_low
        plan.speed = abs(motions_of(world)[slot].vx) + abs(motions_of(world)[slot].vy)
        plan.hits = plan.rests = plan.instant = plan.nowhere = 0
        plan.stage = FREE
        plan.time = math.inf
        plan.time_low = 0.0
        plan.slack = 0.0
        plan.tied = 0
        plan.kind = NOTHING


@kernel
def _move_all(world: WorldView) -> None:
    """Move every body to its position at the end of the step."""
    progress = progress_of(world)
    moving = moving_of(world)
    for slot in range(moving.shape[0]):
        move_to(world, moving[slot], progress.end, progress.end_low)


@kernel
def _predict_all(world: WorldView) -> None:
    """Make all plans, at the beginning of a step."""
    clock = clock_of(world)
    progress_of(world).touching = 0
    start_tournament(winners_of(world), plans_of(world))
    for slot in range(plans_of(world).shape[0]):
        predict(world, slot, clock.time, clock.time_low, True)


@kernel
def finish_step(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """Move every body to its position at the end; return how many hits there are.

    It returns `INVALID` if a position or velocity has become too large for a number.
    """
    header, clock, progress = header_of(world), clock_of(world), progress_of(world)
    if header.sensors > 0:
        count = leave_all_sensors(world, hits, count, world_index)
    if progress.full:
        return count
    end, end_low = progress.end, progress.end_low
    clock.time, clock.time_low = end, end_low
    # Plans of bodies that are not free are for this step only.
    clock.planned = header.continuous and not progress.crowded and not progress.inert
    motions, plans = motions_of(world), plans_of(world)
    after_step = motions_after_step_of(world)
    for slot in range(header.movers):
        motion, after, plan = motions[slot], after_step[slot], plans[slot]
        since = elapsed(end, end_low, plan.at, plan.at_low)
        motion.x += motion.vx * since
        motion.y += motion.vy * since
        plan.at, plan.at_low = end, end_low
        plan.hits = plan.rests = plan.instant = plan.nowhere = 0
        plan.stage = FREE
        after.x, after.y, after.vx, after.vy = motion.x, motion.y, motion.vx, motion.vy
    if not _are_finite(motions):
        clock.planned = 0
        return INVALID
    return count
