"""A step of a world: its beginning, its events, its end."""

import itertools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ...kernels import accessor, inlined, kernel
from ...kernels.borrowed import BYTE, INDEX
from ...kernels.portable.addresses import array_at
from ...tolerances import FARTHEST, MOST_RESTS
from ..lookup.boxes import first_margin, fit_all, fit_here
from ..meetings.events import has_room
from ..meetings.sensors import leave_all_sensors, leave_placed
from ..plans.grounds import find_on_grounds, is_kinematic, plan_beside
from ..plans.prediction import plan_all, predict
from ..plans.suitors import find_stale
from ..state.clock_time import later
from ..state.courses import move_to, place_at
from ..state.records import (
    CRUSHED,
    FREE,
    FRESH,
    GROUND_GONE,
    OLD,
    PLANNED,
    UNPLANNED,
    Block,
    Hit,
    Hits,
    Indices,
    Motions,
)
from ..state.view import (
    WorldView,
    clock_of,
    header_of,
    motions_of,
    moving_of,
    open_world,
    plans_of,
    progress_of,
    shown_after_step_of,
    shown_of,
    stale_of,
)
from .continuous import run_events
from .overlaps import put_in_order, relax_overlaps, resolve_overlaps

# What `step_worlds` returns if a number is not finite.
INVALID = -(1 << 62)
# Where the worlds' blocks begin in a call, and the numbers of each world.
CALL_START, CALL_BLOCKS = 5, 6


def call_of(
    blocks: Sequence[tuple[Block, Block, Block]], hits: Hits, last: Indices | None
) -> npt.NDArray[np.int64]:
    """Return what `step_worlds` needs of worlds: addresses and lengths, int64 [CALL_START + ...].

    The arrays must live as long as it is used.

    Args:
        blocks: of each world: its state, what is inside, and the workspace; each uint8 [bytes].
        hits: the buffer, `Hit` [room].
        last: the same for other arrays, if a step goes on.
    """
    at = [0, 0] if last is None else last[1:3].tolist()
    call = [len(blocks), *at, 0, 0]
    for block in itertools.chain.from_iterable(blocks):
        call += (block.ctypes.data, len(block))
    numbers = np.array(call, np.int64)
    use_hits(numbers, hits)
    return numbers


def use_hits(call: Indices, hits: Hits) -> None:
    """Let a call write its hits into another buffer, `Hit` [room], which holds the same."""
    call[3:CALL_START] = hits.ctypes.data, len(hits)


@accessor
def _block_at(call: Indices, place: int) -> Block:
    """Return the block whose address and length are at a place."""
    return array_at(call[place], (call[place + 1],), BYTE)


@inlined
def _step_world(
    world: WorldView, call: Indices, hits: Hits, count: int, dt: float, steps: int
) -> int:
    """Step one world, from the step on that the call says; return as `step_worlds` does."""
    progress, world_index, done = progress_of(world), call[1], call[2]
    progress.full = 0
    while done < steps:
        call[2] = done
        if progress.running == 0:
            if not has_room(world, hits, count):
                return -1 - count
            count = begin_step(world, hits, count, world_index, dt)
        if count == INVALID:
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
        done += 1
        if count == INVALID:
            return INVALID
    return count


@kernel
def step_worlds(address: int, count: int, dt: float, steps: int) -> int:
    """Step every world ``steps`` times by ``dt``; return how many hits are in the buffer.

    If the buffer or a block of what is inside is full, it stops early and returns -1 - count; the
    second item of the call is the world. Call it again with larger ones that hold the same, and it
    continues. It returns `INVALID` if a position or velocity of a world is not finite or beyond
    `FARTHEST`, or has become so, or its time.

    Args:
        address: where a call begins, see `call_of`: where the worlds are, and how far they are.
            (Each array that Python passes to a kernel would take up to a tenth of a microsecond.)
        count: of the `Hit` records that are in the buffer already.
        dt, steps: see above.
    """
    worlds = array_at(address, (1,), INDEX)[0]
    call = array_at(address, (CALL_START + CALL_BLOCKS * worlds,), INDEX)
    hits = array_at(call[3], (call[4],), Hit)
    while call[1] < call[0]:
        place = CALL_START + CALL_BLOCKS * call[1]
        state, inside = _block_at(call, place), _block_at(call, place + 2)
        count = _step_world(
            open_world(state, inside, _block_at(call, place + 4)), call, hits, count, dt, steps
        )
        if count == INVALID:
            call[1] = call[2] = 0
        if count < 0:
            return count
        call[1] += 1
        call[2] = 0
    call[1] = 0
    return count


@kernel
def begin_step(world: WorldView, hits: Hits, count: int, world_index: int, dt: float) -> int:
    """Prepare the plans of a step; return how many hits there are.

    It returns `INVALID`, and does nothing, if a number is not finite, or too large. Plans from the
    last step still hold, but for the bodies that somebody has moved since.
    """
    clock = clock_of(world)
    progress = progress_of(world)
    progress.end, progress.end_low = later(clock.time, clock.time_low, dt)
    if not abs(progress.end) < math.inf:
        return INVALID
    progress.crowded = 0
    progress.inert = 0
    progress.hits = 0
    is_calm = clock.fresh == OLD and _are_equal(shown_of(world), shown_after_step_of(world))
    if is_calm and clock.planned == PLANNED:
        return count
    if not _are_near(shown_of(world)):
        return INVALID
    _adopt_shown(world)
    if header_of(world).sensors > 0:
        count = leave_placed(world, hits, count, world_index)
    if header_of(world).continuous:
        _plan(world, clock.planned != PLANNED)
        if progress.overlapping and relax_overlaps(world):
            if header_of(world).sensors > 0:
                count = leave_placed(world, hits, count, world_index)
            _plan(world, False)
        clock.planned = PLANNED
        _end_freshness(world)
    else:
        progress.next_body = 0
        progress.next_near = 0
        put_in_order(world)
        _move_all(world)
        fit_all(world, progress.end, progress.end_low)
    return count


