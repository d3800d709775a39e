"""Bricks: a round's beginning, and what a hit on a brick does."""

from typing import Any

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
from .capsules import drop_capsule
from .scoring import add_score, count_damage


@kernel
def hits_needed(kind: int, round_number: int) -> int:
    """Return how many hits a brick of a kind takes in a round (`UNBREAKABLE`: no number does)."""
    if kind == EMPTY:
        return 0
    if kind == GOLD:
        return UNBREAKABLE
    if kind == SILVER:
        return min(2 + (round_number - 1) // 8, UNBREAKABLE - 1)
    return 1


@inlined
def lay_bricks(world: Any) -> None:
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
    world.lattice_changed = 1


@inner
def hit_brick(world: Any, rules: Any, cell: int) -> bool:
    """Hit a brick once; return whether it was damaged (gold is not)."""
    if world.brick_hits[cell] == UNBREAKABLE:
        return False
    world.brick_hits[cell] -= 1
    world.lattice_changed = 1
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
