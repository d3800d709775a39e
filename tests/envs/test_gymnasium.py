"""The environments keep Gymnasium's and stable-baselines3's contracts."""

import arkanoid  # noqa: F401
import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

# Episodes that end often, in both ways, and use every random draw.
LIVELY = {"lives": 1, "max_decisions": 60, "sticky_action": 0.25, "speed": 3.0}
# Games of all kinds, with as much in them as there can be.
GAMES = [
    LIVELY | {"capsules": False, "enemies": False, "levels": "ripple"},
    LIVELY | {"capsule_rate": 1.0, "levels": "seeds:0-99", "max_decisions": 300, "lives": 2},
    LIVELY | {"levels": ["warden", "vault"], "actions": "box", "max_decisions": 200},
    LIVELY | {"observation": "grid", "capsule_rate": 1.0},
    LIVELY | {"observation": "rgb", "size": 42, "grey": True, "stack": 4, "capsule_rate": 1.0},
    LIVELY | {"observation": "rgb", "size": (30, 40)},
    LIVELY | {"observation": "dict", "size": 42, "stack": 3, "lives": 4, "episodic_life": True},
    LIVELY | {"observation": "rgb", "size": 30, "channels": "last", "actions": "discrete4"},
]


@pytest.mark.parametrize("name", ["Arkanoid-v0", "ArkanoidLite-v0"])
@pytest.mark.parametrize("actions", ["discrete6", "discrete4", "discrete3", "box"])
@pytest.mark.usefixtures("dummy_screen")
def test_gymnasium_env_checker(name, actions):
    env = gym.make(name, actions=actions, render_mode="rgb_array")
    check_env(env.unwrapped)
    env.close()
    env.close()


@pytest.mark.parametrize("actions", ["discrete6", "box"])
def test_stable_baselines3_env_checker(actions):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    checker.check_env(gym.make("Arkanoid-v0", actions=actions, render_mode="rgb_array"))


@pytest.mark.parametrize("levels", ["campaign", "seeds:100-200", "comb", ["ripple", "vault"]])
def test_spec_survives_json(levels):
    env = gym.make("Arkanoid-v0", frame_skip=2, levels=levels, difficulty=0.5, capsule_rate=0.3)
    restored = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert restored.unwrapped.config == env.unwrapped.config


def test_make_with_module_prefix():
    assert isinstance(gym.make("arkanoid:Arkanoid-v0").unwrapped, ArkanoidEnv)


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_make_vec_is_native(mode):
    env = gym.make_vec(
        "Arkanoid-v0", 3, vectorization_mode="vector_entry_point", autoreset_mode=mode.value
    )
    assert isinstance(env, ArkanoidVectorEnv)
    assert env.metadata["autoreset_mode"] is mode
    observations, _ = env.reset(seed=1)
    assert env.observation_space.contains(observations)
    env.close()


def test_render_fps_is_an_integer_that_follows_the_frame_skip():
    env = ArkanoidEnv(frame_skip=2)
    assert type(env.metadata["render_fps"]) is int
    assert env.metadata["render_fps"] == 30


def make_pair(count, mode, **keywords):
    """Return the native vector env and Gymnasium's own of single ones."""
    native = ArkanoidVectorEnv(count, autoreset_mode=mode, **keywords)
    single = SyncVectorEnv([lambda: ArkanoidEnv(**keywords)] * count, autoreset_mode=mode)
    return native, single


def assert_same(one, other):
    """Assert that two nested results hold the same bits, dtypes and keys."""
    assert type(one) is type(other)
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        for key in one:
            assert_same(one[key], other[key])
    elif isinstance(one, (tuple, list)) or (isinstance(one, np.ndarray) and one.dtype == object):
        assert len(one) == len(other)
        for first, second in zip(one, other, strict=True):
            assert_same(first, second)
    elif isinstance(one, np.ndarray):
        assert one.dtype == other.dtype
        assert one.tobytes() == other.tobytes()
    else:
        assert one == other


