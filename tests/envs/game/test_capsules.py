"""Capsules: when they fall, which ones, and what each of them brings."""

import math

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.game.capsules import capsule_by_weight
from arkanoid.envs.game.shapes import paddle_collider
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BALL_SPEED,
    BREAK,
    CATCH,
    DISRUPT,
    ENLARGE,
    FIELD_WIDTH,
    LASER,
    NO_CAPSULE,
    NO_POWER,
    PADDLE_TOP,
    PADDLE_Y,
    PLAYER,
    SLOW,
)
from arkanoid.envs.state import ABSENT, FLYING, HELD
from helpers.states import writable_state
from shapely import Point, Polygon, box

NOOP, LEFT, RIGHT, FIRE = 0, 1, 2, 3
ALL = (CATCH, ENLARGE, LASER, SLOW, DISRUPT, BREAK, PLAYER)


def make(**keywords):
    """Return an env of one tick a decision, freshly reset, and its world's record."""
    env = ArkanoidEnv(**({"frame_skip": 1, "levels": "ripple", "enemies": False} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def fly(world, x, y, vx, vy, ball=0):
    """Put a ball into flight."""
    world.ball_state[ball] = FLYING
    world.ball_x[ball], world.ball_y[ball] = x, y
    world.ball_vx[ball], world.ball_vy[ball] = vx, vy


def catch(env, world, kind):
    """Let a capsule fall onto the paddle."""
    world.capsule = kind
    world.capsule_x, world.capsule_y = world.paddle_x, PADDLE_TOP + 0.2
    return env.step(NOOP)


def speed_of(world, ball=0):
    return math.hypot(world.ball_vx[ball], world.ball_vy[ball])


def angle_of(world, ball=0):
    """Return the degrees of a ball's course from the vertical, to the right."""
    return math.degrees(math.atan2(world.ball_vx[ball], world.ball_vy[ball]))


def break_brick(env, world, kind=1, **fields):
    """Break a brick of a kind from below, in the middle of the field."""
    world.kind[:] = 0
    world.brick_hits[:] = 0
    world.kind[60], world.brick_hits[60] = kind, 1  # column 5, row 5
    world.hits_left = 1000  # so that the round goes on
    for name, value in fields.items():
        world[name] = value
    fly(world, 5.5, 10.0 - BALL_RADIUS, 0.0, BALL_SPEED)
    return env.step(NOOP)


def test_a_capsule_falls_from_the_brick_at_a_16th_a_tick():
    env, world = make(capsule_rate=1.0)
    break_brick(env, world)
    assert world.capsule in ALL
    assert (world.capsule_x, world.capsule_y) == (5.5, 10.25 - 1 / 16)
    env.step(NOOP)
    assert world.capsule_y == 10.25 - 2 / 16


def test_only_coloured_bricks_hide_capsules_and_silver_does_not():
    for kind, falls in [(1, True), (8, True), (9, False)]:
        env, world = make(capsule_rate=1.0)
        break_brick(env, world, kind)
        assert (world.capsule != NO_CAPSULE) == falls


def test_one_falls_at_a_time_and_none_while_more_than_one_ball_is_in_play():
    env, world = make(capsule_rate=1.0)
    break_brick(env, world, capsule=SLOW, capsule_x=1.0, capsule_y=9.0)
    assert (world.capsule, world.capsule_x) == (SLOW, 1.0)
    env, world = make(capsule_rate=1.0)
    fly(world, 1.0, 6.0, 0.0, BALL_SPEED, ball=1)
    break_brick(env, world)
    assert world.capsule == NO_CAPSULE


def test_no_capsules_without_the_keyword():
    env, world = make(capsules=False, capsule_rate=1.0)
    break_brick(env, world)
    assert world.capsule == NO_CAPSULE


def test_twelve_percent_of_the_bricks_hide_one():
    """The part of 4000 bricks is within four standard deviations of 0.12."""
    env, world = make()
    fallen = 0
    for _ in range(4000):
        break_brick(env, world, idle=0, lives=3, capsule=NO_CAPSULE, power=NO_POWER)
        fallen += world.capsule != NO_CAPSULE
    assert abs(fallen / 4000 - 0.12) < 4 * math.sqrt(0.12 * 0.88 / 4000)


def test_weights():
    """Break and player have 3/256 each; the rest is shared 3:2:1:1:1."""
    count = 1 << 16
    kinds = [capsule_by_weight((i + 0.5) / count) for i in range(count)]
    rest = 250 / 256 / 8
    expected = {BREAK: 3 / 256, PLAYER: 3 / 256, DISRUPT: 3 * rest, ENLARGE: 2 * rest}
    expected |= {SLOW: rest, CATCH: rest, LASER: rest}
    for kind, share in expected.items():
        assert abs(kinds.count(kind) / count - share) < 2 / count


@pytest.mark.parametrize("owned", [CATCH, ENLARGE, LASER])
def test_what_is_owned_is_drawn_again(owned):
    env, world = make(capsule_rate=1.0)
    drawn = set()
    for _ in range(1500):
        break_brick(env, world, capsule=NO_CAPSULE, power=owned, exit_open=1, idle=0)
        drawn.add(int(world.capsule))
    assert drawn == set(ALL) - {owned, BREAK}


@pytest.mark.parametrize("offset", [0.0, -1.3, 1.3, 1.45])
def test_a_capsule_is_caught_exactly_if_it_touches_the_moving_paddle(offset):
    env, world = make()
    world.capsule, world.capsule_x, world.capsule_y = SLOW, world.paddle_x + offset, 3.0
    caught = 0
    touches = False
    while world.capsule == SLOW:
        x, y = world.capsule_x, world.capsule_y
        info = env.step(RIGHT if world.paddle_x < 5.6 else LEFT)[-1]
        caught += info["capsules_caught"]
        # The area that the capsule sweeps as the paddle sees it.
        path = box(x - 0.4, y - 0.1875 - 1 / 16, x + 0.4, y + 0.1875)
        shape = Polygon(np.add(paddle_collider(2.0).vertices, [world.paddle_x, PADDLE_Y]))
        touches = touches or path.intersects(shape)
    # The paddle moves little beside the capsule's width: this settles all but grazing ones.
    assert caught == int(touches)


def test_a_caught_capsule_scores_1000():
    env, world = make()
    info = catch(env, world, SLOW)[-1]
    assert (info["score"], info["capsules_caught"], int(world.capsule)) == (1000, 1, NO_CAPSULE)


def test_a_missed_capsule_is_gone():
    env, world = make()
    world.capsule, world.capsule_x, world.capsule_y = SLOW, 1.0, 0.0
    for _ in range(4):
        env.step(NOOP)
    assert world.capsule == NO_CAPSULE
    assert world.score == 0


@pytest.mark.parametrize(("stage", "slowed"), [(7, 5), (1, -1), (0, -1), (-1, -1)])
def test_slow_takes_two_stages_at_once(stage, slowed):
    env, world = make()
    fly(world, 5.5, 4.0, 0.0, BALL_SPEED * (1 + stage / 4))
    world.speed_stage = stage
    catch(env, world, SLOW)
    assert world.speed_stage == slowed
    assert math.isclose(speed_of(world), BALL_SPEED * (1 + slowed / 4), rel_tol=1e-12)


def test_enlarge_makes_the_paddle_three_wide_and_keeps_it_in_the_field():
    env, world = make()
    world.paddle_x = FIELD_WIDTH - 1.0
    catch(env, world, ENLARGE)
    assert (world.paddle_half, world.paddle_x) == (1.5, FIELD_WIDTH - 1.5)
    env, world = make(paddle=0.5)
    catch(env, world, ENLARGE)
    assert world.paddle_half == 0.75


def test_a_ball_beside_the_paddle_is_freed_when_that_is_enlarged():
    env, world = make()
    fly(world, world.paddle_x + 1.2, PADDLE_Y, 0.0, -BALL_SPEED / 100)
    catch(env, world, ENLARGE)
    shape = Polygon(np.add(paddle_collider(3.0).vertices, [world.paddle_x, PADDLE_Y]))
    assert shape.distance(Point(world.ball_x[0], world.ball_y[0])) > BALL_RADIUS - 1e-12


def test_catch_enlarge_and_laser_replace_each_other_and_a_lost_life_ends_them():
    env, world = make()
    for power, half in [(CATCH, 1.0), (ENLARGE, 1.5), (LASER, 1.0), (ENLARGE, 1.5), (CATCH, 1.0)]:
        catch(env, world, power)
        assert (world.power, world.paddle_half) == (power, half)
    catch(env, world, ENLARGE)
    catch(env, world, BREAK)
    fly(world, 0.5, 0.1, 0.0, -BALL_SPEED)
    env.step(NOOP)
    assert (world.power, world.paddle_half, world.exit_open) == (NO_POWER, 1.0, 0)


@pytest.mark.parametrize("offset", [-0.7, 0.0, 0.4])
def test_catch_holds_the_ball_where_it_lands_and_fire_sends_it_off_from_there(offset):
    env, world = make()
    catch(env, world, CATCH)
    fly(world, world.paddle_x + offset, PADDLE_TOP + BALL_RADIUS + 0.01, 0.0, -BALL_SPEED)
    env.step(NOOP)
    assert world.ball_state[0] == HELD
    for _ in range(30):
        env.step(LEFT)
        assert math.isclose(world.ball_x[0] - world.paddle_x, offset, abs_tol=1e-12)
        assert world.ball_y[0] == PADDLE_TOP + BALL_RADIUS
    env.step(FIRE)
    assert world.ball_state[0] == FLYING
    assert math.isclose(abs(angle_of(world)), 10 + 53 * abs(offset), abs_tol=0.01)
    assert offset == 0.0 or math.copysign(1.0, angle_of(world)) == math.copysign(1.0, offset)


@pytest.mark.parametrize("actions", ["discrete3", "discrete6"])
def test_a_caught_ball_is_released_after_120_ticks(actions):
    env, world = make(actions=actions)
    catch(env, world, CATCH)
    fly(world, world.paddle_x, PADDLE_TOP + BALL_RADIUS + 0.01, 0.0, -BALL_SPEED)
    env.step(NOOP)
    for _ in range(119):
        env.step(NOOP)
        assert world.ball_state[0] == HELD
    env.step(NOOP)
    assert world.ball_state[0] == FLYING


def test_a_ball_caught_at_the_paddles_end_stays_in_the_field_at_the_wall():
    env, world = make()
    catch(env, world, CATCH)
    fly(world, world.paddle_x + 0.99, PADDLE_TOP + BALL_RADIUS - 0.05, 0.0, -BALL_SPEED)
    world.ball_y[0] = PADDLE_TOP + BALL_RADIUS
    env.step(NOOP)
    if world.ball_state[0] == HELD:
        for _ in range(40):
            env.step(RIGHT)
        assert world.ball_x[0] <= FIELD_WIDTH - BALL_RADIUS


def laser(actions="discrete6"):
    env, world = make(actions=actions)
    world.brick_hits[:] = 0
    world.brick_hits[0] = 1
    fly(world, 0.5, 4.0, 0.0, 1e-6)
    catch(env, world, LASER)
    return env, world


def test_the_laser_shoots_two_beams_every_15_ticks_while_fire_is_held():
    env, world = laser()
    starts = []
    for tick in range(46):
        before = np.array(world.beam_y)
        env.step(FIRE)
        starts += [tick] * int(((world.beam_y > 0) & (world.beam_y < before + 0.1)).sum())
        starts += [tick] * int(((world.beam_y > 0) & (before == 0)).sum())
    assert sorted(set(starts)) == [0, 15, 30, 45]
    assert len(starts) == 8


def test_the_laser_shoots_by_itself_without_a_fire_button():
    env, world = laser("discrete3")
    env.step(NOOP)
    assert world.beams == 2
    env, world = laser("discrete6")
    env.step(NOOP)
    assert world.beams == 0


def test_beams_fly_straight_up_from_the_paddle_and_end_at_the_ceiling():
    env, world = laser()
    env.step(FIRE)
    x = np.sort(np.array(world.beam_x)[np.array(world.beam_state) != ABSENT])
    assert np.allclose(x, [world.paddle_x - 0.6, world.paddle_x + 0.6])
    for _ in range(24):
        env.step(NOOP)
    assert world.beams == 0
    assert world.hits_left > 0


@pytest.mark.parametrize(("hits", "left"), [(1, 0), (2, 1), (3, 2), (255, 255)])
def test_a_beam_is_one_hit_on_a_brick(hits, left):
    env, world = laser()
    world.brick_hits[:] = 0
    world.brick_hits[0] = 1
    cell = 17 * 11 + int(world.paddle_x - 0.6)
    world.brick_hits[cell] = hits
    world.kind[cell] = 9 if hits < 255 else 10
    world.beam_state[0], world.beam_x[0], world.beam_y[0] = FLYING, world.paddle_x - 0.6, 3.6
    world.beams = 1
    env.step(NOOP)
    assert world.brick_hits[cell] == left
    assert world.beams == 0


def test_a_beam_meets_bricks_through_the_whole_tick_however_fast():
    env, world = laser()
    world.brick_hits[:] = 0
    world.brick_hits[0] = 1
    world.brick_hits[60] = 1  # 5 to 6 by 10 to 10.5
    for y in np.linspace(9.0, 9.8, 17):
        world.brick_hits[60] = 1
        world.beam_state[0], world.beam_x[0], world.beam_y[0] = FLYING, 5.5, y
        world.beams = 1
        env.step(NOOP)
        reached = y + 0.25 + 0.5 > 10.0
        assert (world.brick_hits[60] == 0) == reached
        assert (world.beams == 0) == reached


def test_disrupt_makes_three_balls_15_degrees_apart():
    env, world = make()
    speed = BALL_SPEED * 1.5
    world.speed_stage = 2
    fly(world, 3.0, 4.0, 0.0, speed)
    catch(env, world, DISRUPT)
    assert (np.array(world.ball_state) == FLYING).all()
    angles = sorted(angle_of(world, ball) for ball in range(3))
    assert np.allclose(angles, [-15, 0, 15], atol=0.01)
    for ball in range(3):
        assert math.isclose(speed_of(world, ball), speed, rel_tol=1e-12)
    assert len(set(map(float, world.ball_x))) == 1


def test_disrupt_serves_a_ball_that_is_held():
    env, world = make()
    catch(env, world, DISRUPT)
    assert (np.array(world.ball_state) == FLYING).all()


def test_only_the_last_ball_costs_a_life():
    env, world = make()
    fly(world, 3.0, 4.0, 0.0, BALL_SPEED)
    catch(env, world, DISRUPT)
    for ball, lives in [(0, 3), (2, 3), (1, 2)]:
        fly(world, 0.5, 0.05, 0.0, -BALL_SPEED, ball)
        info = env.step(NOOP)[-1]
        assert info["lives"] == lives
    assert info["lives_lost"] == 1
    assert world.ball_state[0] == HELD


def test_break_opens_the_right_wall_and_pushing_on_through_it_clears_the_round():
    env, world = make()
    world.paddle_x = FIELD_WIDTH - 1.1
    catch(env, world, BREAK)
    assert world.exit_open == 1
    score = int(world.score)
    rewards = []
    for action in (NOOP, RIGHT, RIGHT):
        _, reward, _, _, info = env.step(action)
        rewards.append(reward)
        if info["rounds_cleared"]:
            break
    assert (info["round"], info["score"]) == (2, score + 10_000)
    assert sum(rewards) == 1.0
    assert world.exit_open == 0


def test_the_right_wall_is_shut_otherwise():
    env, world = make()
    world.paddle_x = FIELD_WIDTH - 1.0
    for _ in range(5):
        info = env.step(RIGHT)[-1]
    assert info["round"] == 1


def test_player_is_one_more_life():
    env, world = make()
    info = catch(env, world, PLAYER)[-1]
    assert (info["lives"], info["lives_gained"]) == (4, 1)
