"""A ball's flight from impact to impact, each at its exact time: in a tick, or to its landing."""

import math

from ...physics.kernels import inlined, inner
from ...physics.pairs.approach import approach_between
from ...physics.pairs.disc_half_plane import sweep_disc_half_plane
from ...physics.pairs.lattice import sweep_disc_lattice
from ...physics.pairs.table import contact_between, may_touch
from ..rules import (
    BALL_RADIUS,
    CATCH,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    HITS_PER_TICK,
    MAX_BALLS,
    PADDLE_TOP,
    PADDLE_Y,
)
from ..state import FLYING, HELD, MOST_TICKS, RulesRecord, WorldRecord, Worlds
from .ball import bounce_ball, count_hit, deflect_ball
from .boss import hit_boss, meet_boss
from .bricks import hit_brick
from .enemies import destroy_enemy, meet_enemies
from .serve import catch_ball
from .shapes import BALL_SHAPE, BOSS, BRICK, CEILING, ENEMY, NOTHING, PADDLE, WALL

# A ball squeezed between paddle and wall moves up or down along the paddle's slanted end. Each
# round halves the overlap, so that nothing is left of it in the end.
FREEING_ROUNDS = 64

# A ball whose middle is here touches the paddle's upper side.
LANDING_HEIGHT = PADDLE_TOP + BALL_RADIUS
# A ball that meets more than this is followed no further: behind a wall of bricks it may take long.
LANDING_IMPACTS = 64


@inlined
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


@inlined
def _meet_paddle(
    world: WorldRecord, rules: RulesRecord, ball: int, paddle_x: float, duration: float
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) of a ball's impact on the moving paddle; inf if none."""
    return approach_between(
        rules.shapes,
        rules.edges,
        world.paddle_shape,
        BALL_SHAPE,
        world.ball_x[ball] - paddle_x,
        world.ball_y[ball] - PADDLE_Y,
        world.ball_vx[ball] - world.paddle_vx,
        world.ball_vy[ball],
        duration,
    )


@inner
def _meet_resting(
    world: WorldRecord, rules: RulesRecord, ball: int, duration: float
) -> tuple[float, float, float, int, int]:
    """Return (time, normal_x, normal_y, what, index) of what a ball meets first of all that rests.

    The normal points from what is met to the ball. If nothing is met, the time is inf and what is
    `NOTHING`. The index is the brick's cell. The duration is in ticks, as many as you like.
    """
    x, y = world.ball_x[ball], world.ball_y[ball]
    vx, vy = world.ball_vx[ball], world.ball_vy[ball]
    time, normal_x, normal_y, what, index = math.inf, 0.0, 0.0, NOTHING, -1

    met, hit_x = _meet_side_wall(x, vx, duration)
    if met < time:
        time, normal_x, normal_y, what = met, hit_x, 0.0, WALL
    if vy > 0.0:
        met, hit_x, hit_y = sweep_disc_half_plane(
            BALL_RADIUS, 0.0, -1.0, -FIELD_HEIGHT, 0.0, -y, 0.0, -vy, duration
        )
        if met < time:
            time, normal_x, normal_y, what = met, 0.0, -1.0, CEILING

    met, hit_x, hit_y, hit_index = sweep_disc_lattice(
        rules.lattice[0], world.brick_hits, x, y, vx, vy, BALL_RADIUS, min(duration, time)
    )
    if met < time:
        time, normal_x, normal_y, what, index = met, hit_x, hit_y, BRICK, hit_index
    if world.boss_hits > 0:
        met, hit_x, hit_y = meet_boss(rules, BALL_SHAPE, x, y, vx, vy, min(duration, time))
        if met < time:
            time, normal_x, normal_y, what = met, hit_x, hit_y, BOSS
    return time, normal_x, normal_y, what, index


@inlined
def _first_impact(
    world: WorldRecord, rules: RulesRecord, ball: int, duration: float, paddle_counts: bool
) -> tuple[float, float, float, int, int]:
    """Return (time, normal_x, normal_y, what, index) of what a ball meets first of everything.

    As of `_meet_resting`; the index is the brick's cell, or the enemy.

    Args:
        duration: the rest of the tick; paddle_counts: whether the ball can meet the paddle.
    """
    elapsed = 1.0 - duration
    x, y = world.ball_x[ball], world.ball_y[ball]
    vx, vy = world.ball_vx[ball], world.ball_vy[ball]
    time, normal_x, normal_y, what, index = _meet_resting(world, rules, ball, duration)
    if paddle_counts:
        paddle_x = world.paddle_x + world.paddle_vx * elapsed
        met, hit_x, hit_y = _meet_paddle(world, rules, ball, paddle_x, min(duration, time))
        if met < time:
            time, normal_x, normal_y, what = met, hit_x, hit_y, PADDLE
    if world.enemies > 0:
        met, hit_x, hit_y, hit_index = meet_enemies(
            world, rules, BALL_SHAPE, x, y, vx, vy, elapsed, min(duration, time)
        )
        if met < time:
            time, normal_x, normal_y, what, index = met, hit_x, hit_y, ENEMY, hit_index
    return time, normal_x, normal_y, what, index


