"""The rules of the game, each against its closed form."""

import hashlib
import math
import os
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.game.shapes import paddle_collider
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BALL_SPEED,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    PADDLE_TOP,
    PADDLE_Y,
)
from arkanoid.envs.state import FLYING, HELD
from helpers.processes import INTERPRETED, run_program
from helpers.repository import TESTS
from helpers.states import portable_bytes, writable_state
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point, Polygon, box, union_all

NOOP, LEFT, RIGHT, FIRE = 0, 1, 2, 3


PLAIN = {"levels": "ripple", "capsules": False, "enemies": False}


def make(**keywords):
    """Return an env of one tick a decision, freshly reset, and its world's record."""
    env = ArkanoidEnv(**({"frame_skip": 1} | PLAIN | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def fly(world, x, y, vx, vy):
    """Put the ball into flight."""
    world.ball_state[0] = FLYING
    world.ball_x[0], world.ball_y[0] = x, y
    world.ball_vx[0], world.ball_vy[0] = vx, vy


def speed_of(world):
    return math.hypot(world.ball_vx[0], world.ball_vy[0])


def bricks_of(world):
    """Return the union of the world's bricks."""
    return union_of_cells(tuple(np.flatnonzero(world.brick_hits).tolist()))


@cache
def union_of_cells(cells):
    places = [divmod(cell, 11) for cell in cells]
    return union_all([box(c, 12.5 - r / 2, c + 1, 13 - r / 2) for r, c in places])


def paddle_of(world):
    return Polygon(np.add(paddle_collider(2.0).vertices, [world.paddle_x, PADDLE_Y]))


def test_the_ball_serves_itself_after_sixty_ticks():
    env, world = make(actions="discrete3")
    for tick in range(60):
        assert world.ball_state[0] == HELD, tick
        env.step(NOOP)
    assert world.ball_state[0] == FLYING


def test_fire_serves_to_a_seeded_side_at_20_to_40_degrees():
    angles = []
    for seed in range(200):
        env, world = make()
        env.reset(seed=seed)
        env.step(FIRE)
        assert math.isclose(speed_of(world), BALL_SPEED, rel_tol=1e-12)
        angles.append(math.degrees(math.atan2(world.ball_vx[0], world.ball_vy[0])))
    assert all(20 - 1e-3 <= abs(angle) <= 40 + 1e-3 for angle in angles)
    assert 60 < sum(angle > 0 for angle in angles) < 140
    assert max(map(abs, angles)) - min(map(abs, angles)) > 18


def test_a_held_ball_goes_with_the_paddle_and_the_paddle_stops_at_the_wall():
    env, world = make(actions="discrete3")
    for _ in range(40):
        env.step(LEFT)
        assert world.ball_x[0] == world.paddle_x
        assert world.ball_y[0] == PADDLE_TOP + BALL_RADIUS
    assert world.paddle_x == 1.0
    for _ in range(70):
        env.step(RIGHT)
    assert world.paddle_x == FIELD_WIDTH - 1.0


@pytest.mark.parametrize("u", [-1.0, -0.6, -0.25, 0.0, 0.25, 0.5, 0.9])
@pytest.mark.parametrize("vx", [-0.1, 0.1])
def test_deflection_by_where_the_ball_lands(u, vx):
    """10° + 53°·|u| from the vertical to the side of u; u = 0 keeps the side it came with."""
    env, world = make()
    vy = -math.sqrt(BALL_SPEED**2 - vx**2)
    fly(world, world.paddle_x + u, PADDLE_TOP + BALL_RADIUS, 0.0, vy)
    # Straight down first, so that the ball lands where it is; then with the side it comes with.
    world.ball_vx[0] = vx if u == 0.0 else 0.0
    env.step(NOOP)
    angle = math.degrees(math.atan2(world.ball_vx[0], world.ball_vy[0]))
    side = math.copysign(1.0, u if u else vx)
    assert math.isclose(angle, side * (10 + 53 * abs(u)), abs_tol=0.01)
    assert math.isclose(speed_of(world), BALL_SPEED, rel_tol=1e-12)


def test_six_zones():
    angles = set()
    for x in np.linspace(-0.99, 0.99, 37):
        env, world = make(deflection="zones6")
        fly(world, world.paddle_x + x, PADDLE_TOP + BALL_RADIUS, 0.0, -BALL_SPEED)
        env.step(NOOP)
        angles.add(round(math.degrees(math.atan2(world.ball_vx[0], world.ball_vy[0])), 3))
    assert angles == {-63.0, -40.0, -15.0, 15.0, 40.0, 63.0}


def test_physical_deflection_is_the_mirror():
    env, world = make(deflection="physical")
    fly(
        world, world.paddle_x + 0.3, PADDLE_TOP + BALL_RADIUS, 0.1, -math.sqrt(BALL_SPEED**2 - 0.01)
    )
    env.step(NOOP)
    assert math.isclose(world.ball_vx[0], 0.1, rel_tol=1e-12)
    assert world.ball_vy[0] > 0.0


def test_the_ball_bounces_off_the_walls_at_the_exact_time():
    env, world = make()
    fly(world, 0.2, 8.0, -0.15, 0.092)
    world.brick_hits[:] = 0
    world.brick_hits[0] = 1
    speed = math.hypot(0.15, 0.092)
    vx, vy = -0.15 * BALL_SPEED / speed, 0.092 * BALL_SPEED / speed
    world.ball_vx[0], world.ball_vy[0] = vx, vy
    env.step(NOOP)
    assert math.isclose(world.ball_x[0], BALL_RADIUS + (-vx - (0.2 - BALL_RADIUS)), rel_tol=1e-12)
    assert math.isclose(world.ball_y[0], 8.0 + vy, rel_tol=1e-12)


def test_the_ceiling_raises_the_speed_stage_to_one():
    env, world = make()
    world.brick_hits[:] = 0
    world.brick_hits[-1] = 1
    fly(world, 5.0, 13.8, 0.0, BALL_SPEED)
    env.step(NOOP)
    assert world.speed_stage == 1
    assert math.isclose(speed_of(world), BALL_SPEED * 1.25, rel_tol=1e-12)


def test_the_speed_stage_rises_with_brick_hits_since_the_serve():
    env, world = make(lives=1)
    stages = {}
    for hits in range(1, 170):
        world.brick_hits[:] = 255
        world.brick_hits[0] = 1
        fly(world, 5.5, 4.0 - BALL_RADIUS, 0.0, speed_of(world) or BALL_SPEED)
        world.idle = 0
        world.ball_bounces[0] = 0
        env.step(NOOP)
        assert world.hits_since_serve == hits
        stages[hits] = int(world.speed_stage)
    expected = [sum(h >= t for t in (30, 55, 80, 105, 130, 150, 165)) for h in stages]
    assert list(stages.values()) == expected


def test_scores_rewards_and_the_next_round():
    """A round's rewards add up to 2: one for all needed hits, one for clearing it."""
    env, world = make()
    total = 0.0
    needed = int(world.needed)
    for cell in np.flatnonzero(world.brick_hits):
        row, column = divmod(int(cell), 11)
        left = np.array(world.brick_hits)
        world.brick_hits[:] = 0  # nothing in the way
        world.brick_hits[cell] = left[cell]
        fly(world, column + 0.5, 12.5 - row / 2 - BALL_RADIUS, 0.0, BALL_SPEED)
        _, reward, _, _, info = env.step(NOOP)
        assert info["hits"] == 1
        total += reward
        if info["round"] == 1:
            left[cell] = 0
            world.brick_hits[:] = left
    assert math.isclose(total, 2.0, rel_tol=1e-12)
    assert info["round"] == 2
    assert world.bricks_left == needed
    assert world.ball_state[0] == HELD
    # Ripple's bricks by the points of their colours.
    points = dict(zip("wocgrbmy", range(50, 121, 10), strict=False))
    from arkanoid.envs.levels import load_level

    kinds = load_level("ripple").kinds
    assert info["score"] == sum(points["wocgrbmy"[kind - 1]] for kind in kinds[kinds > 0])


@pytest.mark.parametrize(("reward", "expected"), [("score", 0.05), ("sparse", 0.0)])
def test_other_rewards(reward, expected):
    env, world = make(reward=reward)
    cell = int(np.flatnonzero(np.array(world.brick_hits))[0])
    row, column = divmod(cell, 11)
    world.brick_hits[:] = 0
    world.brick_hits[cell] = 1
    fly(world, column + 0.5, 12.5 - row / 2 - BALL_RADIUS, 0.0, BALL_SPEED)
    assert math.isclose(env.step(NOOP)[1], expected, abs_tol=1e-12)


def test_silver_takes_two_hits_and_gold_none(tmp_path):
    level = tmp_path / "metal.txt"
    level.write_text("SX.........\n")
    env, world = make(levels=[str(level)])
    assert world.needed == 2
    for column, hits in [(1, 0), (0, 1), (1, 0), (0, 1)]:
        fly(world, column + 0.5, 12.5 - BALL_RADIUS, 0.0, BALL_SPEED)
        _, reward, _, _, info = env.step(NOOP)
        assert info["hits"] == hits
        assert world.brick_hits[1] == 255
    assert info["score"] == 50  # times round one
    assert math.isclose(reward, 1.5)


def test_extra_lives():
    """They came at 20 000, 80 000, 140 000 and so on: 60 000 after the first."""
    env, world = make()
    gains = [(19_990, 4), (59_940, 4), (59_990, 5), (79_990, 5), (119_990, 6), (179_990, 7)]
    for score, lives in gains:
        world.score = score
        world.kind[0] = 1  # 50 points
        world.brick_hits[:] = 0
        world.brick_hits[0] = 1
        world.brick_hits[-1] = 1
        fly(world, 0.5, 12.5 - BALL_RADIUS, 0.0, BALL_SPEED)
        env.step(NOOP)
        assert world.lives == lives


@pytest.mark.parametrize(
    ("score", "thresholds"), [(59_000, 1), (60_000, 2), (250_000, 5), (2_999_990, 50)]
)
def test_points_that_pass_several_thresholds_give_a_life_for_each(score, thresholds):
    """At 20 000, and at every multiple of 60 000."""
    env, world = make()
    world.score = score - 50
    world.brick_hits[:] = 0
    world.brick_hits[[0, -1]] = 1
    world.kind[0] = 1
    fly(world, 0.5, 12.5 - BALL_RADIUS, 0.0, BALL_SPEED)
    env.step(NOOP)
    assert world.score == score
    assert world.lives == 3 + thresholds
    assert world.next_life == (score // 60_000 + 1) * 60_000


def test_losing_balls_ends_the_game_and_keeps_the_bricks():
    env, world = make(lives=2, life_penalty=0.25)
    world.brick_hits[5] = 0
    before = np.array(world.brick_hits)
    fly(world, 0.5, 0.1, 0.0, -BALL_SPEED)
    _, reward, terminated, _, info = env.step(NOOP)
    assert (reward, terminated, info["lives"]) == (-0.25, False, 1)
    assert (before == world.brick_hits).all()
    assert world.ball_state[0] == HELD
    fly(world, 0.5, 0.1, 0.0, -BALL_SPEED)
    _, reward, terminated, truncated, info = env.step(NOOP)
    assert (reward, terminated, truncated, info["lives"]) == (-0.25, True, False, 0)


def test_doing_nothing_ends_the_episode():
    env = ArkanoidEnv(actions="discrete3")
    env.reset(seed=0)
    for step in range(27_000):  # noqa: B007
        _, _, terminated, truncated, _ = env.step(NOOP)
        if terminated or truncated:
            break
    assert step < 10_000


def test_the_limit_of_decisions_truncates_and_says_why():
    env, _ = make(max_decisions=1)
    *_, terminated, truncated, info = env.step(NOOP)
    assert (terminated, truncated, info["truncation"]) == (False, True, 1)


def test_an_endless_loop_is_broken():
    """A ball between the walls would fly to and fro for ever; after 64 bounces it is turned."""
    env, world = make(lives=1)
    slope = math.radians(12)
    fly(world, 5.0, 3.0, BALL_SPEED * math.cos(slope), 0.0)
    world.ball_vy[0] = BALL_SPEED * math.sin(slope)
    world.ball_bounces[0] = 63
    before = world.ball_vy[0]
    while world.ball_bounces[0] == 63:
        env.step(NOOP)
        assert world.idle < 3600
    assert world.ball_bounces[0] == 0
    assert abs(world.ball_vy[0] - before) > 0.01


@settings(max_examples=30, deadline=None)
@given(
    st.integers(0, 2**32), st.sampled_from([0.3, 1.0, 2.5, 7.0]), st.sampled_from([0.5, 1.0, 2.0])
)
def test_the_ball_is_never_in_a_wall_a_brick_or_the_paddle(seed, speed, paddle):
    env, _ = make(speed=speed, paddle=paddle, lives=100)
    env.reset(seed=seed)
    world = env.state
    actions = np.random.default_rng(seed)
    vertices = np.array(paddle_collider(2.0 * paddle).vertices)
    for step in range(400):
        if step % 8 == 0:
            action = int(actions.integers(6))
        env.step(action)
        if world.ball_state[0] != FLYING:
            continue
        centre = Point(world.ball_x[0], world.ball_y[0])
        assert BALL_RADIUS - 1e-12 <= centre.x <= FIELD_WIDTH - BALL_RADIUS + 1e-12
        assert centre.y <= FIELD_HEIGHT - BALL_RADIUS + 1e-12
        if centre.y > 3.0:
            assert bricks_of(world).distance(centre) > BALL_RADIUS - 1e-12
        stage = 1 + world.speed_stage / 4
        assert math.isclose(speed_of(world), BALL_SPEED * speed * stage, rel_tol=1e-12)
        assert abs(world.ball_vy[0]) >= math.sin(math.radians(10)) * speed_of(world) * (1 - 1e-12)
        shape = Polygon(np.add(vertices, [world.paddle_x, PADDLE_Y]))
        assert shape.distance(centre) > BALL_RADIUS - 1e-12


@pytest.mark.parametrize("speed", [1e2, 1e4, 1e6])
def test_a_ball_at_absurd_speed_never_leaves_the_field(speed):
    env = ArkanoidVectorEnv(16, speed=speed, lives=1000, frame_skip=1)
    env.reset(seed=0)
    env.action_space.seed(0)
    worlds = env.state
    for _ in range(300):
        env.step(env.action_space.sample())
        x, y = worlds["ball_x"][:, 0], worlds["ball_y"][:, 0]
        assert (x >= BALL_RADIUS - 1e-9).all()
        assert (x <= FIELD_WIDTH - BALL_RADIUS + 1e-9).all()
        assert (y <= FIELD_HEIGHT - BALL_RADIUS + 1e-9).all()


@pytest.mark.parametrize("side", [-1, 1])
def test_the_paddle_that_moves_into_a_ball_pushes_it_out(side):
    """A ball beside the paddle was swallowed by engines that move the paddle by teleporting it."""
    env, world = make(speed=0.01)
    world.paddle_x = 5.5
    fly(world, 5.5 + side * 1.2, PADDLE_Y + 0.01, 0.0, -0.00176)
    for _ in range(60):
        env.step(RIGHT if side > 0 else LEFT)
        if world.ball_state[0] != FLYING:
            break
        gap = paddle_of(world).distance(Point(world.ball_x[0], world.ball_y[0])) - BALL_RADIUS
        assert gap > -1e-12
        assert BALL_RADIUS <= world.ball_x[0] <= FIELD_WIDTH - BALL_RADIUS


def play_hash(steps):
    """Return a digest of all bits of a few random games."""
    env = ArkanoidVectorEnv(4, lives=2, max_decisions=200, sticky_action=0.1, speed=2.0)
    digest = hashlib.sha256(env.reset(seed=11)[0].tobytes())
    actions = np.random.default_rng(1).integers(0, 6, (steps, 4))
    for row in actions:
        observations, rewards, *_ = env.step(row)
        digest.update(observations.tobytes() + rewards.tobytes())
    digest.update(portable_bytes(env.state))
    return digest.hexdigest()


def test_interpreted_and_compiled_give_the_same_bits():
    program = "import test_game; print(test_game.play_hash(300))"
    paths = os.pathsep.join([str(TESTS), str(Path(__file__).parent)])
    changes = INTERPRETED | {"PYTHONPATH": paths}
    result = run_program(program, warnings="default", changes=changes)
    assert result.stdout.strip() == play_hash(300)
