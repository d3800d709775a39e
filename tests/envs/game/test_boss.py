"""The boss: its hits, its shards, and how its round ends."""

import math

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.game.shapes import boss_collider, paddle_collider, shard_collider
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BALL_SPEED,
    BOSS_X,
    BOSS_Y,
    PADDLE_TOP,
    PADDLE_Y,
)
from arkanoid.envs.state import ABSENT, FLYING, HELD
from helpers.fields import keep_ball_flying, union_of_bricks
from helpers.states import writable_state
from shapely import Point, Polygon

NOOP = 0


def make_boss(**keywords):
    """Return an environment of one tick per decision in the boss's round, and its world."""
    env = ArkanoidEnv(**({"frame_skip": 1, "levels": "warden", "capsules": False} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


BOSS = Polygon(np.add(boss_collider().vertices, [BOSS_X, BOSS_Y]))


def test_the_boss_overlaps_no_brick_of_its_round():
    _, world = make_boss()
    assert world.boss_hits == 16
    assert BOSS.distance(union_of_bricks(world)) > 2 * BALL_RADIUS


def test_sixteen_hits_beat_the_boss_and_clear_its_round():
    env, world = make_boss()
    needed = int(world.needed)
    bricks = needed - 16
    world.brick_hits[:] = 0
    world.hits_left = 16
    total = 0.0
    for hit in range(16):
        assert world.boss_hits == 16 - hit
        world.ball_state[0] = FLYING
        world.ball_x[0], world.ball_y[0] = 5.5, 10.0 - 1.45 - BALL_RADIUS - 0.05
        world.ball_vx[0], world.ball_vy[0] = 0.0, BALL_SPEED
        _, reward, _, _, info = env.step(NOOP)
        assert info["hits"] == 1
        total += reward
    assert (info["rounds_cleared"], info["round"]) == (1, 2)
    assert math.isclose(total, 16 / needed + 1.0)
    assert bricks == 39 or bricks > 0
    assert world.boss_hits == 16  # the list of levels begins again


def test_a_ball_bounces_off_the_boss_as_off_its_outline():
    env, world = make_boss(lives=1000)
    world.hits_left = 10**6
    world.boss_hits = 10**5
    world.brick_hits[:] = 0
    met = 0
    rng = np.random.default_rng(0)
    for _ in range(10_000):
        world.idle = 0
        world.shard_wait = 100
        if world.ball_state[0] != FLYING or world.ball_y[0] < 5.0:
            world.ball_state[0] = FLYING
            world.ball_x[0], world.ball_y[0] = rng.uniform(0.2, 10.8), 5.0
            world.ball_vx[0], world.ball_vy[0] = 0.05, math.sqrt(BALL_SPEED**2 - 0.05**2)
        hits = int(world.boss_hits)
        env.step(NOOP)
        met += hits - int(world.boss_hits)
        assert BOSS.distance(Point(world.ball_x[0], world.ball_y[0])) > BALL_RADIUS - 1e-12
    assert met > 50


def test_the_boss_throws_at_the_paddle_every_90_ticks_and_a_shard_that_lands_costs_a_life():
    env, world = make_boss()
    world.paddle_x = 3.0
    thrown = []
    for tick in range(400):
        keep_ball_flying(world)
        world.idle = 0
        before = int(world.shards)
        info = env.step(NOOP)[-1]
        if world.shards > before:
            thrown.append(tick)
            shard = int(np.flatnonzero(world.shard_state)[0])
            aim = (3.0 - BOSS_X, PADDLE_Y - (BOSS_Y - 1.0))
            way = (world.shard_vx[shard], world.shard_vy[shard])
            assert abs(aim[0] * way[1] - aim[1] * way[0]) < 1e-12
            assert math.isclose(math.hypot(*way), 0.08, rel_tol=1e-12)
        if info["lives_lost"]:
            break
    assert thrown[:2] == [89, 179] or thrown == [89]
    assert info["lives"] == 2
    assert world.shards == 0
    assert world.ball_state[0] == HELD
    # When it landed: the way from the boss to the paddle's upper side at 0.08 a tick.
    length = math.hypot(3.0 - BOSS_X, PADDLE_Y - 9.0)
    assert abs((tick - 89) * 0.08 - length) < 0.6


def test_a_shard_that_misses_is_gone():
    env, world = make_boss()
    world.shard_state[0], world.shards = FLYING, 1
    world.shard_x[0], world.shard_y[0], world.shard_vy[0] = 9.0, 1.0, -0.08
    for _ in range(25):
        keep_ball_flying(world)
        info = env.step(NOOP)[-1]
    assert (info["lives"], int(world.shards)) == (3, 0)


@pytest.mark.parametrize("side", [0, 11])
def test_a_shard_ends_at_the_walls(side):
    """One thrown at the paddle in the corner flew on beyond the wall, and was observed there."""
    env, world = make_boss()
    world.shard_state[0], world.shards = FLYING, 1
    world.shard_x[0], world.shard_y[0] = abs(side - 0.1), 1.0
    world.shard_vx[0], world.shard_vy[0] = (side - 5.5) * 0.01, -0.05
    for _ in range(20):
        keep_ball_flying(world)
        assert env.observation_space.contains(env.step(NOOP)[0])
    assert world.shards == 0


def test_a_shard_lands_exactly_if_it_touches_the_moving_paddle():
    env, world = make_boss()
    world.lives = 10**6
    vertices = np.array(shard_collider().vertices)
    paddle = np.array(paddle_collider(2.0).vertices)
    rng = np.random.default_rng(3)
    landed = 0
    for _ in range(2000):
        keep_ball_flying(world)
        world.shard_wait = 100
        x, y = world.paddle_x + rng.uniform(-1.6, 1.6), PADDLE_TOP + rng.uniform(-0.2, 0.4)
        vx = rng.uniform(-0.05, 0.05)
        action = int(rng.integers(3))
        world.shard_state[0], world.shards = FLYING, 1
        world.shard_x[0], world.shard_y[0] = x, y
        world.shard_vx[0], world.shard_vy[0] = vx, -0.07
        move = (0.0, -0.19, 0.19)[action]
        move = min(max(world.paddle_x + move, 1.0), 10.0) - world.paddle_x
        path = Polygon(np.add(vertices, [x, y])).union(
            Polygon(np.add(vertices, [x + vx - move, y - 0.07]))
        )
        swept = path.convex_hull  # of one convex shape moved straight
        gap = swept.intersection(Polygon(np.add(paddle, [world.paddle_x, PADDLE_Y]))).area
        near = swept.distance(Polygon(np.add(paddle, [world.paddle_x, PADDLE_Y])))
        lost = env.step(action)[-1]["lives_lost"]
        if gap > 1e-9 or near > 1e-9:
            assert lost == (gap > 1e-9)
        landed += lost
        remove_all(world)
    assert 300 < landed < 1700


def remove_all(world):
    world.shard_state[:] = ABSENT
    world.shards = 0


def test_where_the_boss_is_no_enemies_come():
    env, world = make_boss()
    for _ in range(700):
        keep_ball_flying(world)
        world.shard_wait = 100
        env.step(NOOP)
    assert world.enemies == 0


def test_a_boss_without_enemies_is_refused():
    with pytest.raises(ValueError, match="'warden' has the boss"):
        ArkanoidEnv(levels=["ripple", "warden"], enemies=False)
