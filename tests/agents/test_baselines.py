import numpy as np
import pytest
from arkanoid.agents.baselines import LEFT, NO_OP, RIGHT, BallFollower, RandomPolicy, no_op

LAYOUT = {"paddle": slice(0, 2), "ball_x": slice(4, 6), "ball_y": slice(6, 8)}


def test_the_ball_follower_goes_where_the_first_ball_is() -> None:
    observations = np.zeros((4, 8), np.float32)
    observations[:, 0] = [0.0, 0.0, 0.5, -0.5]
    observations[:, 4] = [0.5, -0.5, 0.51, -0.51]
    # The second ball is elsewhere.
    observations[:, 5] = -observations[:, 4]
    assert BallFollower(LAYOUT)(observations).tolist() == [RIGHT, LEFT, NO_OP, NO_OP]


def test_random_play_draws_every_action_equally_often_and_repeats_by_seed() -> None:
    observations = np.zeros((6000, 1))
    actions = RandomPolicy(3, seed=1)(observations)
    # Six standard deviations of a binomial count.
    assert (np.abs(np.bincount(actions, minlength=3) - 2000) < 6 * np.sqrt(6000 * 2 / 9)).all()
    np.testing.assert_array_equal(actions, RandomPolicy(3, seed=1)(observations))
    assert (actions != RandomPolicy(3, seed=2)(observations)).any()


def test_no_op_watches() -> None:
    assert no_op(np.zeros((3, 5))).tolist() == [NO_OP] * 3


def test_a_layout_without_the_ball_is_refused() -> None:
    with pytest.raises(KeyError, match="ball_x"):
        BallFollower({"paddle": slice(0, 1)})
