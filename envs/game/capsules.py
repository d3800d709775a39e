"""Capsules: hidden in coloured bricks, they fall, and the paddle catches them."""

from ...physics.kernels import inlined, inner, kernel
from ...physics.pairs.approach import will_touch
from ...physics.pairs.lattice import cell_centre
from ..rules import (
    BREAK,
    CAPSULE_HEIGHT,
    CAPSULE_POINTS,
    CAPSULE_SPEED,
    CATCH,
    CATCH_WEIGHT,
    DISRUPT,
    DISRUPT_WEIGHT,
    ENLARGE,
    ENLARGE_WEIGHT,
    LASER,
    NO_CAPSULE,
    PADDLE_Y,
    PLAYER,
    RARE_WEIGHT,
    SLOW,
    SLOW_WEIGHT,
)
from ..state import RulesRecord, WorldRecord
from .powers import take_capsule
from .random import uniform
from .scoring import add_score
from .serve import balls_in_play
from .shapes import CAPSULE_SHAPE

# Three draws in four are legal. That so many in a row are not has a chance below 1e-37.
_DRAWS = 64


@inlined
def drop_capsule(world: WorldRecord, rules: RulesRecord, cell: int) -> None:
    """Let a broken brick drop its capsule, unless another one falls or several balls fly."""
    if world.capsule != NO_CAPSULE or balls_in_play(world) != 1:
        return
    if uniform(world) < rules.capsule_rate:
        world.capsule = _draw_capsule(world)
        world.capsule_x, world.capsule_y = cell_centre(rules.lattice[0], cell)


@inlined
def _draw_capsule(world: WorldRecord) -> int:
    """Draw a kind of capsule whose effect the player does not have yet."""
    for _ in range(_DRAWS):
        kind = capsule_by_weight(uniform(world))
        if kind != world.power and (kind != BREAK or world.exit_open == 0):
            return kind
    return SLOW


@kernel
def capsule_by_weight(number: float) -> int:
    """Return the kind of capsule at a number in [0, 1); each kind has its weight's share."""
    if number < RARE_WEIGHT:
        return BREAK
    if number < 2.0 * RARE_WEIGHT:
        return PLAYER
    number = (number - 2.0 * RARE_WEIGHT) / (1.0 - 2.0 * RARE_WEIGHT)
    if number < DISRUPT_WEIGHT:
        return DISRUPT
    if number < DISRUPT_WEIGHT + ENLARGE_WEIGHT:
        return ENLARGE
    if number < DISRUPT_WEIGHT + ENLARGE_WEIGHT + SLOW_WEIGHT:
        return SLOW
    if number < DISRUPT_WEIGHT + ENLARGE_WEIGHT + SLOW_WEIGHT + CATCH_WEIGHT:
        return CATCH
    return LASER


@inlined
def fall_capsule(world: WorldRecord, rules: RulesRecord) -> None:
    """Move the falling capsule by one tick; the paddle may catch it, or it leaves the field."""
    if will_touch(
        rules.shapes,
        rules.edges,
        world.paddle_shape,
        CAPSULE_SHAPE,
        world.capsule_x - world.paddle_x,
        world.capsule_y - PADDLE_Y,
        -world.paddle_vx,
        -CAPSULE_SPEED,
        1.0,
    ):
        kind = world.capsule
        remove_capsule(world)
        world.capsules_caught += 1
        add_score(world, CAPSULE_POINTS)
        take_capsule(world, rules, kind)
        return
    world.capsule_y -= CAPSULE_SPEED
    if world.capsule_y < -0.5 * CAPSULE_HEIGHT:
        remove_capsule(world)


@inner
def remove_capsule(world: WorldRecord) -> None:
    """Remove the falling capsule, if there is one."""
    world.capsule = NO_CAPSULE
    world.capsule_x = 0.0
    world.capsule_y = 0.0
