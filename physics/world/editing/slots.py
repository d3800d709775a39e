"""Slots of moving bodies: given to a body that begins to move, and taken from one that stops.

There are no gaps: when a slot becomes free, the body in the last slot moves there. Nothing but the
order of independent hits at exactly the same time depends on the order of slots.
"""

import math

from ...kernels import kernel
from ..lookup.grid import enter_grid, leave_grid
from ..lookup.neighbours import TOO_MANY
from ..lookup.tree import NO_ONE
from ..plans.suitors import forget_partner, join_suitors
from ..plans.tournament import drop_out, replay, take_part
from ..state.records import (
    FEW_MOVING,
    FREE,
    FRESH,
    MEET,
    NOTHING,
    PLANNED,
    UNPLANNED,
)
from ..state.view import (
    LINKS,
    WorldView,
    boxes_of,
    clock_of,
    entries_of,
    grid_of,
    header_of,
    links_of,
    motions_of,
    moving_of,
    places_of,
    plans_of,
    shown_after_step_of,
    shown_of,
    traits_of,
    winners_of,
)
from .around import is_planned


@kernel
def place_of(world: WorldView, body: int) -> tuple[float, float, float, float]:
    """Return x, y, vx, vy of a body between two steps."""
    trait = traits_of(world)[body]
    if trait.slot == NO_ONE:
        entry = entries_of(world)[body]
        return trait.home_x, trait.home_y, entry.vx, entry.vy
    seen = shown_of(world)[trait.slot]
    return seen.x, seen.y, seen.vx, seen.vy


@kernel
def give_slot(world: WorldView, body: int, x: float, y: float, vx: float, vy: float) -> None:
    """Let a body move, from (x, y) with the velocity (vx, vy); there is room for it."""
    header, clock = header_of(world), clock_of(world)
    slot = header.movers
    header.movers = slot + 1
    traits_of(world)[body].slot = slot
    moving_of(world)[slot] = body
    places_of(world)[slot] = 0
    motion, seen = motions_of(world)[slot], shown_of(world)[slot]
    motion.x, motion.y, motion.vx, motion.vy = x, y, vx, vy
    motion.at, motion.at_low = clock.time, clock.time_low
    motion.speed = abs(vx) + abs(vy)
    motion.fresh, clock.fresh = 1, max(clock.fresh, FRESH)
    seen.x, seen.y, seen.vx, seen.vy = x, y, vx, vy
    shown_after_step_of(world)[slot] = seen
    plan = plans_of(world)[slot]
    plan.time, plan.time_low = math.inf, 0.0
    plan.kind, plan.partner, plan.stage = NOTHING, 0, FREE
    plan.slack = 0.0
    plan.tied = plan.hits = plan.rests = plan.series = plan.nowhere = 0
    plan.suitor = NO_ONE
    plan.is_linked, plan.near, plan.fixed = 0, TOO_MANY, 0
    plan.margin = -1.0  # it is in no box
    if is_planned(world):
        take_part(winners_of(world), plans_of(world), slot)
    if not header.has_grid and header.movers > FEW_MOVING:
        header.has_grid = 1
        grid_of(world).ready = 0
        if clock.planned == PLANNED:
            clock.planned = UNPLANNED


@kernel
def take_slot(world: WorldView, body: int) -> None:
    """Let a body no longer move, which is out of the broad phase."""
    header, trait, plans = header_of(world), traits_of(world)[body], plans_of(world)
    slot, last = trait.slot, header.movers - 1
    trait.slot = NO_ONE
    if slot != last:
        _move(world, last, slot)
    if is_planned(world):
        drop_out(winners_of(world), plans, last)
    header.movers = last


@kernel
def _move(world: WorldView, old: int, new: int) -> None:
    """Move a body from one slot to another, which is free, with all that it plans."""
    plans, boxes, links, moving = (
        plans_of(world),
        boxes_of(world),
        links_of(world),
        moving_of(world),
    )
    was_planned = is_planned(world)
    kind = plans[old].kind
    is_linked = was_planned and plans[old].is_linked
    if was_planned:
        forget_partner(world, old)
    if is_linked:
        leave_grid(world, old)
    shown_of(world)[new] = shown_of(world)[old]
    shown_after_step_of(world)[new] = shown_after_step_of(world)[old]
    motions_of(world)[new] = motions_of(world)[old]
    plans[new] = plans[old]
    boxes[new] = boxes[old]
    for index in range(LINKS):
        links[new * LINKS + index] = links[old * LINKS + index]
    moving[new] = moving[old]
    traits_of(world)[moving[new]].slot = new
    plans[new].kind = kind
    if was_planned and kind == MEET:
        join_suitors(world, new)
    if is_linked:
        enter_grid(world, new)
    if was_planned:
        replay(winners_of(world), plans, new)
