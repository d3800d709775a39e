"""Idling costs a life, so that no stalling policy beats playing."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.rules import (
    BALL_RADIUS,
    CATCH,
    CATCH_TICKS,
    ENLARGE,
    FIELD_WIDTH,
    IDLE_TICKS,
    PADDLE_SPEED,
    PADDLE_TOP,
)
from arkanoid.envs.state import ABSENT, FLYING, HELD
from helpers.fields import keep_ball_flying
from helpers.states import portable_bytes, writable_state

NOOP, RIGHT, FIRE = 0, 2, 3
GAMES = 12


def make(**keywords):
    """Return an env of one tick a decision, freshly reset, and its world's record."""
    env = ArkanoidEnv(**({"frame_skip": 1, "levels": "ripple"} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def keep_balls_flying(world, balls):
    """Keep that many balls in flight where they hit nothing."""
    keep_ball_flying(world)
    for ball in range(balls):
        world.ball_state[ball] = FLYING
        world.ball_x[ball], world.ball_y[ball] = 0.5 + ball, 3.0
        world.ball_vy[ball] = 1e-9


@pytest.mark.parametrize("balls", [1, 2, 3])
@pytest.mark.parametrize("lives", [1, 3])
@pytest.mark.parametrize("game", [{"enemies": False}, {"levels": "warden"}, {"paddle": 0.5}])
def test_idling_costs_what_a_lost_ball_costs(balls, lives, game):
    """The same state follows, to the bit, and the same outcome: a stalled life is worth no more.

    Idling used to truncate the episode. Whoever stalled escaped the life penalty.
    """
    ends = []
    for idles in (False, True):
        env, world = make(lives=lives, life_penalty=0.25, **game)
        for _ in range(40):
            env.step(FIRE)
        world.power, world.speed_stage = ENLARGE, 3
        keep_balls_flying(world, balls)
        if idles:
            world.idle = IDLE_TICKS - 1
        else:
            world.ball_state[1:] = ABSENT
            world.ball_y[0], world.ball_vy[0] = 0.01, -0.1
        ends.append((*env.step(NOOP)[1:], world))
    (*lost, after_loss), (*idled, after_idling) = ends
    assert lost == idled
    reward, terminated, truncated, info = idled
    assert (reward, terminated, truncated) == (-0.25, lives == 1, False)
    assert (info["lives_lost"], info["lives"], info["truncation"]) == (1, lives - 1, 0)
    if lives > 1:
        assert portable_bytes(after_idling) == portable_bytes(after_loss)
        assert after_idling.idle == 0
        assert after_idling.ball_state.tolist() == [HELD, ABSENT, ABSENT]


def test_a_ball_lost_when_the_clock_runs_out_is_one_life():
    env, world = make()
    keep_balls_flying(world, 1)
    world.ball_y[0], world.ball_vy[0], world.idle = 0.01, -0.1, IDLE_TICKS - 1
    assert env.step(NOOP)[4]["lives_lost"] == 1


def test_damage_in_the_last_tick_saves_the_life():
    env, world = make()
    world.brick_hits[1:11] = 0
    world.brick_hits[0] = 1
    world.ball_state[0] = FLYING
    world.ball_x[0], world.ball_y[0] = 0.5, 12.5 - BALL_RADIUS
    world.ball_vx[0], world.ball_vy[0] = 0.0, 0.2
    world.idle = IDLE_TICKS - 1
    info = env.step(NOOP)[4]
    assert (info["hits"], info["lives_lost"], world.idle) == (1, 0, 0)


def test_each_serve_starts_the_clock_anew():
    """Otherwise a ball lost late would soon cost a second life, whatever the player does."""
    env, world = make(levels=["ripple", "comb"])
    keep_balls_flying(world, 1)
    world.ball_y[0], world.ball_vy[0], world.idle = 0.01, -0.1, IDLE_TICKS - 2
    env.step(NOOP)
    assert (world.lives, world.idle) == (2, 0)
    # The gate clears the round without damage.
    world.idle, world.exit_open, world.paddle_x = IDLE_TICKS - 2, 1, FIELD_WIDTH - world.paddle_half
    assert env.step(RIGHT)[4]["rounds_cleared"] == 1
    assert (world.lives, world.idle) == (2, 0)


def test_idling_ends_an_episodic_life():
    env, world = make(episodic_life=True)
    world.idle = IDLE_TICKS - 1
    *_, terminated, truncated, info = env.step(NOOP)
    assert (terminated, truncated, info["lives"]) == (True, False, 2)


def test_a_caught_ball_does_not_stop_the_clock():
    """Catching again and again holds the ball for most of the time, but not for ever."""
    env, world = make(lives=1, capsules=True, enemies=False)
    world.brick_hits[:] = 255
    world.brick_hits[0] = 1
    world.power = CATCH
    keep_balls_flying(world, 1)
    world.ball_vy[0] = -0.1
    ticks, held, terminated = 0, 0, False
    while not terminated:
        world.power = CATCH
        if world.ball_state[0] == FLYING:
            world.paddle_x = np.clip(world.ball_x[0], 1.0, FIELD_WIDTH - 1.0)
        _, _, terminated, truncated, _ = env.step(NOOP)
        assert not truncated
        held = held + 1 if world.ball_state[0] == HELD else 0
        assert held <= CATCH_TICKS
        ticks += 1
    assert ticks == IDLE_TICKS


# A golden floor with one gap: away from it, the ball stays in play and damages nothing.
GOLDEN_FLOOR = 2 * "ggggggggggg\n" + 10 * "...........\n" + "XXXXXXXXXX.\n"


def hold(move, fire=0.0):
    """Return a policy that always does the same."""
    return lambda states, step: np.tile([move, fire], (len(states), 1))


def dodge(states, step):
    """Stay away from the ball."""
    move = np.where(states["ball_x"][:, 0] > states["paddle_x"], -1.0, 1.0)
    return np.stack([move, np.zeros(len(move))], axis=1)


def keep_in_the_corner(states, step):
    """Send the ball up steeply, always towards the left of the field."""
    landing = next_landing(states)
    return meet(states, landing, np.where(landing > 2.5, -0.1, 0.1))


def play_honestly(states, step):
    """Meet each ball with another part of the paddle, so that it goes everywhere."""
    aims = np.random.default_rng(step // 40).uniform(-0.8, 0.8, len(states))
    return meet(states, next_landing(states), aims)


def next_landing(states):
    """Return where the first ball lands if it falls, and otherwise where it is."""
    x, vx, vy = (states[name][:, 0] for name in ("ball_x", "ball_vx", "ball_vy"))
    falls = vy < 0
    height = states["ball_y"][:, 0] - PADDLE_TOP - BALL_RADIUS
    time = np.where(falls, height / np.where(falls, -vy, 1.0), 0.0)
    width = FIELD_WIDTH - 2 * BALL_RADIUS
    place = np.mod(x + vx * time - BALL_RADIUS, 2 * width)
    return BALL_RADIUS + np.minimum(place, 2 * width - place)


def meet(states, landing, aims):
    """Move the part of the paddle at ``aims``, in [-1, 1], to where the ball lands; fire."""
    gap = landing - aims * states["paddle_half"] - states["paddle_x"]
    move = np.clip(gap / (4 * PADDLE_SPEED), -1.0, 1.0)
    return np.stack([move, np.ones(len(move))], axis=1)


STALLING = {
    "no-op": hold(0.0),
    "fire": hold(0.0, fire=1.0),
    "left": hold(-1.0),
    "right": hold(1.0),
    "dodge": dodge,
}


def returns(policy, **keywords):
    """Return the returns and lengths, in decisions, of whole games with equal seeds."""
    # Three lives of idling are over after 2700 decisions.
    keywords |= {"actions": "box", "max_decisions": 4000}
    worlds = ArkanoidVectorEnv(GAMES, autoreset_mode="SameStep", **keywords)
    worlds.reset(seed=0)
    total, length, playing = np.zeros(GAMES), np.zeros(GAMES), np.ones(GAMES, bool)
    while playing.any():
        actions = policy(worlds.state, int(length.max()))
        _, rewards, terminated, truncated, _ = worlds.step(actions.astype(np.float32))
        total += rewards * playing
        length += playing
        playing &= ~(terminated | truncated)
    return total, length


@pytest.mark.parametrize("life_penalty", [0.0, 1.0])
@pytest.mark.parametrize("reward", ["progress", "score", "sparse"])
@pytest.mark.parametrize("level", ["vault", "ripple"])
def test_no_policy_that_stands_still_or_dodges_beats_playing(level, reward, life_penalty):
    game = {"levels": [level], "reward": reward, "life_penalty": life_penalty}
    played = returns(play_honestly, **game)[0]
    for name, policy in STALLING.items():
        stalled = returns(policy, **game)[0]
        assert stalled.mean() <= played.mean(), name


@pytest.mark.parametrize("life_penalty", [0.0, 1.0])
@pytest.mark.parametrize("reward", ["progress", "score", "sparse"])
def test_keeping_the_ball_in_play_without_damage_does_not_beat_playing(
    reward, life_penalty, tmp_path
):
    """Under Vault's gold, stalling returned 0.03 where honest play returned -0.8."""
    level = tmp_path / "floor.txt"
    level.write_text(GOLDEN_FLOOR)
    game = {"levels": [str(level)], "reward": reward, "life_penalty": life_penalty}
    stalled, length = returns(keep_in_the_corner, **game, enemies=False)
    # In some games a serve sends the ball to the gap.
    idled = length == 3 * IDLE_TICKS / 4
    assert idled.mean() > 0.5
    assert (stalled[idled] == -3 * life_penalty).all()
    played, _ = returns(play_honestly, **game, enemies=False)
    assert (played[idled] >= stalled[idled]).all()
    assert played.mean() > stalled[idled].max()
