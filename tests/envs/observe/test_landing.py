"""Where the balls will land: it is what then happens in the game."""

import itertools
import math

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.observe.landing import LANDING_TICKS
from arkanoid.envs.rules import BALL_RADIUS, FIELD_HEIGHT, FIELD_WIDTH, PADDLE_TOP, UNBREAKABLE
from arkanoid.envs.state import ABSENT, FLYING
from helpers.states import observe_anew, writable_state, writable_states

HEIGHT = PADDLE_TOP + BALL_RADIUS
WORLDS = 256
# How much a number of an observation, a float32 in [-1, 1], may be off.
ROUNDING = 2.0**-24


def between_walls(x):
    """Return where a ball is that would be at x without the walls."""
    width = FIELD_WIDTH - 2 * BALL_RADIUS
    place = np.mod(x - BALL_RADIUS, 2 * width)
    return BALL_RADIUS + np.minimum(place, 2 * width - place)


def landings(env, observations):
    """Return (x, ticks, known) of the balls, each [n, 3]."""
    x, ticks, known = (
        observations[:, env.layout[f"landing_{name}"]].astype(float)
        for name in ("x", "ticks", "known")
    )
    return (x + 1.0) * (FIELD_WIDTH / 2), ticks * LANDING_TICKS, known > 0


def follow(env, observations, generator):
    """Return actions that mostly follow the ball, so that games get on."""
    gap = observations[:, env.layout["ball_x"].start] - observations[:, env.layout["paddle"].start]
    wanted = np.where(gap > 0.02, 2, np.where(gap < -0.02, 1, 0))
    return np.where(generator.random(len(wanted)) < 0.3, generator.integers(0, 3, WORLDS), wanted)


def sensitivity(env, states):
    """Return by how much landings move if balls are moved a little, [n, 3, 2]: x and ticks.

    Each corner on the way multiplies an error, the smallest rounding error, too.
    """
    shift = 2.0**-30
    other = ArkanoidVectorEnv(WORLDS, **env.config.plain())
    other.reset(seed=0)
    shifted = []
    for field, sign in itertools.product(("ball_x", "ball_y"), (0.0, -1.0, 1.0)):
        writable_states(other)[:] = states
        writable_states(other)[field] += sign * shift
        shifted.append(np.stack(landings(other, observe_anew(other))[:2], axis=-1))
    return np.abs(np.stack(shifted) - shifted[0]).max(axis=0) / shift


@pytest.mark.parametrize(
    "keywords",
    [
        {"levels": "campaign"},
        {"levels": "test", "speed": 2.0, "deflection": "zones6"},
        {"levels": ["vault", "spiral"], "deflection": "physical", "speed": 0.5},
        {"levels": "warden", "enemies": True},
    ],
    ids=["angle", "zones6", "physical", "boss"],
)
def test_balls_land_where_and_when_it_was_said(keywords):
    """Thousands of balls, each followed tick by tick.

    Two flights of the same ball round differently, and corners multiply the difference: the
    tolerance is a rounding error times what a small shift of the ball changes.
    """
    keywords = {"capsules": False, "enemies": False, "actions": "discrete3"} | keywords
    env = ArkanoidVectorEnv(
        WORLDS, frame_skip=1, autoreset_mode="SameStep", landing=True, **keywords
    )
    observations, _ = env.reset(seed=0)
    scouts = ArkanoidVectorEnv(
        WORLDS, frame_skip=1, autoreset_mode="SameStep", landing=True, **keywords
    )
    generator = np.random.default_rng(0)
    checked = foreseeable = flying = said = 0
    for step in range(1, 1000):
        observations = env.step(follow(env, observations, generator))[0]
        if step % 60:
            continue
        flies = env.state["ball_state"][:, 0] == FLYING
        x, ticks, known = (each[:, 0] for each in landings(env, observations))
        flying, said = flying + flies.sum(), said + (flies & known).sum()
        rounding = 1e-12 * sensitivity(env, env.state.copy())[:, 0]
        allowed = rounding + ROUNDING * np.array([FIELD_WIDTH, 2 * LANDING_TICKS])
        # What is shown as 1 may be later.
        waiting = flies & known & (ticks < LANDING_TICKS)
        checked += waiting.sum()
        waiting &= (rounding < 1e-4).all(axis=1)
        foreseeable += waiting.sum()
        scouts.restore(env.snapshot())
        for tick in range(LANDING_TICKS + 1):
            now = scouts.state
            last = waiting & (ticks < tick + 1.01)  # it lands in this tick, or just after it
            time = (now["ball_y"][last, 0] - HEIGHT) / -now["ball_vy"][last, 0]
            there = between_walls(now["ball_x"][last, 0] + now["ball_vx"][last, 0] * time)
            assert (np.abs(there - x[last]) <= allowed[last, 0]).all()
            assert (np.abs(tick + time - ticks[last]) <= allowed[last, 1]).all()
            waiting &= ~last
            if not waiting.any():
                break
            # A ball that the paddle's end has thrown up may still be lower.
            high = (now["ball_y"][:, 0] > HEIGHT) | (now["ball_vy"][:, 0] > 0.0)
            assert high[waiting].all()
            _, _, over, cut, infos = scouts.step(np.zeros(WORLDS, int))
            if keywords["enemies"]:
                # The boss's shards can take a life meanwhile. Without the boss, enemies come.
                waiting &= ~over & (infos["lives_lost"] == 0) & (now["boss_hits"] > 0)
            assert not (over | cut | (infos["rounds_cleared"] > 0))[waiting].any()
        assert not waiting.any()
    assert checked > 2000
    assert foreseeable > 0.97 * checked
    assert said > 0.9 * flying


