"""The game: an episode, a decision, and a tick as a list of phases."""

from typing import Any

from ..physics.compilation import kernel
from .ball import direction, set_course
from .bricks import lay_bricks
from .flight import fly_ball, free_ball
from .paddle import move_paddle, steer_paddle
from .random import random_sign, uniform, uniform_between
from .rules import (
    BALL_RADIUS,
    EXTRA_LIFE_FIRST,
    FIELD_WIDTH,
    IDLE_TICKS,
    MAX_BALLS,
    PADDLE_TOP,
    PROGRESS,
    SCORE,
    SERVE_ANGLE_MAX,
    SERVE_ANGLE_MIN,
    SERVE_TICKS,
)
from .state import ABSENT, DECISION_LIMIT, FLYING, HELD, IDLE, NOT_TRUNCATED


@kernel
def begin_episode(world: Any, rules: Any, levels: Any) -> None:
    """Start a new game; of the world's past only its generator goes on."""
    world.done = 0
    world.decisions = 0
    world.idle = 0
    world.score = 0
    world.lives = rules.lives
    world.next_life = EXTRA_LIFE_FIRST
    world.round_number = 1
    world.capped = 0
    world.paddle_x = FIELD_WIDTH / 2
    world.paddle_vx = 0.0
    world.move = 0.0
    world.fire = 0.0
    _begin_round(world, levels)


@kernel
def _begin_round(world: Any, levels: Any) -> None:
    """Lay the bricks of the world's round, and a ball on the paddle."""
    world.level = (world.round_number - 1) % levels.shape[0]
    lay_bricks(world, levels[world.level])
    _lay_ball(world)


@kernel
def _lay_ball(world: Any) -> None:
    """Lay one ball on the paddle's middle, and take every other ball away."""
    for ball in range(MAX_BALLS):
        world.ball_state[ball] = ABSENT
        world.ball_x[ball] = 0.0
        world.ball_y[ball] = 0.0
        world.ball_vx[ball] = 0.0
        world.ball_vy[ball] = 0.0
        world.ball_offset[ball] = 0.0
        world.ball_bounces[ball] = 0
    world.ball_state[0] = HELD
    world.held_ticks = 0
    world.hits_since_serve = 0
    world.speed_stage = 0
    _carry_balls(world)


@kernel
def _carry_balls(world: Any) -> None:
    """Keep held balls where they lie on the paddle."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == HELD:
            world.ball_x[ball] = world.paddle_x + world.ball_offset[ball]
            world.ball_y[ball] = PADDLE_TOP + BALL_RADIUS


@kernel
def decide(world: Any, rules: Any, levels: Any, move: float, fire: float, outcome: Any) -> None:
    """Play one decision of `frame_skip` ticks, fewer if the episode ends, into the outcome.

    Args:
        move: velocity command in [-1, 1], as a part of the paddle's speed; fire: 1.0 or 0.0.
    """
    if rules.sticky_action > 0.0 and uniform(world) < rules.sticky_action:
        move, fire = world.move, world.fire
    world.move = move
    world.fire = fire
    outcome.reward = 0.0
    outcome.hits = 0
    outcome.terminated = False
    outcome.truncation = NOT_TRUNCATED
    for _ in range(rules.frame_skip):
        _reward_tick(world, rules, levels, outcome)
        if outcome.terminated or outcome.truncation != NOT_TRUNCATED:
            break
    world.decisions += 1
    if world.decisions >= rules.max_decisions:
        outcome.truncation = DECISION_LIMIT
    outcome.truncated = outcome.truncation != NOT_TRUNCATED
    world.done = 1 if outcome.terminated or outcome.truncated else 0


@kernel
def _reward_tick(world: Any, rules: Any, levels: Any, outcome: Any) -> None:
    """Play one tick, and add what it pays to the outcome."""
    score, lives, hits = world.score, world.lives, world.hits_left
    _tick(world, rules, levels)
    hits -= world.hits_left
    cleared = world.hits_left == 0
    outcome.hits += hits
    if rules.reward == PROGRESS:
        outcome.reward += hits / world.needed + (1.0 if cleared else 0.0)
    elif rules.reward == SCORE:
        outcome.reward += (world.score - score) / 1000.0
    else:
        outcome.reward += 1.0 if cleared else 0.0
    if world.lives < lives:
        outcome.reward -= rules.life_penalty
    if world.lives == 0:
        outcome.terminated = True
    elif world.idle >= IDLE_TICKS:
        outcome.truncation = IDLE
    if cleared:
        world.round_number += 1
        _begin_round(world, levels)


@kernel
def _tick(world: Any, rules: Any, levels: Any) -> None:
    """Play one tick of 1/60 s."""
    world.idle += 1
    steer_paddle(world, rules)
    _serve(world, rules)
    _fly_balls(world, rules, levels)
    move_paddle(world)
    _free_balls(world, rules)
    _carry_balls(world)
    _lose_balls(world)


@kernel
def _serve(world: Any, rules: Any) -> None:
    """Serve the held balls on fire, or when they have lain long enough."""
    held = False
    for ball in range(MAX_BALLS):
        held = held or world.ball_state[ball] == HELD
    if not held:
        return
    world.held_ticks += 1
    if world.fire == 0.0 and world.held_ticks < SERVE_TICKS:
        return
    world.held_ticks = 0
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == HELD:
            world.ball_state[ball] = FLYING
            sine, cosine = direction(
                rules, uniform_between(world, SERVE_ANGLE_MIN, SERVE_ANGLE_MAX)
            )
            set_course(world, rules, ball, sine * random_sign(world), cosine)


@kernel
def _fly_balls(world: Any, rules: Any, levels: Any) -> None:
    """Move the flying balls by one tick."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == FLYING and world.hits_left > 0:
            fly_ball(world, rules, levels[world.level], ball)


@kernel
def _free_balls(world: Any, rules: Any) -> None:
    """Relax the flying balls that the paddle was moved into."""
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == FLYING:
            free_ball(world, rules, ball)


@kernel
def _lose_balls(world: Any) -> None:
    """Take away the balls below the field; the last one costs a life, and a new one is laid."""
    left = 0
    lost = 0
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == FLYING and world.ball_y[ball] < 0.0:
            world.ball_state[ball] = ABSENT
            lost += 1
        left += world.ball_state[ball] != ABSENT
    if lost > 0 and left == 0:
        world.lives -= 1
        if world.lives > 0:
            _lay_ball(world)
