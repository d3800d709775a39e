"""The forms of actions: what is taken, what is clipped, what is refused and in which words."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.actions import COMMANDS, action_meanings
from gymnasium.wrappers import RescaleAction


def observed(env, action):
    env.reset(seed=1)
    for _ in range(4):
        observation = env.step(action)[0]
    return observation.tobytes()


@pytest.mark.parametrize("form", [np.int64, np.int8, np.uint32, np.array])
def test_numpys_integers_are_actions(form):
    env = ArkanoidEnv()
    assert observed(env, form(2)) == observed(env, 2)


def test_torchs_tensors_are_actions():
    torch = pytest.importorskip("torch")
    env = ArkanoidEnv()
    assert observed(env, torch.tensor(4)) == observed(env, 4)
    env = ArkanoidEnv(actions="box")
    assert observed(env, torch.tensor([0.5, 1.0])) == observed(env, [0.5, 1.0])


@pytest.mark.parametrize(
    "action",
    [[1], np.array([1]), True, np.True_, np.array(True), 1.0, np.float32(1), None, "1", {}],
)
def test_what_is_no_integer_is_refused_and_the_space_named(action):
    env = ArkanoidEnv()
    env.reset(seed=0)
    with pytest.raises(TypeError, match=r"is not in Discrete\(6\): it must be one integer"):
        env.step(action)


def test_a_tensor_with_an_axis_is_refused_as_an_array_is():
    """torch.tensor([1]) was taken, and np.array([1]) was not."""
    torch = pytest.importorskip("torch")
    env = ArkanoidEnv()
    env.reset(seed=0)
    for action in (torch.tensor([1]), torch.tensor([[1]]), torch.tensor(True), torch.tensor(1.0)):
        with pytest.raises(TypeError, match=r"is not in Discrete\(6\): it must be one integer"):
            env.step(action)


@pytest.mark.parametrize("action", [-1, 3, np.int64(7)])
def test_an_action_out_of_range_is_refused_and_the_space_named(action):
    env = ArkanoidEnv(actions="discrete3")
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"action .* is not in Discrete\(3\)$"):
        env.step(action)


@pytest.mark.parametrize("action", [1, [0.5], [[0.5, 1.0]], [0.1, 0.2, 0.3], ["0", "1"], None])
def test_what_is_not_velocity_and_fire_is_refused_and_the_space_named(action):
    env = ArkanoidEnv(actions="box")
    env.reset(seed=0)
    with pytest.raises(TypeError, match=r"is not in Box\(-1.0, 1.0, \(2,\), float32\)"):
        env.step(action)


@pytest.mark.parametrize(
    ("beyond", "at"),
    [
        ([1.5, 2.0], [1.0, 1.0]),
        ([-np.inf, -3.0], [-1.0, -1.0]),
        ([1e300, -1e300], [1.0, -1.0]),
        ([np.nextafter(np.float32(1), np.float32(2)), 0.5], [1.0, 1.0]),
    ],
)
def test_velocities_beyond_the_bounds_count_as_at_them(beyond, at):
    env = ArkanoidEnv(actions="box")
    assert observed(env, np.array(beyond)) == observed(env, np.array(at, np.float32))


def test_rescaled_actions_are_never_refused():
    """Float32 rounding in `RescaleAction` made legal actions illegal, a tenth of a millionth out.

    Agents whose scale is another one died in their first steps.
    """
    env = RescaleAction(ArkanoidEnv(actions="box"), np.float32(-0.3), np.float32(0.7))
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(200):
        for action in (env.action_space.sample(), env.action_space.high, env.action_space.low):
            if env.step(action)[2]:
                env.reset()


@pytest.mark.parametrize("actions", COMMANDS)
def test_meanings_say_what_the_actions_do(actions):
    env = ArkanoidEnv(actions=actions, frame_skip=1)
    words = env.get_action_meanings()
    assert words == action_meanings(actions)
    assert len(words) == env.action_space.n
    assert words[0] == "NOOP"
    paddle, held = env.layout["paddle"].start, env.layout["ball_held"].start
    for action, word in enumerate(words):
        before = env.reset(seed=0)[0]
        after = env.step(action)[0]
        assert np.sign(after[paddle] - before[paddle]) == ("RIGHT" in word) - ("LEFT" in word)
        assert (after[held] == 0.0) == ("FIRE" in word)


def test_fire_is_where_atari_has_it():
    assert action_meanings("discrete4") == ["NOOP", "FIRE", "RIGHT", "LEFT"]


def test_continuous_actions_have_no_meanings():
    with pytest.raises(ValueError, match="actions='box' are continuous"):
        ArkanoidEnv(actions="box").get_action_meanings()
