"""What a ball does when it meets something: its speed, its course, the paddle's deflection."""

import math

from ...physics.kernels import inlined, inner, kernel
from ...physics.pairs.response import reflect
from ..rules import (
    DEFLECTION_MIN,
    DEFLECTION_RANGE,
    FLAT_ANGLE,
    LOOP_BOUNCES,
    LOOP_TURN_MAX,
    LOOP_TURN_MIN,
    PHYSICAL,
    SPEED_STAGE_HITS,
    SPEED_STAGE_MAX,
    ZONE_ANGLES,
    ZONES6,
)
from ..state import MOST_TICKS, RulesRecord, WorldRecord
from .random import random_sign, uniform_between

_FLAT = int(FLAT_ANGLE)


@inner
def ball_speed(world: WorldRecord, rules: RulesRecord) -> float:
    """Return the speed of the world's balls, per tick."""
    return float(rules.ball_speed * (1.0 + 0.25 * world.speed_stage))


@kernel
def heading(rules: RulesRecord, degrees: float) -> tuple[float, float]:
    """Return (sine, cosine) of an angle in [0, 90] degrees, from a table: off by up to 4e-5."""
    index = int(degrees)
    part = degrees - index
    x = rules.sine[index] * (1.0 - part) + rules.sine[index + 1] * part
    y = rules.cosine[index] * (1.0 - part) + rules.cosine[index + 1] * part
    length = math.sqrt(x * x + y * y)
    return x / length, y / length


@inner
def set_course(world: WorldRecord, rules: RulesRecord, ball: int, x: float, y: float) -> None:
    """Send a ball along (x, y) != 0 at the rules' speed, and not flatter than the rules allow."""
    length = math.sqrt(x * x + y * y)
    x /= length
    y /= length
    if abs(y) < rules.cosine[90 - _FLAT]:
        x = rules.sine[90 - _FLAT] if x > 0.0 else -rules.sine[90 - _FLAT]
        y = rules.cosine[90 - _FLAT] if y > 0.0 else -rules.cosine[90 - _FLAT]
    speed = ball_speed(world, rules)
    world.ball_vx[ball] = x * speed
    world.ball_vy[ball] = y * speed


@inlined
def count_hit(world: WorldRecord) -> None:
    """Count a ball's hit on a brick; after certain numbers of hits all balls fly faster."""
    world.hits_since_serve = min(world.hits_since_serve + 1, MOST_TICKS)
    for index in range(len(SPEED_STAGE_HITS)):
        if world.hits_since_serve == SPEED_STAGE_HITS[index]:
            world.speed_stage = min(world.speed_stage + 1, SPEED_STAGE_MAX)


@inner
def bounce_ball(
    world: WorldRecord,
    rules: RulesRecord,
    ball: int,
    normal_x: float,
    normal_y: float,
    damaged: bool,
) -> None:
    """Bounce a ball off something at rest; turn it if it is caught in an endless loop."""
    x, y = reflect(world.ball_vx[ball], world.ball_vy[ball], normal_x, normal_y, 1.0)
    world.ball_bounces[ball] = 0 if damaged else world.ball_bounces[ball] + 1
    if world.ball_bounces[ball] >= LOOP_BOUNCES:
        world.ball_bounces[ball] = 0
        x, y = _turn(world, rules, x, y, normal_x, normal_y)
    set_course(world, rules, ball, x, y)


@inlined
def _turn(
    world: WorldRecord, rules: RulesRecord, x: float, y: float, normal_x: float, normal_y: float
) -> tuple[float, float]:
    """Turn (x, y) by a random angle to a random side, but not back to what the ball has hit."""
    sine, cosine = heading(rules, uniform_between(world, LOOP_TURN_MIN, LOOP_TURN_MAX))
    sine *= random_sign(world)
    turned_x, turned_y = x * cosine - y * sine, x * sine + y * cosine
    if turned_x * normal_x + turned_y * normal_y <= 0.0:
        turned_x, turned_y = x * cosine + y * sine, -x * sine + y * cosine
    return turned_x, turned_y


@inlined
def deflect_ball(
    world: WorldRecord,
    rules: RulesRecord,
    ball: int,
    paddle_x: float,
    normal_x: float,
    normal_y: float,
) -> bool:
    """Send a ball off the paddle; return whether it now moves away from the paddle.

    It does not if the paddle overtakes a slower ball. The normal points from paddle to ball.
    """
    world.ball_bounces[ball] = 0
    if rules.deflection == PHYSICAL or normal_y <= 0.0:
        x, y = reflect(
            world.ball_vx[ball] - world.paddle_vx, world.ball_vy[ball], normal_x, normal_y, 1.0
        )
        set_course(world, rules, ball, x + world.paddle_vx, y)
    else:
        x, y = deflection(world, rules, world.ball_x[ball] - paddle_x, world.ball_vx[ball])
        set_course(world, rules, ball, x, y)
    if not _recedes(world, ball, normal_x, normal_y):
        set_course(world, rules, ball, normal_x, normal_y)
    return _recedes(world, ball, normal_x, normal_y)


@kernel
def deflection(
    world: WorldRecord, rules: RulesRecord, offset: float, velocity_x: float
) -> tuple[float, float]:
    """Return the unit direction in which a ball leaves the paddle's upper side, by where it lands.

    Args:
        offset: of the ball from the paddle's middle; velocity_x: of the arriving ball.
    """
    u = max(-1.0, min(1.0, offset / world.paddle_half))
    if rules.deflection == ZONES6:
        degrees = ZONE_ANGLES[min(int((1.0 - u) * 3.0), 5)]
        side = 1.0 if degrees > 0.0 else -1.0
        degrees = abs(degrees)
    else:
        degrees = DEFLECTION_MIN + DEFLECTION_RANGE * abs(u)
        side = 1.0 if u > 0.0 or (u == 0.0 and velocity_x >= 0.0) else -1.0
    sine, cosine = heading(rules, degrees)
    return side * sine, cosine


@inner
def _recedes(world: WorldRecord, ball: int, normal_x: float, normal_y: float) -> bool:
    """Tell whether a ball moves away from the paddle along the normal."""
    return bool(
        (world.ball_vx[ball] - world.paddle_vx) * normal_x + world.ball_vy[ball] * normal_y > 0.0
    )
