"""Points and lives."""

from ...physics.kernels import inner
from ..rules import EXTRA_LIFE_EVERY
from ..state import MOST, MOST_TICKS, WorldRecord


@inner
def gain_lives(world: WorldRecord, lives: int) -> None:
    """Add lives."""
    world.lives = min(world.lives + lives, MOST)
    world.lives_gained = min(world.lives_gained + lives, MOST_TICKS)


@inner
def add_score(world: WorldRecord, points: int) -> None:
    """Add points, and a life for each threshold that the score passes."""
    world.score = min(world.score + points, MOST)
    if world.score >= world.next_life:
        # No loop: LLVM turns one into a division of 128 bits, which Numba cannot link.
        multiples = world.score // EXTRA_LIFE_EVERY  # that the score has reached
        gain_lives(world, 1 + multiples - world.next_life // EXTRA_LIFE_EVERY)
        world.next_life = (multiples + 1) * EXTRA_LIFE_EVERY


@inner
def count_damage(world: WorldRecord) -> None:
    """Count one of the hits that clear the round."""
    world.hits_left -= 1
    world.idle = 0
    if world.hits_left == 0:
        world.cleared = 1
