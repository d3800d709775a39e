"""A ball's flight through one tick: from impact to impact, each at its exact time."""

import math
from typing import Any

from ..physics.compilation import kernel
from ..physics.disc_half_plane import sweep_disc_half_plane
from ..physics.dispatch import contact_between, impact_between, may_touch
from ..physics.lattice import sweep_disc_lattice
from .ball import bounce_ball, deflect_ball
from .bricks import hit_brick
from .rules import (
    BALL_RADIUS,
    BALL_SHAPE,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    HITS_PER_TICK,
    PADDLE_SHAPE,
    PADDLE_Y,
)

# What a ball meets.
NOTHING = 0
WALL = 1
CEILING = 2
BRICK = 3
PADDLE = 4

# Freeing a ball squeezed between paddle and wall moves it up or down along the paddle's slanted
# end, each time by half the rest: after so many times nothing is left of any overlap.
FREEING_ROUNDS = 64


@kernel
def _meet_side_wall(x: float, vx: float, duration: float) -> tuple[float, float]:
    """Return (time, normal_x) of a ball's impact on the side wall that it flies towards."""
    if vx == 0.0:
        return math.inf, 0.0
    # A wall's outward normal points into the field.
    normal_x, offset = (1.0, 0.0) if vx < 0.0 else (-1.0, -FIELD_WIDTH)
    time, _, _ = sweep_disc_half_plane(
        BALL_RADIUS, normal_x, 0.0, offset, -x, 0.0, -vx, 0.0, duration
    )
    return time, normal_x


@kernel
def _meet_paddle(
    world: Any, rules: Any, ball: int, paddle_x: float, duration: float
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) of a ball's impact on the moving paddle; inf if none."""
    x, y = world.ball_x[ball] - paddle_x, world.ball_y[ball] - PADDLE_Y
    vx, vy = world.ball_vx[ball] - world.paddle_vx, world.ball_vy[ball]
    if not may_touch(rules.shapes, PADDLE_SHAPE, BALL_SHAPE, x, y, vx, vy, duration):
        return math.inf, 0.0, 0.0
    time, normal_x, normal_y = impact_between(
        rules.shapes, rules.edges, PADDLE_SHAPE, BALL_SHAPE, x, y, vx, vy, duration
    )
    # What overlaps by a rounding error and recedes is no impact.
    if vx * normal_x + vy * normal_y >= 0.0:
        return math.inf, 0.0, 0.0
    return time, normal_x, normal_y


@kernel
def _first_impact(
    world: Any, rules: Any, ball: int, paddle_x: float, duration: float, paddle_counts: bool
) -> tuple[float, float, float, int, int]:
    """Return (time, normal_x, normal_y, what, cell) of what a ball meets first.

    The normal points from what is met to the ball; time is inf and what `NOTHING` if it is free.
    """
    x, y = world.ball_x[ball], world.ball_y[ball]
    vx, vy = world.ball_vx[ball], world.ball_vy[ball]
    time, normal_x, normal_y, what, cell = math.inf, 0.0, 0.0, NOTHING, -1

    met, hit_x = _meet_side_wall(x, vx, duration)
    if met < time:
        time, normal_x, normal_y, what = met, hit_x, 0.0, WALL
    if vy > 0.0:
        met, hit_x, hit_y = sweep_disc_half_plane(
            BALL_RADIUS, 0.0, -1.0, -FIELD_HEIGHT, 0.0, -y, 0.0, -vy, duration
        )
        if met < time:
            time, normal_x, normal_y, what = met, 0.0, -1.0, CEILING

    met, hit_x, hit_y, hit_cell = sweep_disc_lattice(
        rules.lattice[0], world.brick_hits, x, y, vx, vy, BALL_RADIUS, min(duration, time)
    )
    if met < time:
        time, normal_x, normal_y, what, cell = met, hit_x, hit_y, BRICK, hit_cell

    if paddle_counts:
        met, hit_x, hit_y = _meet_paddle(world, rules, ball, paddle_x, min(duration, time))
        if met < time:
            time, normal_x, normal_y, what = met, hit_x, hit_y, PADDLE
    return time, normal_x, normal_y, what, cell


@kernel
def fly_ball(world: Any, rules: Any, level: Any, ball: int) -> None:
    """Move a flying ball by one tick, through all that it meets."""
    remaining = 1.0
    paddle_counts = True
    for _ in range(HITS_PER_TICK):
        paddle_x = world.paddle_x + world.paddle_vx * (1.0 - remaining)
        time, normal_x, normal_y, what, cell = _first_impact(
            world, rules, ball, paddle_x, remaining, paddle_counts
        )
        time = min(time, remaining)
        world.ball_x[ball] += world.ball_vx[ball] * time
        world.ball_y[ball] += world.ball_vy[ball] * time
        remaining -= time
        if what == NOTHING:
            return
        if what == PADDLE:
            paddle_counts = deflect_ball(
                world, rules, ball, paddle_x + world.paddle_vx * time, normal_x, normal_y
            )
            continue
        damaged = what == BRICK and hit_brick(world, level, cell)
        if what == CEILING and world.speed_stage < 1:
            world.speed_stage = 1
        bounce_ball(world, rules, ball, normal_x, normal_y, damaged)
        if world.hits_left == 0:
            return
    world.capped += 1


@kernel
def free_ball(world: Any, rules: Any, ball: int) -> None:
    """Relax a ball that overlaps the paddle, for the paddle was moved into it."""
    for _ in range(FREEING_ROUNDS):
        x, y = world.ball_x[ball] - world.paddle_x, world.ball_y[ball] - PADDLE_Y
        if not may_touch(rules.shapes, PADDLE_SHAPE, BALL_SHAPE, x, y, 0.0, 0.0, 0.0):
            return
        found, normal_x, normal_y, depth, _px, _py = contact_between(
            rules.shapes, rules.edges, PADDLE_SHAPE, BALL_SHAPE, x, y
        )
        if not found:
            return
        world.ball_x[ball] += normal_x * depth
        world.ball_y[ball] += normal_y * depth
        # The wall is the stronger one.
        if world.ball_x[ball] < BALL_RADIUS:
            world.ball_x[ball] = BALL_RADIUS
        elif world.ball_x[ball] > FIELD_WIDTH - BALL_RADIUS:
            world.ball_x[ball] = FIELD_WIDTH - BALL_RADIUS
        else:
            return
