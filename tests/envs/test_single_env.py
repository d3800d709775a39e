"""One environment with Gymnasium, down to the oldest version that it runs on.

These tests import nothing that Gymnasium 0.29 has not.
"""

import json
from pathlib import Path

import arkanoid  # noqa: F401
import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.arkanoid_env import _results
from arkanoid.envs.registration import GAMES
from arkanoid.envs.state import INFO_FIELDS
from gymnasium import spaces
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env
from gymnasium.wrappers import TimeAwareObservation


@pytest.mark.parametrize("name", GAMES)
@pytest.mark.usefixtures("dummy_screen")
def test_every_id_is_checked_and_plays(name):
    check_env(gym.make(name, render_mode="rgb_array", render_size=64).unwrapped)
    env = gym.make(name)
    observation, _ = env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(300):
        assert env.observation_space.contains(observation)
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        if terminated or truncated:
            observation, _ = env.reset()
    env.close()


@pytest.mark.parametrize(
    ("name", "actions", "observation"),
    [
        ("Continuous", "Box", (304,)),
        ("LiteContinuous", "Box", (226,)),
        ("Pixels", "Discrete", (4, 84, 84)),
        ("LitePixels", "Discrete", (4, 84, 84)),
        ("NoFrameskip", "Discrete", (210, 160, 3)),
    ],
)
def test_ids_are_what_their_names_say(name, actions, observation):
    env = gym.make(f"arkanoid:Arkanoid{name}-v0")
    assert type(env.action_space).__name__ == actions
    assert env.observation_space.shape == observation
    assert env.unwrapped.config.enemies is not name.startswith("Lite")


@pytest.mark.parametrize("number", [0, 1])
def test_pictures_and_numbers_come_together(number):
    """`dict` is `rgb` and `vector` of the same game, bit for bit."""
    looks = {"size": 42, "grey": True, "stack": 2}
    both = ArkanoidEnv(observation="dict", **looks)
    pictures, numbers = ArkanoidEnv(observation="rgb", **looks), ArkanoidEnv()
    assert both.observation_space == spaces.Dict(
        {"rgb": pictures.observation_space, "vector": numbers.observation_space}
    )
    assert both.layout == {"rgb": pictures.layout, "vector": numbers.layout}
    envs = (both, pictures, numbers)
    seen = [env.reset(seed=number)[0] for env in envs]
    generator = np.random.default_rng(number)
    kept = []
    for _ in range(300):
        assert seen[0]["rgb"].tobytes() == seen[1].tobytes()
        assert seen[0]["vector"].tobytes() == seen[2].tobytes()
        kept.append((seen[0]["vector"], seen[0]["vector"].tobytes()))
        action = int(generator.integers(6))
        steps = [env.step(action) for env in envs]
        seen = [step[0] for step in steps]
        if steps[0][2]:
            seen = [env.reset()[0] for env in envs]
    assert all(array.tobytes() == held for array, held in kept)  # each is the caller's own


def test_a_dict_goes_on_from_snapshots_and_clones():
    env = ArkanoidEnv(observation="dict", size=30, stack=3)
    env.reset(seed=0)
    for _ in range(7):
        env.step(4)
    snapshot, clone = env.snapshot(), env.clone()
    later = env.step(2)[0]
    other = ArkanoidEnv(observation="dict", size=30, stack=3)
    other.restore(snapshot)
    for again in (clone, other):
        seen = again.step(2)[0]
        assert all(seen[name].tobytes() == later[name].tobytes() for name in later)


def test_channels_last_are_the_same_pictures():
    first = ArkanoidEnv(observation="rgb", size=(30, 44), stack=2)
    last = ArkanoidEnv(observation="rgb", size=(30, 44), stack=2, channels="last")
    assert first.observation_space.shape == (6, 30, 44)
    assert last.observation_space.shape == (30, 44, 6)
    one, other = first.reset(seed=0)[0], last.reset(seed=0)[0]
    for action in (3, 4, 4, 5, 1):
        assert other.flags.c_contiguous
        assert np.array_equal(one, other.transpose(2, 0, 1))
        one, other = first.step(action)[0], last.step(action)[0]


def test_channels_last_are_what_render_shows():
    env = ArkanoidEnv(
        observation="rgb",
        size=(120, 90),
        channels="last",
        render_mode="rgb_array",
        render_size=(120, 90),
    )
    seen, _ = env.reset(seed=0)
    for action in (3, 4, 4, 5, 1):
        assert np.array_equal(seen, env.render())
        seen = env.step(action)[0]


@pytest.mark.parametrize(
    ("size", "shape"),
    [(None, (512, 384, 3)), (64, (64, 48, 3)), ((20, 30), (20, 30, 3)), ([8, 9], (8, 9, 3))],
)
def test_frames_are_as_large_as_asked_for(size, shape):
    env = ArkanoidEnv(render_mode="rgb_array", render_size=size)
    env.reset(seed=0)
    assert env.render().shape == shape


