"""Enemies: where they come from, what bars them, and what ends them."""

import math

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.game.shapes import (
    enemy_colliders,
)
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BALL_SPEED,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GATE_X,
    PADDLE_Y,
)
from arkanoid.envs.state import ABSENT, CIRCLING, DIVING, DRIFTING, ENTERING, FLYING, HELD
from helpers.fields import keep_ball_flying, union_of_bricks
from helpers.states import writable_state
from shapely import Point, Polygon

NOOP, LEFT, RIGHT, FIRE = 0, 1, 2, 3
OUTLINES = [
    np.array([(edge.start_x, edge.start_y) for edge in collider.edges])
    for collider in enemy_colliders()
]


def make(**keywords):
    """Return an env of one tick a decision, freshly reset, and its world's record."""
    env = ArkanoidEnv(**({"frame_skip": 1, "levels": "ripple", "capsules": False} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def clear_field(world):
    """Leave one brick in the corner, and the ball where it meets nothing."""
    world.brick_hits[:] = 0
    world.brick_hits[0] = 1
    world.hits_left = 1000
    keep_ball_flying(world)


def place(world, x, y, kind=0, state=DRIFTING, enemy=0, side=1.0):
    """Put an enemy somewhere."""
    world.enemies += world.enemy_state[enemy] == ABSENT
    world.enemy_state[enemy], world.enemy_kind[enemy] = state, kind
    world.enemy_x[enemy], world.enemy_y[enemy] = x, y
    world.enemy_side[enemy] = side
    world.enemy_course_x[enemy], world.enemy_course_y[enemy] = 0.0, -1.0
    world.enemy_wait = 10_000


def outline(world, enemy=0):
    """Return an enemy's region."""
    return Polygon(
        np.add(OUTLINES[world.enemy_kind[enemy]], [world.enemy_x[enemy], world.enemy_y[enemy]])
    )


def test_the_first_comes_through_a_gate_within_ten_seconds_and_three_at_most():
    env, world = make(lives=1000)
    clear_field(world)
    arrivals, seen, most = [], 0, 0
    for tick in range(3000):
        keep_ball_flying(world)
        world.idle = 0
        before = int(world.enemies)
        # Nobody meets the paddle, and who has dived comes back.
        for enemy in range(3):
            if world.enemy_y[enemy] < 5.0 and world.enemy_state[enemy] != ABSENT:
                world.enemy_y[enemy], world.enemy_state[enemy] = 9.0, DRIFTING
        env.step(NOOP)
        if world.enemies > before:
            arrivals.append(tick)
            newest = [e for e in range(3) if world.enemy_state[e] == ENTERING]
            assert any(world.enemy_x[e] in GATE_X for e in newest)
        seen += world.enemies > 0
        most = max(most, int(world.enemies))
    assert 239 <= arrivals[0] < 600
    assert most == 3
    assert len(arrivals) == 3
    assert (np.diff(arrivals) >= 239).all()
    assert (np.diff(arrivals) < 601).all()


def test_none_come_without_the_keyword():
    env, world = make(enemies=False)
    for _ in range(1000):
        world.idle = 0
        env.step(NOOP)
        assert world.enemies == 0
        if world.lives < 3:
            break


def test_the_gate_opens_before_an_enemy_comes_in():
    env, world = make()
    gates = env.layout["gate_open"]
    opened = 0
    while world.enemies == 0:
        keep_ball_flying(world)
        observation = env.step(NOOP)[0]
        if world.enemies == 0 and observation[gates].any():
            opened += 1
            assert observation[gates].argmax() == world.enemy_gate
            gate = int(world.enemy_gate)
    assert opened == 39
    assert world.enemy_x[0] == GATE_X[gate]


@pytest.mark.parametrize("kind", range(4))
def test_an_enemy_drifts_down_through_a_gap_circles_and_dives_at_the_paddle(kind):
    env, world = make()
    clear_field(world)
    world.brick_hits[77:88] = 255  # a row from wall to wall, 9 to 9.5 ...
    world.brick_hits[85] = 0  # ... with a gap from 8 to 9
    place(world, 3.0, 12.5, kind)
    bricks = union_of_bricks(world)
    states, dive = [], None
    for _ in range(3000):
        keep_ball_flying(world)
        x, y = float(world.enemy_x[0]), float(world.enemy_y[0])
        env.step(NOOP)
        if world.enemy_state[0] == ABSENT:
            break
        states.append(int(world.enemy_state[0]))
        assert outline(world).distance(bricks) > 0.0
        assert outline(world).bounds[0] > 0.0
        assert outline(world).bounds[2] < FIELD_WIDTH
        moved = math.dist((x, y), (world.enemy_x[0], world.enemy_y[0]))
        assert moved <= {DRIFTING: 0.03, CIRCLING: 0.05, DIVING: 0.1}[states[-1]] + 1e-12
        if states[-1] == DIVING and dive is None:
            dive = (world.enemy_vx[0], world.enemy_vy[0])
            aim = (world.paddle_x - x, PADDLE_Y - y)
            assert abs(dive[0] * aim[1] - dive[1] * aim[0]) < 1e-12
    assert [s for i, s in enumerate(states) if i == 0 or s != states[i - 1]] == [2, 3, 4]
    # The first step of 126 still ends a drift.
    assert abs(states.count(CIRCLING) - 125) <= 1
    assert world.enemies == 0
    assert world.score == 100  # it has met the paddle


def test_circling_is_round():
    """All places are half a brick width from a middle, on a circle of closed form."""
    env, world = make()
    clear_field(world)
    place(world, 5.5, 3.4, state=CIRCLING)
    places = []
    for _ in range(120):
        keep_ball_flying(world)
        env.step(NOOP)
        places.append((float(world.enemy_x[0]), float(world.enemy_y[0])))
    places = np.array(places)
    # A circle through three of them.
    matrix = 2 * (places[[40, 80]] - places[0])
    middle = np.linalg.solve(matrix, (places[[40, 80]] ** 2 - places[0] ** 2).sum(axis=1))
    radii = np.hypot(*(places - middle).T)
    assert np.ptp(radii) < 1e-9
    # Steps of 0.05 that turn by 0.1 radians.
    assert math.isclose(radii[0], 0.025 / math.sin(0.05), rel_tol=1e-9)


@pytest.mark.parametrize("kind", range(4))
def test_a_ball_destroys_an_enemy_at_the_exact_time_and_bounces_off(kind):
    env, world = make()
    clear_field(world)
    place(world, 5.5, 8.0, kind)
    world.ball_x[0], world.ball_y[0] = 5.37, 7.45
    world.ball_vx[0], world.ball_vy[0] = 0.0, BALL_SPEED
    for _ in range(10):
        ball_y, enemy_y = float(world.ball_y[0]), float(world.enemy_y[0])
        info = env.step(NOOP)[-1]
        if info["enemies_destroyed"]:
            break
    assert (info["score"], int(world.enemies)) == (100, 0)

    # When they met: bisection over their distance, the enemy sinking by 0.03 a tick.
    def gap(time):
        centre = Point(5.37, ball_y + BALL_SPEED * time)
        return Polygon(np.add(OUTLINES[kind], [5.5, enemy_y - 0.03 * time])).distance(centre)

    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if gap(middle) > BALL_RADIUS else (low, middle)
    # From there it flew on with the velocity that it now has.
    rest_of_tick = 1.0 - low
    assert math.isclose(world.ball_x[0], 5.37 + world.ball_vx[0] * rest_of_tick, abs_tol=1e-9)
    met_y = ball_y + BALL_SPEED * low
    assert math.isclose(world.ball_y[0], met_y + world.ball_vy[0] * rest_of_tick, abs_tol=1e-9)
    assert math.isclose(math.hypot(world.ball_vx[0], world.ball_vy[0]), BALL_SPEED, rel_tol=1e-12)


def test_a_beam_destroys_an_enemy():
    env, world = make(capsules=True)
    clear_field(world)
    place(world, 5.5, 8.0)
    world.beam_state[0], world.beam_x[0], world.beam_y[0] = FLYING, 5.5, 7.2
    world.beams = 1
    info = env.step(NOOP)[-1]
    assert (info["enemies_destroyed"], info["score"], int(world.enemies)) == (1, 100, 0)
    assert world.beams == 0


@pytest.mark.parametrize("side", [-1, 1])
def test_the_paddle_destroys_an_enemy_that_it_is_moved_into(side):
    env, world = make()
    clear_field(world)
    world.paddle_x = 5.5
    place(world, 5.5 + side * 1.5, PADDLE_Y, state=DIVING)
    world.enemy_course_y[0] = 1.0
    touched = 0
    for _ in range(5):
        keep_ball_flying(world)
        touched += env.step(RIGHT if side > 0 else LEFT)[-1]["enemies_destroyed"]
    assert touched == 1


def test_an_enemy_that_misses_the_paddle_is_gone_without_points():
    env, world = make()
    clear_field(world)
    place(world, 9.5, 1.0, state=DIVING)
    for _ in range(40):
        keep_ball_flying(world)
        env.step(NOOP)
    assert (world.enemies, world.score) == (0, 0)


def test_enemies_do_not_run_into_each_other():
    env, world = make(lives=1000)
    clear_field(world)
    world.brick_hits[77:88] = 255  # a floor that keeps them together
    rng = np.random.default_rng(0)
    for _ in range(20):
        xs = np.array([2.0, 5.0, 8.0]) + rng.uniform(-1, 1, 3)
        for enemy in range(3):
            place(
                world, xs[enemy], 11.0, int(rng.integers(4)), enemy=enemy, side=rng.choice([-1, 1])
            )
        for _ in range(300):
            keep_ball_flying(world)
            world.idle = 0
            env.step(NOOP)
            shapes = [outline(world, enemy) for enemy in range(3)]
            for one, other in [(0, 1), (0, 2), (1, 2)]:
                assert shapes[one].intersection(shapes[other]).area < 1e-12


def test_a_lost_life_sends_the_enemies_away():
    env, world = make()
    clear_field(world)
    place(world, 5.5, 8.0)
    world.ball_y[0], world.ball_vy[0] = 0.05, -BALL_SPEED
    env.step(NOOP)
    assert (world.lives, world.enemies) == (2, 0)
    assert world.ball_state[0] == HELD


def test_enemies_fit_through_gaps_of_one_brick_and_enter_inside():
    for vertices in OUTLINES:
        assert np.ptp(vertices[:, 0]) < 0.9
        assert np.ptp(vertices[:, 1]) < 0.9
    for x in GATE_X:
        assert 1.0 < x < FIELD_WIDTH - 1.0
    assert FIELD_HEIGHT == 14.0
