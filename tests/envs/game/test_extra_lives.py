"""Extra lives come at 20 000 points, and at 60 000, 120 000, 180 000 and so on."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.observe.planes import STATUS
from arkanoid.envs.rules import BALL_RADIUS, BALL_SPEED
from arkanoid.envs.state import FLYING
from helpers.states import observe_anew, writable_state, writable_states
from hypothesis import given, settings
from hypothesis import strategies as st

LADDER = [20_000, *range(60_000, 12_000_001, 60_000)]  # as the rules tell it
NOOP, RIGHT = 0, 2
SILVER = 9


def passed(before, after):
    """Return how many lives the way from one score to another brings."""
    return sum(before < life <= after for life in LADDER)


def next_life(score):
    """Return the score that brings the next life."""
    return next(life for life in LADDER if life > score)


def hit_a_brick(world):
    """Let the ball hit the brick in the upper left corner in the coming tick; it breaks."""
    world.brick_hits[:] = 0
    world.brick_hits[[0, -1]] = 1
    world.ball_state[0] = FLYING
    world.ball_x[0], world.ball_y[0] = 0.5, 12.5 - BALL_RADIUS
    world.ball_vx[0], world.ball_vy[0] = 0.0, BALL_SPEED


def go_through_the_gate(world):
    world.paddle_x = 11.0 - world.paddle_half
    world.exit_open = 1


ENV = ArkanoidEnv(frame_skip=1, capsules=False, levels="ripple", reward="score")


def score_points(before, points, silver_round):
    """Go from a score on by one brick, or through the gate; check all that tells of it."""
    ENV.reset(seed=0)
    world = writable_state(ENV)
    world.score, world.next_life = before, next_life(before)
    if points == 10_000:
        go_through_the_gate(world)
    else:
        hit_a_brick(world)
        world.kind[0] = SILVER if silver_round else points // 10 - 4
        world.round_number = max(1, silver_round)
    seen, reward, _, _, info = ENV.step(RIGHT)
    after = before + points
    lives = passed(before, after)
    assert info["score"] == after
    assert reward == points / 1000
    assert (info["lives"], info["lives_gained"]) == (3 + lives, lives)
    missing = (next_life(after) - after) / 60_000
    assert seen[ENV.layout["next_life"]] == np.float32(missing)
    assert seen[ENV.layout["lives"]] == np.float32(1 / (3 + lives))


AROUND = st.builds(
    lambda life, offset: max(0, life + offset),
    st.sampled_from([0, *LADDER[:60]]),
    st.integers(-1100, 1100).map(lambda tens: 10 * tens),
)


@settings(max_examples=400, deadline=None)
@given(
    before=AROUND,
    points=st.sampled_from([*range(50, 121, 10), 10_000]),
    silver_round=st.sampled_from([0, 0, 1, 7, 400, 1200, 2400, 4801]),
)
def test_each_threshold_that_a_hit_reaches_brings_a_life(before, points, silver_round):
    if silver_round and points != 10_000:
        points = 50 * silver_round
    score_points(before, points, silver_round)


@pytest.mark.parametrize("life", LADDER[:8])
def test_a_hit_that_lands_on_a_threshold_reaches_it(life):
    """One that ends just below it does not, and from it the next one is the goal."""
    for before in (life - 60, life - 50, life - 40, life):
        score_points(before, 50, 0)


def test_a_silver_brick_may_pass_several_thresholds():
    assert passed(10_000, 250_000) == 5
    score_points(10_000, 240_000, 4800)
    score_points(0, 60_000, 1200)
    score_points(0, 180_000, 3600)


@pytest.mark.parametrize("observation", ["vector", "grid"])
def test_every_decision_of_a_game_tells_the_same(observation):
    """Bricks, enemies and the boss bring points in many worlds, four ticks a decision."""
    levels = ["warden", "ripple", "vault"]
    env = ArkanoidVectorEnv(
        64, observation=observation, reward="score", levels=levels, capsules=False, speed=3.0,
        lives=50, autoreset_mode="Disabled",
    )  # fmt: skip
    env.reset(seed=0)
    worlds = writable_states(env)
    generator = np.random.default_rng(0)
    total = 0
    for decision in range(400):
        if worlds["done"].any():
            env.reset(options={"reset_mask": worlds["done"] != 0})
        if decision % 10 == 0:
            worlds["score"] = generator.choice(LADDER[:9], 64) - generator.integers(1, 200, 64) * 10
            worlds["next_life"] = [next_life(score) for score in worlds["score"]]
            observe_anew(env)
        before, lives = worlds["score"].copy(), worlds["lives"].copy()
        seen, rewards, _, _, infos = env.step(generator.integers(0, 6, 64))
        gained = [passed(*scores) for scores in zip(before, infos["score"], strict=True)]
        assert infos["lives_gained"].tolist() == gained
        assert (infos["lives"] == lives + gained - infos["lives_lost"]).all()
        np.testing.assert_allclose(rewards, (infos["score"] - before) / 1000, atol=1e-12)
        missing = [(next_life(score) - score) / 60_000 for score in infos["score"]]
        place = env.layout["next_life" if observation == "vector" else "status"]
        part = seen[:, place] if observation == "vector" else seen[:, place, STATUS["next_life"], 0]
        assert (part[:, 0] == np.float32(missing)).all()
        total += sum(gained)
    assert total > 100