@pytest.mark.parametrize(
    ("size", "error"), [(0, ValueError), (1.5, TypeError), ((1, 2, 3), ValueError)]
)
def test_impossible_sizes_of_frames_are_refused(size, error):
    with pytest.raises(error):
        ArkanoidEnv(render_size=size)


def test_the_spec_has_the_limit_and_no_wrapper_counts_again():
    """`TimeAwareObservation` asks the spec for it, and it was None."""
    env = gym.make("Arkanoid-v0", max_decisions=30)
    assert env.spec.max_episode_steps == 30
    assert not isinstance(env, gym.wrappers.TimeLimit)
    env = TimeAwareObservation(env)
    assert env.observation_space.shape == (305,)
    env.reset(seed=0)
    for step in range(1, 31):
        *_, truncated, info = env.step(0)
        assert truncated == (step == 30)
    assert info["truncation"] == 1
    again = gym.make(env.unwrapped.spec)
    again.reset(seed=0)
    steps = 0
    while not truncated or not steps:
        *_, truncated, info = again.step(0)
        steps += 1
    assert steps == 30
    assert info["truncation"] == 1


def test_gymnasiums_own_limit_leaves_info_as_it_is():
    """As documented: `truncation` is the environment's own reason, and 0 where a wrapper cut."""
    env = gym.make("Arkanoid-v0", max_episode_steps=5)
    env.reset(seed=0)
    for _ in range(5):
        *_, truncated, info = env.step(0)
    assert truncated
    assert info["truncation"] == 0


@pytest.mark.parametrize("levels", [range(100, 200), Path("ripple"), [Path("ripple"), "comb"]])
def test_a_spec_is_json_whatever_its_keywords(levels, request):
    env = gym.make("Arkanoid-v0", levels=levels, speed=np.float32(1.5))
    text = env.spec.to_json()
    json.loads(text)
    again = gym.make(EnvSpec.from_json(text))
    assert again.unwrapped.config.plain() == env.unwrapped.config.plain()


@pytest.mark.parametrize(
    ("keywords", "hint"),
    [
        ({"seed": 3}, r"reset\(seed=...\) takes it"),
        ({"thread": 2}, "known are observation"),
        ({"threads": 2}, r"gym.make_vec\(...\) takes it"),
        ({"num_envs": 2}, r"gym.make_vec\(...\) makes several"),
        ({"autoreset_mode": "SameStep"}, r"gym.make_vec\(...\) takes it"),
        ({"repeat_action_probability": 0.25}, "did you mean 'sticky_action'"),
        ({"grayscale": True}, "did you mean 'grey'"),
        ({"terminal_on_life_loss": True}, "did you mean 'episodic_life'"),
        ({"obs_type": "rgb"}, "did you mean 'observation'"),
        ({"render_mod": "human"}, "did you mean 'render_mode'"),
        ({"zzz": 1}, "known are .*render_mode, render_size"),
    ],
)
def test_an_unknown_keyword_is_told_what_it_is_here(keywords, hint):
    with pytest.raises(TypeError, match=hint):
        gym.make("Arkanoid-v0", **keywords)
    with pytest.raises(TypeError, match=hint):
        ArkanoidEnv(**keywords)


def test_gymnasiums_limit_as_a_keyword_is_told_ours():
    with pytest.raises(TypeError, match="did you mean 'max_decisions'"):
        ArkanoidEnv(max_episode_steps=5)


@pytest.mark.parametrize(
    ("keywords", "error", "message"),
    [
        ({"channels": "last"}, ValueError, "channels='last' says how pictures look"),
        ({"observation": "rgb", "channels": "middle"}, ValueError, "'first', 'last'"),
        ({"episodic_life": 1}, TypeError, "episodic_life must be True or False"),
    ],
)
def test_bad_values_of_keywords_are_refused(keywords, error, message):
    with pytest.raises(error, match=message):
        ArkanoidEnv(**keywords)


def test_info_and_results_are_the_fields_of_the_outcome():
    """`step` takes them from the outcome by their places."""
    env = ArkanoidEnv()
    env.reset(seed=0)
    outcomes = env._batch.outcomes
    for number, name in enumerate(outcomes.dtype.names):
        outcomes[name] = number
    (outcome,) = outcomes.tolist()
    reward, *_, info = _results(outcome)
    assert list(info) == list(INFO_FIELDS)
    assert info == {key: outcomes[field][0] for key, field in INFO_FIELDS.items()}
    assert reward == outcomes["reward"][0]
    outcomes["terminated"], outcomes["truncated"] = True, False
    (outcome,) = outcomes.tolist()
    assert _results(outcome)[1:3] == (True, False)
