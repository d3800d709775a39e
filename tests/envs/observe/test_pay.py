"""With `reward="score"`, observations show what pays: the bricks' points, and the next life."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.observe.planes import STATUS
from helpers.states import latest_observations, observe_anew, writable_state

POINTS = {kind: 40 + 10 * kind for kind in range(1, 9)}  # white 50 to yellow 120
GAMES = [{}, {"capsules": False, "enemies": False}]


def expected_pay(world):
    """Return what each brick pays, points / 1000, [198]."""
    standing = (world["brick_hits"] > 0) & (world["brick_hits"] < 255)
    points = POINTS | {9: 50 * int(world["round_number"])}
    values = [points.get(int(kind), 0) / 1000 for kind in world["kind"]]
    return np.minimum(values, 1.0) * standing


def shown_pay(env, observation):
    """Return (what each brick pays, points to the next life / 60000) of an observation."""
    if env.config.observation == "vector":
        where = env.layout
        return observation[where["brick_points"]], observation[where["next_life"]]
    plane = observation[env.layout["brick_points"]][0]
    assert not plane[:2].any()
    assert not plane[20:].any()
    return plane[2:20].reshape(-1), observation[env.layout["status"]][0, STATUS["next_life"]]


@pytest.mark.parametrize("game", GAMES, ids=["full", "lite"])
@pytest.mark.parametrize("observation", ["vector", "grid"])
@pytest.mark.parametrize("level", ["vault", "comb"])
def test_bricks_show_their_points_and_how_far_the_next_life_is(observation, game, level):
    """With the score as reward, the colours of bricks and the next life were not to be seen."""
    env = ArkanoidEnv(observation=observation, reward="score", levels=level, lives=20, **game)
    env.reset(seed=0)
    env.action_space.seed(0)
    for score, round_number, life in [(0, 1, 20_000), (30_000, 4, 60_000), (60_000, 30, 120_000)]:
        world = writable_state(env)
        world.score, world.round_number, world.next_life = score, round_number, life
        observe_anew(env)
        for _ in range(300):
            pay, distance = shown_pay(env, latest_observations(env)[0])
            state = env.state
            np.testing.assert_allclose(pay, expected_pay(state), atol=1e-7)
            far = (int(state["next_life"]) - int(state["score"])) / 60_000
            np.testing.assert_allclose(distance, far, atol=1e-7)
            env.step(env.action_space.sample())
            if env.state["done"]:
                break
        env.reset(seed=score + 1)


@pytest.mark.parametrize("game", GAMES, ids=["full", "lite"])
@pytest.mark.parametrize("observation", ["vector", "grid"])
def test_the_other_numbers_are_those_of_other_rewards(observation, game):
    """What an agent has learned to read stays in its place."""
    scored = ArkanoidVectorEnv(2, observation=observation, reward="score", **game)
    plain = ArkanoidVectorEnv(2, observation=observation, **game)
    length = plain.single_observation_space.shape[0]
    assert not set(plain.layout) & {"brick_points", "next_life"}
    assert {name: scored.layout[name] for name in plain.layout} == plain.layout
    one, other = scored.reset(seed=3)[0].copy(), plain.reset(seed=3)[0].copy()
    plain.action_space.seed(3)
    for _ in range(400):
        if observation == "grid":
            one[:, scored.layout["status"], STATUS["next_life"]] = 0.0
        assert (one[:, :length] == other).all()
        actions = plain.action_space.sample()
        one, other = scored.step(actions)[0].copy(), plain.step(actions)[0].copy()


@pytest.mark.parametrize("observation", ["vector", "grid"])
def test_a_restored_game_shows_what_pays(observation):
    env = ArkanoidVectorEnv(3, observation=observation, reward="score", capsule_rate=1.0)
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(200):
        env.step(env.action_space.sample())
    snapshot = env.snapshot()
    actions = [env.action_space.sample() for _ in range(100)]
    first = [env.step(action)[0].copy() for action in actions]
    env.restore(snapshot)
    again = [env.step(action)[0].copy() for action in actions]
    assert all((one == other).all() for one, other in zip(first, again, strict=True))
