"""What goes wrong in other games of this kind, each as a story with its end."""

import math

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.game.shapes import paddle_collider
from arkanoid.envs.rules import BALL_RADIUS, BALL_SPEED, FIELD_WIDTH, PADDLE_TOP, PADDLE_Y
from arkanoid.envs.state import FLYING, HELD
from helpers.states import writable_state
from shapely import Point, Polygon

NOOP, LEFT, RIGHT, FIRE = 0, 1, 2, 3


def make(**keywords):
    """Return an env of one tick a decision, freshly reset, and its world's record."""
    env = ArkanoidEnv(**({"frame_skip": 1, "levels": "ripple"} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def fly(world, x, y, vx, vy):
    """Put the ball into flight."""
    world.ball_state[0] = FLYING
    world.ball_x[0], world.ball_y[0] = x, y
    world.ball_vx[0], world.ball_vy[0] = vx, vy


def below(world):
    """Return the action of a player who follows the ball with the paddle."""
    gap = world.ball_x[0] - world.paddle_x
    return RIGHT if gap > 0.1 else LEFT if gap < -0.1 else NOOP


@pytest.mark.parametrize("actions", ["discrete3", "discrete6", "box"])
@pytest.mark.parametrize("game", [{}, {"capsules": False, "enemies": False}])
def test_a_game_in_which_nobody_fires_does_not_idle(actions, game):
    """In the arcade a ball that nobody serves lies for ever: agents learn to sit still."""
    env = ArkanoidEnv(actions=actions, **game)
    env.reset(seed=0)
    still = np.zeros(2, np.float32) if actions == "box" else NOOP
    decisions, terminated, truncated = 0, False, False
    while not (terminated or truncated):
        _, _, terminated, truncated, _ = env.step(still)
        decisions += 1
    # Three balls and at most 3600 ticks between two bricks: an episode of some minutes.
    assert decisions < 10_000
    assert terminated


@pytest.mark.parametrize("seed", range(4))
def test_a_policy_that_loops_for_ever_through_the_paddle_ends(seed):
    """A deterministic policy and a deterministic deflection repeat a flight without a hit.

    Here the ball goes up and down over the paddle's middle and meets no brick. No random turn
    helps, for the paddle resets that count: after 3600 ticks it costs the last life.
    """
    env, world = make(capsules=False, enemies=False, lives=1)
    env.reset(seed=seed)
    world.brick_hits[:] = 255
    world.brick_hits[0] = 1
    world.brick_hits[11] = 255
    ticks, terminated = 0, False
    fly(world, world.paddle_x + 0.01, 3.0, 0.0, -BALL_SPEED)
    while not terminated:
        world.paddle_x = np.clip(world.ball_x[0], 1.0, FIELD_WIDTH - 1.0)
        _, _, terminated, truncated, _ = env.step(NOOP)
        assert not truncated
        ticks += 1
    assert ticks == 3600


def test_a_ball_caught_between_golden_bricks_is_turned_until_it_gets_out():
    """Two golden walls and the ceiling: a ball that flies level between them would stay."""
    env, world = make(capsules=False, enemies=False)
    world.brick_hits[:] = 0
    for row in range(18):
        world.brick_hits[row * 11 + 4] = world.brick_hits[row * 11 + 6] = 255
    world.brick_hits[5 * 11] = 1
    slope = math.radians(10.0)
    fly(world, 5.5, 9.0, BALL_SPEED * math.cos(slope), BALL_SPEED * math.sin(slope))
    ticks = 0
    while world.ball_y[0] > 3.9:
        world.hits_since_serve = 0
        _, _, _, truncated, _ = env.step(NOOP)
        ticks += 1
        assert not truncated
    assert ticks < 3600


def test_a_ball_locked_in_by_gold_costs_a_life():
    env, world = make(capsules=False, enemies=False)
    world.brick_hits[:] = 255
    world.brick_hits[0] = 1
    world.brick_hits[5 * 11 + 5] = 0
    fly(world, 5.5, 10.25, BALL_SPEED * 0.6, BALL_SPEED * 0.8)
    for _ in range(3599):
        env.step(NOOP)
        assert 5.0 + BALL_RADIUS - 1e-9 < world.ball_x[0] < 6.0 - BALL_RADIUS + 1e-9
        assert 10.0 + BALL_RADIUS - 1e-9 < world.ball_y[0] < 10.5 - BALL_RADIUS + 1e-9
    *_, terminated, truncated, info = env.step(NOOP)
    assert (terminated, truncated, info["lives"], info["lives_lost"]) == (False, False, 2, 1)
    assert world.ball_state[0] == HELD


@pytest.mark.parametrize("reward", ["progress", "score", "sparse"])
def test_nothing_is_paid_for_volleying_or_staying_alive(reward):
    """A reward for each touch teaches to keep the ball in play, not to clear the round."""
    env, world = make(capsules=False, enemies=False, reward=reward)
    touches, total = 0, 0.0
    world.brick_hits[:] = 255
    world.brick_hits[0] = 1
    fly(world, world.paddle_x + 0.01, 3.0, 0.0, -BALL_SPEED)
    upward = False
    for _ in range(2000):
        total += env.step(below(world))[1]
        touches += not upward and world.ball_vy[0] > 0.0
        upward = world.ball_vy[0] > 0.0
    assert touches > 20
    assert total == 0.0


@pytest.mark.parametrize("paddle", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_ball_is_never_left_inside_the_paddle_that_has_moved_into_it(side, paddle):
    """Engines that teleport the paddle swallow a ball beside it, and carry it along."""
    half = paddle
    vertices = np.array(paddle_collider(2.0 * paddle).vertices)
    rng = np.random.default_rng(5)
    for _ in range(150):
        env, world = make(speed=0.05, paddle=paddle, capsules=False, enemies=False)
        world.paddle_x = rng.uniform(half + 0.5, FIELD_WIDTH - half - 0.5)
        x = world.paddle_x + side * (half + rng.uniform(0.13, 0.3))
        fly(world, x, PADDLE_Y + rng.uniform(-0.3, 0.3), rng.uniform(-0.004, 0.004), -0.005)
        carried = 0
        for _ in range(25):
            env.step(RIGHT if side > 0 else LEFT)
            if world.ball_state[0] != FLYING:
                break
            shape = Polygon(np.add(vertices, [world.paddle_x, PADDLE_Y]))
            gap = shape.distance(Point(world.ball_x[0], world.ball_y[0])) - BALL_RADIUS
            assert gap > -1e-12
            carried += gap < 1e-9
        # It is pushed for a moment, and then slips off the pointed end, up or down.
        assert carried <= 12


def test_the_ball_pushed_against_the_wall_by_the_paddle_gets_out():
    env, world = make(speed=0.05, capsules=False, enemies=False)
    world.paddle_x = FIELD_WIDTH - 1.25
    fly(world, FIELD_WIDTH - BALL_RADIUS, PADDLE_Y + 0.01, 0.0, -0.005)
    for _ in range(30):
        env.step(RIGHT)
        if world.ball_state[0] != FLYING:
            break
        shape = Polygon(np.add(paddle_collider(2.0).vertices, [world.paddle_x, PADDLE_Y]))
        gap = shape.distance(Point(world.ball_x[0], world.ball_y[0])) - BALL_RADIUS
        assert gap > -1e-12
        assert world.ball_x[0] <= FIELD_WIDTH - BALL_RADIUS
    assert world.ball_y[0] > PADDLE_TOP or world.ball_y[0] < PADDLE_TOP - 0.25
