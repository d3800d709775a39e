"""Bricks: a round's beginning, and what a hit on a brick does."""

from ...physics.kernels import inlined, inner, kernel
from ..rules import (
    CELLS,
    COLOUR_POINTS,
    COLOURS,
    EMPTY,
    GOLD,
    SILVER,
    SILVER_POINTS,
    UNBREAKABLE,
)
from ..state import LAST_CHANGE, MAX_CHANGES, RulesRecord, WorldRecord
from .capsules import drop_capsule
from .scoring import add_score, count_damage


@kernel
def hits_needed(kind: int, round_number: int) -> int:
    """Return how many hits break a brick of a kind in a round; `UNBREAKABLE` if none do."""
    if kind == EMPTY:
        return 0
    if kind == GOLD:
        return UNBREAKABLE
    if kind == SILVER:
        return min(2 + (round_number - 1) // 8, UNBREAKABLE - 1)
    return 1


@inlined
def _count_changes(world: WorldRecord, changes: int) -> None:
    """Count changes of bricks, for those who show them."""
    world.brick_changes = (world.brick_changes + changes) & LAST_CHANGE


@inlined
def lay_bricks(world: WorldRecord) -> None:
    """Lay all bricks of the world's layout, and count the hits that they need."""
    world.needed = 0
    world.bricks_left = 0
    for cell in range(CELLS):
        hits = hits_needed(world.kind[cell], world.round_number)
        world.brick_hits[cell] = hits
        if 0 < hits < UNBREAKABLE:
            world.needed += hits
            world.bricks_left += 1
    world.hits_left = world.needed
    _count_changes(world, MAX_CHANGES + 1)  # all bricks: more than are remembered


@inner
def hit_brick(world: WorldRecord, rules: RulesRecord, cell: int) -> bool:
    """Hit a brick once; return whether it was damaged (gold is not)."""
    if world.brick_hits[cell] == UNBREAKABLE:
        return False
    world.brick_hits[cell] -= 1
    _count_changes(world, 1)
    world.changed_cells[world.brick_changes % MAX_CHANGES] = cell
    count_damage(world)
    if world.brick_hits[cell] == 0:
        world.bricks_left -= 1
        world.bricks_broken += 1
        kind = world.kind[cell]
        if kind == SILVER:
            add_score(world, SILVER_POINTS * world.round_number)
        elif kind <= COLOURS:
            add_score(world, COLOUR_POINTS[kind - 1])
            if rules.capsule_rate > 0.0:
                drop_capsule(world, rules, cell)
    return True