@kernel
def _adopt_shown(world: WorldView) -> None:
    """Let every body that a user has moved begin a new course, and be fresh."""
    clock = clock_of(world)
    motions, shown, after_step = motions_of(world), shown_of(world), shown_after_step_of(world)
    for slot in range(motions.shape[0]):
        seen, after = shown[slot], after_step[slot]
        if seen.x != after.x or seen.y != after.y or seen.vx != after.vx or seen.vy != after.vy:
            motion = motions[slot]
            motion.x, motion.y, motion.vx, motion.vy = seen.x, seen.y, seen.vx, seen.vy
            after.x, after.y, after.vx, after.vy = seen.x, seen.y, seen.vx, seen.vy
            motion.at, motion.at_low = clock.time, clock.time_low
            motion.speed = abs(seen.vx) + abs(seen.vy)
            motion.fresh = 1
            clock.fresh = max(clock.fresh, FRESH)


@kernel
def _end_freshness(world: WorldView) -> None:
    """Note that the plans of all bodies hold, unless relaxation has left overlaps."""
    motions = motions_of(world)
    if not progress_of(world).crowded:
        clock_of(world).fresh = OLD
        for slot in range(motions.shape[0]):
            motions[slot].fresh = 0


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
def _are_near(motions: Motions) -> bool:
    """Return whether all positions and velocities are numbers of which one may take the squares."""
    for slot in range(motions.shape[0]):
        motion = motions[slot]
        for number in (motion.x, motion.y, motion.vx, motion.vy):
            if not abs(number) <= FARTHEST:  # nor is nan
                return False
    return True


@kernel
def _move_all(world: WorldView) -> None:
    """Move every body to its position at the end of the step."""
    progress = progress_of(world)
    moving = moving_of(world)
    for slot in range(moving.shape[0]):
        move_to(world, moving[slot], progress.end, progress.end_low)


@kernel
def _plan(world: WorldView, anew: bool) -> None:
    """Make the plans of fresh bodies, and of those that planned to meet them; or all plans."""
    motions = motions_of(world)
    progress_of(world).overlapping = 0
    fresh = 0
    for slot in range(motions.shape[0]):
        fresh += motions[slot].fresh
    if anew or 2 * fresh > motions.shape[0]:
        plan_all(world)
    else:
        _plan_fresh(world)


@kernel
def _plan_fresh(world: WorldView) -> None:
    """Make the plans of fresh bodies, and of those that planned to meet them."""
    clock, motions, stale = clock_of(world), motions_of(world), stale_of(world)
    count, has_new_ground = 0, clock.fresh == GROUND_GONE
    for slot in range(motions.shape[0]):
        if motions[slot].fresh:
            count = find_stale(world, slot, count)
            has_new_ground = has_new_ground or is_kinematic(world, slot)
            fit_here(world, slot, clock.time, clock.time_low, first_margin(world, slot))
    if has_new_ground:
        count = find_on_grounds(world, count)
    for slot in range(motions.shape[0]):
        if motions[slot].fresh:
            predict(world, slot, clock.time, clock.time_low, False)
    for index in range(count):
        if not motions[stale[index]].fresh:
            predict(world, stale[index], clock.time, clock.time_low, False)
    if has_new_ground:
        for slot in range(motions.shape[0]):
            if motions[slot].fresh and is_kinematic(world, slot):
                plan_beside(world, slot, clock.time, clock.time_low)


@kernel
def finish_step(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """Show the position of every body at the end; return how many hits there are.

    It returns `INVALID` if a position or velocity has become too large for a number.
    """
    header, clock, progress = header_of(world), clock_of(world), progress_of(world)
    if header.sensors > 0:
        count = leave_all_sensors(world, hits, count, world_index)
    if progress.full:
        return count
    end, end_low = progress.end, progress.end_low
    motions, plans = motions_of(world), plans_of(world)
    shown, after_step = shown_of(world), shown_after_step_of(world)
    total = 0.0
    for slot in range(header.movers):
        motion, plan, seen, after = motions[slot], plans[slot], shown[slot], after_step[slot]
        vx, vy = motion.vx, motion.vy
        x, y = place_at(motion, end, end_low)
        if not header.continuous:
            motion.x, motion.y = x, y
            motion.at, motion.at_low = end, end_low
        if not header.continuous or plan.stage >= CRUSHED or plan.rests >= MOST_RESTS:
            # What it passes by in this step, it hits in the next one.
            motion.fresh = 1
            clock.fresh = max(clock.fresh, FRESH)
        plan.hits = plan.rests = plan.series = plan.nowhere = 0
        plan.stage = FREE
        seen.x, seen.y, seen.vx, seen.vy = x, y, vx, vy
        after.x, after.y, after.vx, after.vy = x, y, vx, vy
        total += abs(x) + abs(y) + abs(vx) + abs(vy)
    clock.time, clock.time_low = end, end_low
    if not total <= FARTHEST and not _are_near(shown):
        clock.planned = UNPLANNED
        return INVALID
    return count