# The slow ones add up to over two million steps.
@pytest.mark.parametrize("steps", [2000, pytest.param(25_000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("game", GAMES)
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_native_equals_sync(mode, game, steps):
    native, single = make_pair(7, mode, **game)
    assert_same(native.reset(seed=3), single.reset(seed=3))
    native.action_space.seed(0)
    ends = 0
    for _ in range(steps):
        actions = native.action_space.sample()
        result = native.step(actions)
        assert_same(result, single.step(actions))
        ends += result[2].sum() + result[3].sum()
    assert ends > 40


@pytest.mark.parametrize("game", GAMES)
def test_native_equals_sync_when_the_user_resets(game):
    native, single = make_pair(5, AutoresetMode.DISABLED, **game)
    assert_same(native.reset(seed=[9, 8, 7, 6, 5]), single.reset(seed=[9, 8, 7, 6, 5]))
    native.action_space.seed(0)
    resets = 0
    for _ in range(1000):
        actions = native.action_space.sample()
        result = native.step(actions)
        assert_same(result, single.step(actions))
        done = result[2] | result[3]
        if done.any():
            resets += 1
            seeds = [100 + resets if index % 2 else None for index in range(5)]
            assert_same(
                native.reset(seed=seeds, options={"reset_mask": done}),
                single.reset(seed=seeds, options={"reset_mask": done}),
            )
    assert resets > 10


def test_a_finished_world_must_be_reset_in_disabled_mode():
    env = ArkanoidVectorEnv(2, autoreset_mode="Disabled", max_decisions=1)
    env.reset(seed=0)
    env.step(np.zeros(2, int))
    with pytest.raises(ResetNeeded, match="reset_mask"):
        env.step(np.zeros(2, int))


def play(env, steps, seed):
    """Return all that a vector env's worlds show over a fixed random play."""
    generator = np.random.default_rng(0)
    shown = [env.reset(seed=seed)[0].copy()]
    for _ in range(steps):
        # Each world's actions depend on its own index only, never on the batch's size.
        actions = generator.integers(0, 6, 1024)[: env.num_envs]
        observations, rewards, *_ = env.step(actions)
        shown += [observations.copy(), rewards[:, None].astype(np.float32)]
    env.close()
    return shown


@pytest.mark.parametrize("game", GAMES[:2])
def test_neither_batch_size_nor_threads_change_a_bit(game):
    reference = play(ArkanoidVectorEnv(1024, threads=1, **game), 200, 5)
    for count, threads, copy in [(1024, 2, True), (1024, 7, False), (33, 2, True), (1, 1, True)]:
        other = play(ArkanoidVectorEnv(count, threads=threads, copy=copy, **game), 200, 5)
        for one, two in zip(reference, other, strict=True):
            assert one[:count].tobytes() == two.tobytes()


def test_copy_decides_who_owns_the_observations():
    for copy in (True, False):
        env = ArkanoidVectorEnv(2, copy=copy)
        first, _ = env.reset(seed=0)
        second = env.step(np.array([1, 2]))[0]
        assert np.shares_memory(first, second) is not copy


def test_single_env_returns_fresh_observations_and_infos():
    env = ArkanoidEnv()
    first, info = env.reset(seed=0)
    second, _, _, _, later = env.step(1)
    assert not np.shares_memory(first, second)
    assert info is not later


def test_no_seed_goes_on_and_unseeded_envs_differ():
    first, second = ArkanoidEnv(), ArkanoidEnv()
    served = []
    for env in (first, second):
        env.reset()
        for _ in range(20):
            observation = env.step(3)[0]
        served.append(observation[env.layout["ball_vx"]][0])
    assert served[0] != served[1]


@pytest.mark.parametrize(
    ("keywords", "error", "message"),
    [
        ({"frame_skp": 2}, TypeError, "did you mean 'frame_skip'"),
        ({"frame_skip": 0}, ValueError, "frame_skip must be between 1"),
        ({"frame_skip": 2.0}, TypeError, "frame_skip must be an integer"),
        ({"speed": float("nan")}, ValueError, "speed must be between"),
        ({"speed": "fast"}, TypeError, "speed must be a number"),
        ({"sticky_action": 1.5}, ValueError, "sticky_action must be between 0 and 1"),
        ({"actions": "buttons"}, ValueError, "'discrete6', 'discrete4', 'discrete3', 'box'"),
        ({"capsules": 1}, TypeError, "capsules must be True or False"),
        ({"enemies": "no"}, TypeError, "enemies must be True or False"),
        ({"capsule_rate": 1.2}, ValueError, "capsule_rate must be between 0 and 1"),
        ({"difficulty": -0.1}, ValueError, "difficulty must be between 0 and 1"),
        ({"levels": ["riple"]}, ValueError, "Did you mean 'ripple'"),
        ({"levels": "riple"}, ValueError, "Did you mean 'ripple'"),
        ({"levels": []}, TypeError, "levels must be 'campaign', 'train', 'test'"),
        ({"levels": ""}, TypeError, "levels must be 'campaign', 'train', 'test'"),
        ({"levels": [1]}, TypeError, "levels must hold names or paths as text"),
        ({"render_mode": "ansi"}, ValueError, "render_mode must be None or one of"),
    ],
)
def test_bad_keywords_are_refused(keywords, error, message):
    with pytest.raises(error, match=message):
        ArkanoidEnv(**keywords)
    with pytest.raises(error, match=message):
        ArkanoidVectorEnv(2, **keywords)


def test_an_unknown_keyword_is_refused_in_pythons_own_words():
    """TorchRL's `GymEnv` could not make the environment.

    It tries the keyword ``frameskip``, and goes on without it if the `TypeError` is the one that a
    function with plain arguments raises. Ours had words of its own.
    """

    def plain():
        pass

    with pytest.raises(TypeError) as expected:
        plain(frameskip=1)
    words = str(expected.value).partition("() ")[2]
    with pytest.raises(TypeError, match=words):
        gym.make("Arkanoid-v0", frameskip=1)


def test_bad_arguments_of_the_vector_env_are_refused():
    with pytest.raises(ValueError, match="num_envs"):
        ArkanoidVectorEnv(0)
    with pytest.raises(ValueError, match="threads"):
        ArkanoidVectorEnv(1, threads=0)
    env = ArkanoidVectorEnv(2, autoreset_mode="Disabled")
    with pytest.raises(ValueError, match="1 seed for 2 worlds"):
        env.reset(seed=[1])
    with pytest.raises(TypeError, match="NumPy array of bool"):
        env.reset(options={"reset_mask": [True, False]})
    with pytest.raises(ValueError, match="shape"):
        env.reset(options={"reset_mask": np.zeros(2, bool)})
    with pytest.raises(ValueError, match="unknown reset option 'levle'"):
        env.reset(options={"levle": 1})


def test_an_env_whose_keywords_were_refused_is_closed_in_silence():
    """Gymnasium 1.2 closes a vector environment when it is deleted, also one that was never made.

    After a misspelt keyword's own error there was a second one, "Exception ignored in
    VectorEnv.__del__: no attribute '_batch'", where RLlib's pinned Gymnasium was installed.
    """
    never_made = ArkanoidVectorEnv.__new__(ArkanoidVectorEnv)
    never_made.close()
    assert never_made.closed


@pytest.mark.parametrize("action", [-1, 6])
def test_illegal_actions_are_refused(action):
    env = ArkanoidEnv()
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"not in Discrete\(6\)"):
        env.step(action)
    envs = ArkanoidVectorEnv(2)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match=rf"action {action} of world 1 is not in Discrete\(6\)"):
        envs.step(np.array([0, action]))
    with pytest.raises(ValueError, match="2 integers, one for each world"):
        envs.step(np.zeros(3, int))
    with pytest.raises(ValueError, match="2 integers, one for each world"):
        envs.step(np.zeros(2))


@pytest.mark.parametrize("action", [[0.0, float("nan")], [float("nan"), 0.0]])
def test_velocities_that_are_no_numbers_are_refused(action):
    env = ArkanoidEnv(actions="box")
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"is not in Box\(-1.0, 1.0, \(2,\), float32\): .* NaN"):
        env.step(np.array(action))
    envs = ArkanoidVectorEnv(2, actions="box")
    envs.reset(seed=0)
    with pytest.raises(ValueError, match=r"of world 1 is not in Box\(.* NaN"):
        envs.step(np.array([[0.0, 0.0], action]))
    with pytest.raises(ValueError, match="velocity and fire of each world"):
        envs.step(np.zeros(2))


