"""What capsules do when they are caught."""

from ...physics.kernels import inlined, inner
from ..rules import (
    BREAK,
    DISRUPT,
    DISRUPT_ANGLE,
    ENLARGE,
    MAX_BALLS,
    PLAYER,
    POWERS,
    SLOW,
    SLOW_STAGES,
    SPEED_STAGE_MIN,
)
from ..state import ABSENT, FLYING, HELD, RulesRecord, WorldRecord
from .ball import heading, set_course
from .paddle import keep_paddle_inside
from .scoring import gain_lives
from .serve import copy_ball, release_ball
from .shapes import LONG_PADDLE_SHAPE, PADDLE_SHAPE


@inner
def take_capsule(world: WorldRecord, rules: RulesRecord, kind: int) -> None:
    """Apply the effect of a caught capsule."""
    if kind <= POWERS:
        set_power(world, rules, kind)
    elif kind == SLOW:
        _slow_balls(world, rules)
    elif kind == DISRUPT:
        _disrupt_ball(world, rules)
    elif kind == BREAK:
        world.exit_open = 1
    elif kind == PLAYER:
        gain_lives(world, 1)


@inner
def set_power(world: WorldRecord, rules: RulesRecord, power: int) -> None:
    """Give the paddle a power (or `NO_POWER`) in place of the one that it has."""
    world.power = power
    if power == ENLARGE:
        world.paddle_half = rules.long_paddle_half
        world.paddle_shape = LONG_PADDLE_SHAPE
    else:
        world.paddle_half = rules.paddle_half
        world.paddle_shape = PADDLE_SHAPE
    keep_paddle_inside(world)


@inlined
def _slow_balls(world: WorldRecord, rules: RulesRecord) -> None:
    """Lower the speed stage by two, at once."""
    world.speed_stage = max(SPEED_STAGE_MIN, world.speed_stage - SLOW_STAGES)
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == FLYING:
            set_course(world, rules, ball, world.ball_vx[ball], world.ball_vy[ball])


@inlined
def _first_ball(world: WorldRecord) -> int:
    """Return the first ball that is there; in a game there always is one."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] != ABSENT:
            return ball
    return 0


@inlined
def _disrupt_ball(world: WorldRecord, rules: RulesRecord) -> None:
    """Split the only ball into three; a ball that lies on the paddle is served first."""
    source = _first_ball(world)
    if world.ball_state[source] == HELD:
        release_ball(world, rules, source)
    sine, cosine = heading(rules, DISRUPT_ANGLE)
    x, y = world.ball_vx[source], world.ball_vy[source]
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == ABSENT:
            copy_ball(world, source, ball)
            set_course(world, rules, ball, x * cosine - y * sine, x * sine + y * cosine)
            sine = -sine