@inlined
def fly_balls(world: WorldRecord, rules: RulesRecord) -> None:
    """Move the flying balls by one tick; once the round is cleared, nothing moves."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == FLYING and world.cleared == 0:
            fly_ball(world, rules, ball)


@inner
def fly_ball(world: WorldRecord, rules: RulesRecord, ball: int) -> None:
    """Move a flying ball by one tick, through all that it meets."""
    remaining = 1.0
    paddle_counts = True
    for _ in range(HITS_PER_TICK):
        time, normal_x, normal_y, what, index = _first_impact(
            world, rules, ball, remaining, paddle_counts
        )
        time = min(time, remaining)
        world.ball_x[ball] += world.ball_vx[ball] * time
        world.ball_y[ball] += world.ball_vy[ball] * time
        remaining -= time
        if what == NOTHING:
            return
        if what == PADDLE:
            paddle_x = world.paddle_x + world.paddle_vx * (1.0 - remaining)
            if world.power == CATCH and normal_y > 0.0:
                catch_ball(world, ball, paddle_x)
                return
            paddle_counts = deflect_ball(world, rules, ball, paddle_x, normal_x, normal_y)
            continue
        damaged = _strike(world, rules, what, index)
        bounce_ball(world, rules, ball, normal_x, normal_y, damaged)
        if world.cleared == 1:
            return
    world.capped = min(world.capped + 1, MOST_TICKS)


@inlined
def _strike(world: WorldRecord, rules: RulesRecord, what: int, index: int) -> bool:
    """Apply a ball's hit on anything but the paddle; return whether it has done damage."""
    if what == BRICK:
        count_hit(world)
        return hit_brick(world, rules, index)
    if what == BOSS:
        hit_boss(world)
        return True
    if what == ENEMY:
        destroy_enemy(world, index)
    elif what == CEILING:
        world.speed_stage = max(world.speed_stage, 1)
    return False


@inlined
def free_balls(world: WorldRecord, rules: RulesRecord) -> None:
    """Push the flying balls out of the paddle, where it has moved into them."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == FLYING:
            free_ball(world, rules, ball)


@inlined
def free_ball(world: WorldRecord, rules: RulesRecord, ball: int) -> None:
    """Push a ball out of the paddle, where it has moved into the ball."""
    for _ in range(FREEING_ROUNDS):
        x, y = world.ball_x[ball] - world.paddle_x, world.ball_y[ball] - PADDLE_Y
        if not may_touch(rules.shapes, world.paddle_shape, BALL_SHAPE, x, y, 0.0, 0.0, 0.0):
            return
        found, normal_x, normal_y, depth, _px, _py = contact_between(
            rules.shapes, rules.edges, world.paddle_shape, BALL_SHAPE, x, y
        )
        if not found:
            return
        world.ball_x[ball] += normal_x * depth
        world.ball_y[ball] += normal_y * depth
        # Whatever the paddle does, the ball stays between the walls.
        if world.ball_x[ball] < BALL_RADIUS:
            world.ball_x[ball] = BALL_RADIUS
        elif world.ball_x[ball] > FIELD_WIDTH - BALL_RADIUS:
            world.ball_x[ball] = FIELD_WIDTH - BALL_RADIUS
        else:
            return


@inner
def find_landing(
    world: WorldRecord, rules: RulesRecord, ball: int, scratch: Worlds
) -> tuple[bool, float, float]:
    """Return (found, x, ticks): where a ball comes down to the paddle's height, and when.

    It flies as in the game, among walls, bricks and the boss as they stand, and breaks bricks on
    its way. The paddle, enemies and other balls do nothing. A held ball is there already. Nothing
    is found for a ball that is absent, falls below the paddle's upper side, clears the round, or
    has more than `LANDING_IMPACTS` impacts.

    Args:
        scratch: `World` [1], to be overwritten.
    """
    if world.ball_state[ball] == HELD:
        return True, world.ball_x[ball], 0.0
    if world.ball_state[ball] != FLYING:
        return False, 0.0, 0.0
    scratch[0] = world
    found, ticks = _fly_down(scratch[0], rules, ball)
    return found, scratch[0].ball_x[ball], ticks


@inner
def _fly_down(world: WorldRecord, rules: RulesRecord, ball: int) -> tuple[bool, float]:
    """Fly a ball down to the paddle's height; return whether it arrives, and its ticks."""
    ticks = 0.0
    for _ in range(LANDING_IMPACTS + 1):
        vy = world.ball_vy[ball]
        if vy < 0.0:
            duration = (world.ball_y[ball] - LANDING_HEIGHT) / -vy
        elif vy > 0.0:
            duration = FIELD_HEIGHT / vy  # it meets the ceiling before
        else:
            return False, 0.0
        if duration < 0.0:
            return False, 0.0
        time, normal_x, normal_y, what, index = _meet_resting(world, rules, ball, duration)
        time = min(time, duration)
        world.ball_x[ball] += world.ball_vx[ball] * time
        world.ball_y[ball] += vy * time
        ticks += time
        if what == NOTHING:
            return vy < 0.0, ticks
        damaged = _strike(world, rules, what, index)
        bounce_ball(world, rules, ball, normal_x, normal_y, damaged)
        if world.cleared == 1:
            return False, 0.0
    return False, 0.0