def test_velocities_move_the_paddle_and_fire_serves():
    """The same as the buttons where there is a button, and anything between."""
    box, buttons = ArkanoidEnv(actions="box", frame_skip=1), ArkanoidEnv(frame_skip=1)
    paddle = box.layout["paddle"].start
    for velocity, fire, button in [(-1, -1, 1), (0, 0, 0), (1, 0, 2), (-1, 1, 4), (0, 0.1, 3)]:
        box.reset(seed=1)
        buttons.reset(seed=1)
        one = box.step(np.array([velocity, fire], np.float32))[0]
        assert one.tobytes() == buttons.step(button)[0].tobytes()
    box.reset(seed=1)
    moved = box.step(np.array([0.5, 0.0]))[0][paddle]
    assert np.isclose(moved, 0.5 * 0.19 * 2 / 11)


def test_info_counts_what_happened_in_the_step():
    """Over an episode the steps' events add up to what the game's state says."""
    env = ArkanoidVectorEnv(
        8, autoreset_mode="Disabled", capsule_rate=1.0, lives=1000, speed=2.0, levels="seeds:0-99"
    )
    reset_infos = env.reset(seed=0)[1]
    keys = ["hits", "bricks_broken", "capsules_caught", "enemies_destroyed"]
    keys += ["lives_lost", "lives_gained", "rounds_cleared"]
    assert all((reset_infos[key] == 0).all() for key in keys)
    sums = {key: np.zeros(8, int) for key in keys}
    lives, bricks = reset_infos["lives"], reset_infos["bricks_left"]
    env.action_space.seed(0)
    for _ in range(3000):
        if env.state["done"].any():
            break
        infos = env.step(env.action_space.sample())[-1]
        for key in keys:
            assert infos[f"_{key}"].all()
            sums[key] += infos[key]
        first = infos["round"] == 1
        assert (bricks - sums["bricks_broken"] == infos["bricks_left"])[first].all()
        gained = sums["lives_gained"] - sums["lives_lost"]
        assert (lives + gained == infos["lives"]).all()
        assert (sums["rounds_cleared"] == infos["round"] - 1).all()
    assert all(sums[key].sum() > 0 for key in keys[:5]), sums