def alone(**keywords):
    """Return a game, and its world, with one ball in an empty field but for a brick in a corner."""
    env = ArkanoidEnv(
        **{"levels": "vault", "capsules": False, "enemies": False, "landing": True} | keywords
    )
    env.reset(seed=0)
    world = writable_state(env)
    world.brick_hits[:] = 0
    world.brick_hits[0] = 1
    world.hits_left = world.bricks_left = 1
    return env, world


def put(world, ball, x, y, vx, vy):
    """Let a ball fly."""
    world.ball_state[ball] = FLYING
    world.ball_x[ball], world.ball_y[ball] = x, y
    world.ball_vx[ball], world.ball_vy[ball] = vx, vy


def shown(env):
    """Return (x, ticks, known) of each ball."""
    return [tuple(each[0].tolist()) for each in landings(env, observe_anew(env))]


def near(numbers):
    return pytest.approx(numbers, abs=1e-4)


def test_a_ball_between_the_walls_and_the_ceiling():
    env, world = alone()
    # Down, with a wall on the way; up to the ceiling; and one that has fallen below the paddle.
    put(world, 0, 10.0, HEIGHT + 1.0, 0.15, -0.1)
    put(world, 1, 5.0, 10.0, 0.0, 0.176)
    put(world, 2, 5.0, HEIGHT - 0.5, 0.0, -0.176)
    up = FIELD_HEIGHT - BALL_RADIUS - 10.0
    # The ceiling raises the speed stage, and so the speed, to 1.25 times.
    down = (FIELD_HEIGHT - BALL_RADIUS - HEIGHT) / 1.25
    x, ticks, known = shown(env)
    assert known == (True, True, False)
    assert x[:2] == near((10.0 + 1.5 - 2 * (10.0 + 1.5 - (11.0 - BALL_RADIUS)), 5.0))
    # At the wall the ball takes the speed of the rules.
    speed = math.hypot(0.15, 0.1)
    wall = (11.0 - BALL_RADIUS - 10.0) / 0.15
    assert ticks[:2] == near((wall + (10.0 - wall) * speed / 0.176, (up + down) / 0.176))
    assert (x[2], ticks[2]) == (near(5.5), 0.0)


def test_a_held_ball_is_there_and_an_absent_one_is_nowhere():
    env, world = alone()
    x, ticks, known = shown(env)
    assert (known, ticks) == ((True, False, False), (0.0, 0.0, 0.0))
    assert x[0] == near(world.ball_x[0])
    world.ball_state[0] = ABSENT
    assert not any(shown(env)[2])


def test_bricks_on_the_way_break_for_each_ball_anew_and_stay_in_the_game():
    """Two balls under the same column of two bricks: each breaks the lower one, and returns."""
    env, world = alone()
    world.brick_hits[[5, 16]] = 1  # in rows 0 and 1
    world.hits_left = world.bricks_left = 3
    put(world, 0, 5.5, 8.0, 0.0, 0.176)
    put(world, 1, 5.5, 6.0, 0.0, 0.176)
    before = world.tobytes()
    lower = 12.0 - BALL_RADIUS
    x, ticks, known = shown(env)
    assert known == (True, True, False)
    assert x[:2] == near((5.5, 5.5))
    assert ticks[:2] == near(tuple(((lower - y) + (lower - HEIGHT)) / 0.176 for y in (8.0, 6.0)))
    assert world.tobytes() == before


def test_what_clears_the_round_lands_nowhere():
    env, world = alone()
    put(world, 0, 0.5, 8.0, 0.0, 0.176)
    assert shown(env)[2] == (False, False, False)
    world.brick_hits[0] = 2
    world.hits_left = 2
    assert shown(env)[2] == (True, False, False)


def test_a_ball_that_meets_too_much_is_not_followed():
    """Between two golden bricks it flies up and down until the game turns it."""
    env, world = alone()
    world.brick_hits[[5, 27]] = UNBREAKABLE  # in rows 0 and 2, the ball between them
    put(world, 0, 5.5, 12.25, 0.0, 0.176)
    assert shown(env)[2][0] is False
    world.brick_hits[27] = 0
    assert shown(env)[2][0] is True


def test_times_beyond_the_scale_are_shown_as_its_end():
    env, world = alone(speed=0.01)
    put(world, 0, 5.5, 8.0, 0.0, -0.00176)
    x, ticks, known = shown(env)
    assert (x[0], ticks[0], known[0]) == (near(5.5), LANDING_TICKS, True)


def test_dict_has_the_landings_too():
    both = ArkanoidEnv(observation="dict", size=20, landing=True)
    numbers = ArkanoidEnv(landing=True)
    assert both.layout["vector"] == numbers.layout
    one, other = both.reset(seed=0)[0], numbers.reset(seed=0)[0]
    for action in (3, 0, 1, 2, 0, 0):
        assert one["vector"].tobytes() == other.tobytes()
        one, other = both.step(action)[0], numbers.step(action)[0]


@pytest.mark.parametrize("reward", ["progress", "score"])
def test_the_landings_follow_everything_else(reward):
    plain = ArkanoidEnv(reward=reward)
    env = ArkanoidEnv(reward=reward, landing=True)
    length = plain.observation_space.shape[0]
    names = ["landing_x", "landing_ticks", "landing_known"]
    assert list(env.layout)[:-3] == list(plain.layout)
    assert list(env.layout)[-3:] == names
    assert [env.layout[name].start for name in names] == [length, length + 3, length + 6]
    assert env.observation_space.shape == (length + 9,)
    one, other = plain.reset(seed=0)[0], env.reset(seed=0)[0]
    for action in (3, 0, 1, 2, 0, 0, 2):
        assert one.tobytes() == other[:length].tobytes()
        one, other = plain.step(action)[0], env.step(action)[0]
