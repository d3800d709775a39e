"""Bricks: a round's beginning, and what a hit on a brick does."""

from typing import Any

from ..physics.compilation import kernel
from .rules import (
    CELLS,
    COLOUR_POINTS,
    COLOURS,
    EMPTY,
    EXTRA_LIFE_EVERY,
    GOLD,
    SILVER,
    SILVER_POINTS,
    SPEED_STAGE_HITS,
    SPEED_STAGE_MAX,
    UNBREAKABLE,
)


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


@kernel
def lay_bricks(world: Any, level: Any) -> None:
    """Begin the world's round with all bricks of its level."""
    world.needed = 0
    world.bricks_left = 0
    for cell in range(CELLS):
        hits = hits_needed(level.kind[cell], world.round_number)
        world.brick_hits[cell] = hits
        if 0 < hits < UNBREAKABLE:
            world.needed += hits
            world.bricks_left += 1
    world.hits_left = world.needed
    world.lattice_changed = 1


@kernel
def add_score(world: Any, points: int) -> None:
    """Add points, and a life for each threshold that they pass."""
    world.score += points
    if world.score >= world.next_life:
        # No loop: LLVM turns one into a division of 128 bits, which Numba cannot link.
        gained = 1 + (world.score - world.next_life) // EXTRA_LIFE_EVERY
        world.lives += gained
        world.next_life += gained * EXTRA_LIFE_EVERY


@kernel
def hit_brick(world: Any, level: Any, cell: int) -> bool:
    """Hit a brick once; return whether it was damaged (gold is not)."""
    world.hits_since_serve += 1
    stage = world.speed_stage
    for index in range(len(SPEED_STAGE_HITS)):
        if world.hits_since_serve == SPEED_STAGE_HITS[index] and stage < SPEED_STAGE_MAX:
            world.speed_stage = stage + 1
    if world.brick_hits[cell] == UNBREAKABLE:
        return False
    world.brick_hits[cell] -= 1
    world.hits_left -= 1
    world.idle = 0
    world.lattice_changed = 1
    if world.brick_hits[cell] == 0:
        world.bricks_left -= 1
        kind = level.kind[cell]
        if kind == SILVER:
            add_score(world, SILVER_POINTS * world.round_number)
        elif kind <= COLOURS:
            add_score(world, COLOUR_POINTS[kind - 1])
    return True
