from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.agents.experiment.settings import BASELINES, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.measure.baselines import (
    BallFollower,
    NoOp,
    RandomPolicy,
    make_baseline,
)
from arkanoid.agents.measure.episodes import play_episodes
from arkanoid.agents.measure.policy import encode_actions
from arkanoid.agents.measure.suites import find_starts

LAYOUT = {"paddle": slice(0, 2), "ball_x": slice(4, 6), "ball_y": slice(6, 8)}
THREE, FOUR, SIX = gym.spaces.Discrete(3), gym.spaces.Discrete(4), gym.spaces.Discrete(6)
BOX: Any = gym.spaces.Box(-1, 1, (2,), np.float32)
NO_OP, LEFT, RIGHT = 0, 1, 2


def test_the_ball_follower_follows_the_first_ball() -> None:
    observations = np.zeros((4, 8), np.float32)
    observations[:, 0] = [0.0, 0.0, 0.5, -0.5]
    observations[:, 4] = [0.5, -0.5, 0.51, -0.51]
    # The second ball is elsewhere.
    observations[:, 5] = -observations[:, 4]
    follower = BallFollower(THREE, LAYOUT, reach=0.14)
    assert follower(observations, np.arange(4)).tolist() == [RIGHT, LEFT, NO_OP, NO_OP]


def test_random_play_draws_every_action_equally_often_and_repeats_by_seed() -> None:
    worlds = np.arange(6000)
    observations = np.zeros((6000, 1))
    actions = RandomPolicy(THREE, 6000, seed=1)(observations, worlds)
    # Six standard deviations of a binomial count.
    assert (np.abs(np.bincount(actions, minlength=3) - 2000) < 6 * np.sqrt(6000 * 2 / 9)).all()
    again = RandomPolicy(THREE, 6000, seed=1)(observations, worlds)
    np.testing.assert_array_equal(actions, again)
    assert (actions != RandomPolicy(THREE, 6000, seed=2)(observations, worlds)).any()


@pytest.mark.parametrize("space", [SIX, BOX])
def test_a_worlds_random_actions_do_not_depend_on_who_else_still_plays(space: Any) -> None:
    one, other = (RandomPolicy(space, 5, seed=3) for _ in range(2))
    for _ in range(20):
        everybody = one(np.zeros((5, 1)), np.arange(5))
        some = other(np.zeros((2, 1)), np.array([1, 4]))
        np.testing.assert_array_equal(everybody[[1, 4]], some)
        assert all(space.contains(action) for action in everybody)


def test_no_op_does_nothing() -> None:
    assert NoOp(SIX)(np.zeros((3, 5)), np.arange(3)).tolist() == [NO_OP] * 3
    np.testing.assert_array_equal(NoOp(BOX)(np.zeros((3, 5)), np.arange(3)), [[0, -1]] * 3)


def test_discrete_moves_go_all_the_way_or_not_at_all() -> None:
    moves = np.array([-3, -0.51, -0.49, 0, 0.49, 0.51, 3])
    assert encode_actions(THREE, moves).tolist() == [1, 1, 0, 0, 0, 2, 2]
    assert encode_actions(THREE, moves, fire=True).tolist() == [1, 1, 0, 0, 0, 2, 2]
    assert encode_actions(SIX, moves).tolist() == [1, 1, 0, 0, 0, 2, 2]
    assert encode_actions(SIX, moves, fire=True).tolist() == [4, 4, 3, 3, 3, 5, 5]
    # No-op, fire, right, left: no action moves and fires.
    assert encode_actions(FOUR, moves).tolist() == [3, 3, 0, 0, 0, 2, 2]
    assert encode_actions(FOUR, moves, fire=True).tolist() == [3, 3, 1, 1, 1, 2, 2]
    velocities = encode_actions(BOX, moves, fire=True)
    np.testing.assert_allclose(velocities[:, 0], [-1, -0.51, -0.49, 0, 0.49, 0.51, 1])
    assert (velocities[:, 1] == 1).all()


def test_a_layout_without_the_ball_is_refused() -> None:
    with pytest.raises(KeyError, match="ball_x"):
        BallFollower(THREE, {"paddle": slice(0, 1)}, 0.14)


@pytest.mark.parametrize("actions", ["discrete3", "discrete4", "discrete6", "box"])
@pytest.mark.parametrize("name", BASELINES)
def test_every_baseline_plays_with_every_kind_of_action(name: str, actions: str) -> None:
    overrides = [("env_id", "Arkanoid-v0"), ("env.actions", actions), ("env.max_decisions", "40")]
    worlds = make_worlds(load_experiment("quick", overrides), 2)
    played = play_episodes(worlds, make_baseline(name, worlds, 0), [5, 6])
    assert (played["steps"] <= 40).all()


def test_the_planner_is_an_upper_bound() -> None:
    """It loses no ball, and it clears levels much faster than the ball-follower.

    The ball-follower sometimes loses a life on each of these levels. The planner never does,
    because it foresees exactly what happens.
    """
    full = [("env_id", "Arkanoid-v0"), ("env.actions", "discrete6")]
    experiment = load_experiment("quick", full)
    starts = find_starts(experiment, ["ripple", "comb", "warden"])
    worlds = make_worlds(experiment, len(starts))
    planned, followed = (
        play_episodes(worlds, make_baseline(name, worlds, 0), [20], starts, whole_games=False)
        for name in ("planner", "ball-follower")
    )
    assert (planned["cleared"] == 1).all()
    assert (planned["lives"] >= 3).all()
    assert planned["steps"].sum() * 1.5 < followed["steps"].sum()
