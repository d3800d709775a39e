"""Where a body may be for a while: a box with room to move, whose corner it will not turn unseen.

A moving body's box in the grid is larger than the body by a *margin* on all sides. While it stays
inside, the grid need not change; that it leaves its box is an event like any other. So bodies are
followed wherever they go. The margin suits the body's size, and becomes smaller in a crowd. It
grows each time that a body leaves its box again within a step, so that no speed takes many boxes.
It has no influence on any result.
"""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ...kernels import kernel
from ...shapes.records import ShapeRecord
from ...tolerances import TOUCH
from ..state.courses import place_at
from ..state.records import FEW_MOVING, ON, PLANNED, Block, PlanRecord
from ..state.view import (
    WorldView,
    clock_of,
    entries_of,
    grid_of,
    header_of,
    motions_of,
    moving_of,
    open_world,
    plans_of,
    shapes_of,
    shown_of,
    static_nodes_of,
    static_tree_of,
    traits_of,
)
from .grid import clear_grid
from .links import move_box
from .neighbours import TOO_MANY
from .tree import NO_ONE, clear_tree, insert_leaf

# The margin, in units of the body's size, of the median of all sizes, and of the bodies' distance.
OWN_SHARE = 1.1
TYPICAL_SHARE = 1.2
SPACING_SHARE = 0.33
# A body that may meet more than so many moving ones gets a smaller margin. One that may meet fewer,
# and few that are fixed, gets a larger one. All are between these shares of the first one.
CROWDED = 8
LONELY = 1
FEW_FIXED = 3
LEAST_SHARE = 0.1
MOST_SHARE = 8.0
# A box is ahead of the body by this share of the margin, so that the body is in it for longer.
AHEAD = 0.75
# It is at least this fraction of the coordinates: far from the origin, smaller steps are rounding.
# A box is larger than the body and the margin by this fraction of all that made it. So the boxes
# of bodies that touch overlap, and a point at a seam finds both bodies, whatever rounding says.
FAR = 1e-9
ROUNDING = 4.0 * TOUCH


def spacing(traits: npt.NDArray[Any]) -> float:
    """Return how far bodies are apart, about where half of them are; 0 for a few or in a row."""
    if len(traits) < FEW_MOVING:
        return 0.0
    positions = np.column_stack([traits["home_x"], traits["home_y"]])
    low, high = np.quantile(positions, (0.25, 0.75), axis=0)
    width, height = 2.0 * (high - low)
    return float(np.sqrt(width * height / len(positions)))


@kernel
def typical_margin(typical: float, apart: float) -> float:
    """Return the margin of the first box of a body of typical size.

    Args:
        typical: the size.
        apart: how far the bodies are from each other.
    """
    return float(typical * max(TYPICAL_SHARE, min(MOST_SHARE, SPACING_SHARE * apart / typical)))


@kernel
def typical_width(typical: float, margin: float) -> float:
    """Return the width of the box of a body of typical size."""
    return float(2.0 * (typical + max(OWN_SHARE * typical, margin)))


@kernel
def _reach(shape: ShapeRecord) -> float:
    """Return how far a shape reaches from its origin along the axes."""
    return float(max(max(-shape.lower_x, shape.upper_x), max(-shape.lower_y, shape.upper_y)))


@kernel
def first_margin(world: WorldView, slot: int) -> float:
    """Return the margin of a body about which nothing else is known; inf if it has no bounds."""
    trait = traits_of(world)[moving_of(world)[slot]]
    if trait.boundless:
        return math.inf
    reach = _reach(shapes_of(world)[trait.collider])
    return float(max(OWN_SHARE * reach, header_of(world).margin))


@kernel
def next_margin(world: WorldView, slot: int) -> float:
    """Return the margin of the next box of a body that leaves one."""
    plan = plans_of(world)[slot]
    is_crowded = _is_crowded(plan)
    margin: float = plan.margin
    if plan.fitted >= clock_of(world).time:  # the second one in this step
        return margin * (1.1 if is_crowded else 2.0)
    first = first_margin(world, slot)
    if is_crowded:
        margin *= 0.75
    elif plan.near < plan.fixed + LONELY and plan.fixed < FEW_FIXED:
        margin *= 1.25
    return max(LEAST_SHARE * first, min(MOST_SHARE * first, margin))


@kernel
def margin_after_hit(world: WorldView, slot: int) -> float:
    """Return the margin that a body should have after a hit: a smaller one, or what it has."""
    plan = plans_of(world)[slot]
    margin: float = plan.margin
    if _is_crowded(plan):
        return max(min(margin, LEAST_SHARE * first_margin(world, slot)), 0.6 * margin)
    return margin


@kernel
def _is_crowded(plan: PlanRecord) -> bool:
    """Return whether a body may meet many others before it leaves its box."""
    return bool(plan.near > plan.fixed + CROWDED or plan.near == TOO_MANY)


