"""Balls that lie on the paddle, to be served or caught by it, and how they leave it."""

from ...physics.kernels import inlined, inner, kernel
from ..rules import (
    BALL_RADIUS,
    CATCH_TICKS,
    MAX_BALLS,
    PADDLE_TOP,
    SERVE_ANGLE_MAX,
    SERVE_ANGLE_MIN,
    SERVE_TICKS,
)
from ..state import ABSENT, FLYING, HELD, RulesRecord, WorldRecord
from .ball import deflection, heading, set_course
from .random import random_sign, uniform_between


@inner
def balls_in_play(world: WorldRecord) -> int:
    """Return how many balls there are."""
    count = 0
    for ball in range(MAX_BALLS):
        count += world.ball_state[ball] != ABSENT
    return count


@inner
def remove_ball(world: WorldRecord, ball: int) -> None:
    """Remove a ball."""
    world.ball_state[ball] = ABSENT
    world.ball_x[ball] = 0.0
    world.ball_y[ball] = 0.0
    world.ball_vx[ball] = 0.0
    world.ball_vy[ball] = 0.0
    world.ball_offset[ball] = 0.0
    world.ball_release[ball] = 0
    world.ball_caught[ball] = 0
    world.ball_bounces[ball] = 0


@inner
def copy_ball(world: WorldRecord, source: int, ball: int) -> None:
    """Make a flying ball where another one flies."""
    remove_ball(world, ball)
    world.ball_state[ball] = FLYING
    world.ball_x[ball] = world.ball_x[source]
    world.ball_y[ball] = world.ball_y[source]


@inner
def lay_ball(world: WorldRecord) -> None:
    """Lay one ball on the paddle's middle, and remove all others."""
    for ball in range(MAX_BALLS):
        remove_ball(world, ball)
    world.ball_state[0] = HELD
    world.ball_release[0] = SERVE_TICKS
    world.hits_since_serve = 0
    world.speed_stage = 0
    carry_balls(world)


@inlined
def catch_ball(world: WorldRecord, ball: int, paddle_x: float) -> None:
    """Let a ball that has landed on the paddle (its middle at paddle_x) stick there."""
    offset = world.ball_x[ball] - paddle_x
    remove_ball(world, ball)
    world.ball_state[ball] = HELD
    world.ball_release[ball] = CATCH_TICKS
    world.ball_caught[ball] = 1
    # Not so far out that the ball leaves the field when the paddle is at the wall.
    furthest = world.paddle_half - BALL_RADIUS
    world.ball_offset[ball] = max(-furthest, min(furthest, offset))
    world.ball_x[ball] = paddle_x + world.ball_offset[ball]
    world.ball_y[ball] = PADDLE_TOP + BALL_RADIUS


@kernel
def carry_balls(world: WorldRecord) -> None:
    """Keep held balls where they lie on the paddle."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == HELD:
            world.ball_x[ball] = world.paddle_x + world.ball_offset[ball]
            world.ball_y[ball] = PADDLE_TOP + BALL_RADIUS


@inlined
def release_balls(world: WorldRecord, rules: RulesRecord) -> None:
    """Release the held balls if the player fires, or if they have lain long enough."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == HELD:
            world.ball_release[ball] -= 1
            if world.fire > 0.0 or world.ball_release[ball] <= 0:
                release_ball(world, rules, ball)


@inner
def release_ball(world: WorldRecord, rules: RulesRecord, ball: int) -> None:
    """Serve a held ball; if it was caught, its place on the paddle gives its direction."""
    if world.ball_caught[ball] == 1:
        x, y = deflection(world, rules, world.ball_offset[ball], random_sign(world))
    else:
        x, y = heading(rules, uniform_between(world, SERVE_ANGLE_MIN, SERVE_ANGLE_MAX))
        x *= random_sign(world)
    world.ball_state[ball] = FLYING
    world.ball_release[ball] = 0
    world.ball_caught[ball] = 0
    world.ball_bounces[ball] = 0
    set_course(world, rules, ball, x, y)
