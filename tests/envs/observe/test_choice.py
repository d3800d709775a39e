"""What all kinds of observations have in common, and which choices are refused."""

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from gymnasium.utils.env_checker import check_env
from helpers.plays import EVERYTHING, play
from helpers.processes import COMPILED, INTERPRETED, run_program
from helpers.states import latest_observations

KINDS = [
    {"observation": "grid"},
    {"observation": "grid", "capsules": False, "enemies": False},
    {"observation": "rgb", "grey": True, "stack": 4},
    {"observation": "rgb", "size": (50, 40)},
]


@pytest.mark.parametrize("kind", KINDS)
def test_without_copies_the_memory_is_the_same(kind):
    for copy in (True, False):
        env = ArkanoidVectorEnv(2, copy=copy, **kind)
        first = env.reset(seed=0)[0]
        second = env.step(np.array([1, 2]))[0]
        assert np.may_share_memory(first, second) is not copy
        assert env.observation_space.contains(second)


@pytest.mark.parametrize("kind", KINDS)
def test_a_restored_state_goes_on_bit_for_bit(kind):
    """From any place of the row in which a stack moves, into an environment with a past."""
    env, other = ArkanoidEnv(**EVERYTHING, **kind), ArkanoidEnv(**EVERYTHING, **kind)
    for _ in play(other, 60, seed=9):
        pass
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(25):
        for _ in range(3):
            env.step(env.action_space.sample())
            if env.state["done"]:
                env.reset()
        shown, _ = other.restore(env.snapshot())
        assert shown.tobytes() == latest_observations(env)[0].tobytes()
        branch = env.clone()
        for _ in range(7):
            action = env.action_space.sample()
            expected = env.step(action)[0].tobytes()
            assert other.step(action)[0].tobytes() == expected
            assert branch.step(action)[0].tobytes() == expected
            if env.state["done"]:
                assert other.reset(seed=5)[0].tobytes() == env.reset(seed=5)[0].tobytes()
                branch.reset(seed=5)


@pytest.mark.parametrize("kind", KINDS)
def test_neither_batch_size_nor_threads_change_a_bit(kind):
    envs = [
        ArkanoidVectorEnv(count, threads=threads, copy=copy, **EVERYTHING, **kind)
        for count, threads, copy in [(90, 1, True), (90, 2, True), (90, 7, False), (1, 1, False)]
    ]
    for env in envs:
        env.reset(seed=5)
    generator = np.random.default_rng(0)
    for _ in range(250):
        actions = generator.integers(0, 6, 90)
        shown = [env.step(actions[: env.num_envs])[0] for env in envs]
        for other in shown[1:]:
            assert (shown[0][: len(other)] == other).all()
    for env in envs:
        env.close()


PROGRAM = """
import hashlib
from arkanoid.envs import ArkanoidVectorEnv
digest = hashlib.sha256()
for kind in ({"observation": "grid"}, {"observation": "rgb", "grey": True, "stack": 2, "size": 28},
             {"observation": "rgb", "size": (20, 24)}):
    for level in ("vault", "warden"):
        env = ArkanoidVectorEnv(2, capsule_rate=1.0, speed=4.0, max_decisions=25, **kind)
        digest.update(env.reset(seed=1, options={"level": level})[0].tobytes())
        env.action_space.seed(0)
        for _ in range(30):
            digest.update(env.step(env.action_space.sample())[0].tobytes())
print(digest.hexdigest())
"""


def test_compiled_and_interpreted_give_the_same_bits():
    digests = {
        run_program(PROGRAM, warnings="default", changes=changes).stdout
        for changes in (COMPILED, INTERPRETED)
    }
    assert len(digests) == 1


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.usefixtures("dummy_screen")
def test_gymnasium_accepts_it(kind):
    check_env(gym.make("Arkanoid-v0", **kind).unwrapped)
    env = gym.make("Arkanoid-v0", **kind)
    restored = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert restored.unwrapped.config == env.unwrapped.config
    shape = env.observation_space.shape
    wrapped = gym.wrappers.FrameStackObservation(env, 3)
    assert wrapped.reset(seed=0)[0].shape == (3, *shape)
    wrapped = gym.wrappers.FlattenObservation(env)
    assert wrapped.reset(seed=0)[0].shape == (np.prod(shape),)
    envs = gym.make_vec("Arkanoid-v0", 2, vectorization_mode="vector_entry_point", **kind)
    assert envs.reset(seed=0)[0].shape == (2, *shape)


@pytest.mark.parametrize("kind", KINDS)
def test_stable_baselines3_accepts_it(kind):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    env = gym.make("Arkanoid-v0", **kind)
    if kind["observation"] == "rgb":
        checker.check_env(env, skip_render_check=True)
        return
    # Whatever has three axes and is no picture is taken for one: it only says so.
    with pytest.warns(UserWarning, match="an image"):
        checker.check_env(env, skip_render_check=True)


def test_stable_baselines3_learns_from_pictures_as_they_are():
    """Channels come first, and no wrapper has to turn them round."""
    stable_baselines3 = pytest.importorskip("stable_baselines3")
    from arkanoid.agents.adapter import GymnasiumVecEnv

    env = GymnasiumVecEnv(
        ArkanoidVectorEnv(
            4, autoreset_mode="SameStep", copy=False, observation="rgb", grey=True, stack=4
        )
    )
    model = stable_baselines3.PPO("CnnPolicy", env, n_steps=64, batch_size=64, n_epochs=1, seed=0)
    assert model.observation_space.shape == (4, 84, 84)
    assert model.get_env() is env
    model.learn(512)
    assert model.num_timesteps == 512


@pytest.mark.parametrize(
    ("keywords", "error", "message"),
    [
        ({"observation": "pixels"}, ValueError, "'vector', 'grid', 'rgb'"),
        ({"size": 64}, ValueError, "size=64 says how pictures look, and observation='vector'"),
        ({"observation": "grid", "landing": True}, ValueError, "landing=True adds numbers to vec"),
        ({"landing": 1}, TypeError, "landing"),
        ({"observation": "grid", "stack": 4}, ValueError, "stack=4 says how pictures look"),
        ({"grey": True}, ValueError, "use observation='rgb'"),
        ({"observation": "rgb", "size": 0}, ValueError, "size must be between 1 and 4096"),
        ({"observation": "rgb", "size": (84,)}, ValueError, r"an integer or \(height, width\)"),
        ({"observation": "rgb", "size": "84"}, TypeError, r"an integer or \(height, width\)"),
        ({"observation": "rgb", "size": 84.0}, TypeError, r"an integer or \(height, width\)"),
        ({"observation": "rgb", "size": (84, 8.0)}, TypeError, "size must be an integer"),
        ({"observation": "rgb", "size": True}, TypeError, "size must be an integer"),
        ({"observation": "rgb", "grey": 1}, TypeError, "grey must be True or False"),
        ({"observation": "rgb", "stack": 0}, ValueError, "stack must be between 1 and 64"),
        ({"observation": "rgb", "stack": 2.0}, TypeError, "stack must be an integer"),
    ],
)
def test_bad_keywords_are_refused(keywords, error, message):
    with pytest.raises(error, match=message):
        ArkanoidEnv(**keywords)