@kernel
def fit(world: WorldView, slot: int, x: float, y: float, margin: float) -> None:
    """Put a body's box about the place (x, y), where it is now, or rather ahead of it."""
    plan, motion = plans_of(world)[slot], motions_of(world)[slot]
    shape = shapes_of(world)[traits_of(world)[moving_of(world)[slot]].collider]
    margin = max(margin, FAR * (abs(x) + abs(y)))
    fastest = max(abs(motion.vx), abs(motion.vy))
    if 0.0 < fastest < math.inf and margin < math.inf:
        x += AHEAD * margin * (motion.vx / fastest)
        y += AHEAD * margin * (motion.vy / fastest)
    plan.margin = margin
    plan.middle_x, plan.middle_y = x, y
    plan.fitted = clock_of(world).time
    room = margin + ROUNDING * (abs(x) + abs(y) + _reach(shape) + margin)
    move_box(
        world,
        slot,
        (x + shape.lower_x) - room,
        (y + shape.lower_y) - room,
        (x + shape.upper_x) + room,
        (y + shape.upper_y) + room,
    )


@kernel
def fit_here(world: WorldView, slot: int, now: float, now_low: float, margin: float) -> None:
    """Put a body's box about the place where it is at a time."""
    x, y = place_at(motions_of(world)[slot], now, now_low)
    fit(world, slot, x, y, margin)


@kernel
def fit_all(world: WorldView, now: float, now_low: float) -> None:
    """Make the boxes and the grid of all moving bodies, where they are at a time."""
    header, plans = header_of(world), plans_of(world)
    if header.has_grid:
        clear_grid(world)
    for slot in range(plans.shape[0]):
        plans[slot].is_linked = 0
        plans[slot].near = TOO_MANY
    for slot in range(plans.shape[0]):
        fit_here(world, slot, now, now_low, first_margin(world, slot))
    grid_of(world).ready = 1


@kernel
def is_astray(world: WorldView, slot: int) -> bool:
    """Return whether a user has put a body out of its box since the last step."""
    plan, seen = plans_of(world)[slot], shown_of(world)[slot]
    return not (
        abs(seen.x - plan.middle_x) <= plan.margin and abs(seen.y - plan.middle_y) <= plan.margin
    )


@kernel
def fit_shown(world: WorldView) -> None:
    """Prepare all boxes for queries: only bodies that users have moved since may be astray.

    If the next step makes all boxes anyway, none is. Else a plan may depend on where a box is.
    """
    clock = clock_of(world)
    if not header_of(world).has_grid:
        return
    if grid_of(world).ready == 0:
        fit_all(world, clock.time, clock.time_low)
    if clock.planned == PLANNED:
        return
    shown = shown_of(world)
    for slot in range(shown.shape[0]):
        if is_astray(world, slot):
            fit(world, slot, shown[slot].x, shown[slot].y, first_margin(world, slot))


@kernel
def follow(world: WorldView, slot: int, x: float, y: float) -> None:
    """Fit a body's box again if the place (x, y) is no longer inside."""
    plan = plans_of(world)[slot]
    if not (abs(x - plan.middle_x) <= plan.margin and abs(y - plan.middle_y) <= plan.margin):
        fit(world, slot, x, y, first_margin(world, slot))


@kernel
def time_to_leave(plan: PlanRecord, x: float, y: float, vx: float, vy: float) -> float:
    """Return in how long a body at (x, y) leaves its box."""
    return min(
        _time_to_pass(x - plan.middle_x, vx, plan.margin),
        _time_to_pass(y - plan.middle_y, vy, plan.margin),
    )


@kernel
def _time_to_pass(offset: float, velocity: float, margin: float) -> float:
    if margin == math.inf:  # and the offset may be no number
        return math.inf
    if velocity > 0.0:
        return max(0.0, (margin - offset) / velocity)
    if velocity < 0.0:
        return max(0.0, (margin + offset) / -velocity)
    return math.inf


@kernel
def enter_static(world: WorldView, body: int) -> None:
    """Put a static body that has bounds into the tree."""
    trait, node = traits_of(world)[body], static_nodes_of(world)[body]
    shape = shapes_of(world)[trait.collider]
    room = ROUNDING * (abs(trait.home_x) + abs(trait.home_y) + _reach(shape))
    node.lower_x = (trait.home_x + shape.lower_x) - room
    node.lower_y = (trait.home_y + shape.lower_y) - room
    node.upper_x = (trait.home_x + shape.upper_x) + room
    node.upper_y = (trait.home_y + shape.upper_y) + room
    insert_leaf(static_tree_of(world), static_nodes_of(world), body)


@kernel
def enter_all_static(workspace: Block) -> None:
    """Put all static bodies that have bounds into their tree, in order."""
    world = open_world(workspace, workspace, workspace)
    traits, entries = traits_of(world), entries_of(world)
    clear_tree(static_tree_of(world), static_nodes_of(world))
    for body in range(traits.shape[0]):
        trait = traits[body]
        if entries[body].state == ON and trait.slot == NO_ONE and not trait.boundless:
            enter_static(world, body)
