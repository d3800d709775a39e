"""Attributes, calls, specs and frames: what Gymnasium's own vector environments have, too."""

import json

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode, SyncVectorEnv

NATIVE = {"vectorization_mode": "vector_entry_point"}


@pytest.fixture
def pair():
    """Return the native vector environment and Gymnasium's own of single ones, after some steps."""
    native = ArkanoidVectorEnv(3, render_mode="rgb_array", render_size=32, speed=2.0)
    single = SyncVectorEnv(
        [lambda: ArkanoidEnv(render_mode="rgb_array", render_size=32, speed=2.0)] * 3
    )
    for env in (native, single):
        env.reset(seed=4)
        for _ in range(5):
            env.step(np.array([1, 2, 5]))
    return native, single


@pytest.mark.parametrize(
    "name", ["config", "layout", "render_mode", "observation_space", "action_space"]
)
def test_attributes_are_those_of_single_environments(pair, name):
    native, single = pair
    assert native.get_attr(name) == single.get_attr(name)
    assert native.call(name) == single.call(name)


def test_calls_are_those_of_single_environments(pair):
    native, single = pair
    assert native.call("get_action_meanings") == single.call("get_action_meanings")
    for one, other in zip(native.call("action_masks"), single.call("action_masks"), strict=True):
        assert np.array_equal(one, other)
    for one, other in zip(native.call("render"), single.call("render"), strict=True):
        assert np.array_equal(one, other)
    for snapshot, seen in zip(native.call("snapshot"), native.step([0, 0, 0])[0], strict=True):
        env = ArkanoidEnv(speed=2.0)
        env.restore(snapshot)
        assert env.step(0)[0].tobytes() == seen.tobytes()
    assert ArkanoidVectorEnv(2).call("render") == (None, None)


def test_attributes_can_be_set(pair):
    native, single = pair
    for env in pair:
        env.set_attr("stage", [1, 2, 3])
        env.set_attr("teacher", "me")
    for name in ("stage", "teacher"):
        assert native.get_attr(name) == single.get_attr(name)
    native.set_attr("render_mode", None)
    assert native.render() is None
    with pytest.raises(ValueError, match="2 values for 3 worlds"):
        native.set_attr("stage", [1, 2])
    with pytest.raises(ValueError, match="all worlds share 'render_mode'"):
        native.set_attr("render_mode", [None, None, "rgb_array"])
    with pytest.raises(AttributeError, match="no_such"):
        native.get_attr("no_such")


OWN = ["num_envs", "config", "action_space", "single_action_space", "observation_space"]
OWN += ["single_observation_space", "autoreset_mode", "spec", "metadata", "layout", "state"]
OWN += ["step", "reset", "closed", "np_random", "unwrapped", "_batch"]


@pytest.mark.parametrize("name", OWN)
def test_what_the_environment_says_of_itself_can_not_be_set(name):
    """num_envs=7 was taken, and the next step raised an error about shapes."""
    env = ArkanoidVectorEnv(2)
    before = env.get_attr("num_envs"), env.config, env.metadata
    for values in (7, [7, 7], [None, 7]):
        with pytest.raises(
            AttributeError, match=f"'{name}' of a vector .*'render_mode' and 'copy'"
        ):
            env.set_attr(name, values)
    assert (env.get_attr("num_envs"), env.config, env.metadata) == before


def test_what_can_be_set_is_checked():
    env = ArkanoidVectorEnv(2)
    env.reset(seed=0)
    with pytest.raises(ValueError, match="render_mode must be None or one of"):
        env.set_attr("render_mode", "human")
    with pytest.raises(TypeError, match="copy must be True or False"):
        env.set_attr("copy", "no")
    env.set_attr("render_mode", "rgb_array")
    assert len(env.render()) == 2
    env.set_attr("copy", False)
    assert np.shares_memory(env.step([0, 0])[0], env.step([0, 0])[0])


def test_the_metadata_names_no_window():
    """A vector environment refuses ``"human"``, and its metadata listed it."""
    env = ArkanoidVectorEnv(2)
    assert env.metadata["render_modes"] == ["rgb_array"]
    for mode in env.metadata["render_modes"]:
        ArkanoidVectorEnv(2, render_mode=mode)


def test_frames_are_as_large_as_asked_for():
    env = gym.make_vec("Arkanoid-v0", 2, **NATIVE, render_mode="rgb_array", render_size=(20, 30))
    env.reset(seed=0)
    assert [frame.shape for frame in env.render()] == [(20, 30, 3)] * 2


@pytest.mark.parametrize("mode", ["SameStep", AutoresetMode.SAME_STEP])
def test_the_spec_makes_the_same_again(mode):
    env = gym.make_vec("Arkanoid-v0", 3, **NATIVE, autoreset_mode=mode, max_decisions=70)
    assert env.spec.max_episode_steps == 70
    json.loads(env.spec.to_json())
    again = gym.make_vec(EnvSpec.from_json(env.spec.to_json()))
    assert isinstance(again, ArkanoidVectorEnv)
    assert (again.num_envs, again.config) == (3, env.config)
    assert again.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP


def test_a_limit_for_wrappers_is_told_the_keyword():
    with pytest.raises(ValueError, match="here use max_decisions=50"):
        gym.make_vec("Arkanoid-v0", 2, **NATIVE, max_episode_steps=50)


def test_a_wrong_autoreset_mode_is_told_the_legal_names():
    with pytest.raises(ValueError, match="one of 'NextStep', 'SameStep', 'Disabled'; got"):
        ArkanoidVectorEnv(2, autoreset_mode="same_step")


def test_an_unknown_keyword_is_told_what_it_is_here():
    with pytest.raises(TypeError, match="did you mean 'threads'"):
        ArkanoidVectorEnv(2, thread=2)


def test_without_copies_a_dict_shows_the_same_memory():
    env = ArkanoidVectorEnv(2, copy=False, observation="dict", size=20)
    seen, _ = env.reset(seed=0)
    held = seen["vector"].copy()
    env.step([4, 4])
    assert not np.array_equal(seen["vector"], held)
    own = ArkanoidVectorEnv(2, observation="dict", size=20)
    seen, _ = own.reset(seed=0)
    own.step([4, 4])
    assert np.array_equal(seen["vector"], held)


def test_threads_and_snapshots_keep_every_bit_of_a_dict():
    looks = {"observation": "dict", "size": 24, "stack": 2, "lives": 1, "speed": 3.0}
    one, other = (ArkanoidVectorEnv(9, threads=threads, **looks) for threads in (1, 4))
    seen = [env.reset(seed=0)[0] for env in (one, other)]
    generator = np.random.default_rng(0)
    for step in range(120):
        actions = generator.integers(0, 6, 9)
        if step == 60:
            other.restore(one.snapshot())
        seen = [env.step(actions)[0] for env in (one, other)]
        for name in ("rgb", "vector"):
            assert seen[0][name].tobytes() == seen[1][name].tobytes()
    one.close()
    other.close()


@pytest.mark.parametrize(
    ("num_envs", "error"), [(1.5, TypeError), (True, TypeError), (0, ValueError)]
)
def test_the_number_of_worlds_is_checked(num_envs, error):
    """1.5 gave an error about '2272.0', the size of memory, instead of one about the keyword."""
    with pytest.raises(error, match="num_envs must be"):
        ArkanoidVectorEnv(num_envs)
