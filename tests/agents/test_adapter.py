"""The adapter against stable-baselines3's `DummyVecEnv` and Gymnasium's statistics.

The environments are CartPole and a small game written here, in Gymnasium's `SyncVectorEnv`: nothing
depends on our own.
"""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.agents.adapter import GymnasiumVecEnv, world_info
from gymnasium.vector import AutoresetMode, SyncVectorEnv, VectorEnv
from gymnasium.wrappers import TimeLimit
from gymnasium.wrappers.vector import RecordEpisodeStatistics
from numpy.typing import NDArray
from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

SAME_STEP = AutoresetMode.SAME_STEP


class Walk(gym.Env[NDArray[np.float32], np.int64]):
    """A walk on a line from a random place. It terminates beyond ±1, and is truncated at step 8.

    Both can happen in the same step.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012 (Gymnasium's way)
    render_mode = "rgb_array"
    observation_space = gym.spaces.Box(-9, 9, (2,), np.float32)
    action_space = gym.spaces.Discrete(3)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        self.x = float(self.np_random.uniform(-0.5, 0.5)) + float((options or {}).get("shift", 0))
        self.count = 0
        return self._observation(), {"count": 0, "gained": 0.0}

    def step(
        self, action: np.int64
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        self.x += 0.3 * (int(action) - 1) + float(self.np_random.normal(0, 0.05))
        self.count += 1
        info = {"count": self.count, "gained": self.x**2, "deep": {"twice": 2 * self.count}}
        return self._observation(), self.x, abs(self.x) > 1, self.count >= 8, info

    def render(self) -> NDArray[np.uint8]:
        return np.full((4, 6, 3), self.count, np.uint8)

    def _observation(self) -> NDArray[np.float32]:
        return np.array([self.x, self.count], np.float32)


def cartpole() -> gym.Env[Any, Any]:
    return TimeLimit(gym.make("CartPole-v1").unwrapped, 30)


def adapted(make: Callable[[], gym.Env[Any, Any]], num: int, **keywords: Any) -> GymnasiumVecEnv:
    """Return worlds whose next step overwrites the observations: the harder case."""
    return GymnasiumVecEnv(
        SyncVectorEnv([make] * num, copy=False, autoreset_mode=SAME_STEP), **keywords
    )


@pytest.mark.parametrize("make", [Walk, cartpole])
def test_every_step_equals_that_of_dummy_vec_env(
    make: Callable[[], gym.Env[Any, Any]],
) -> None:
    ours, theirs = adapted(make, 5), DummyVecEnv([make] * 5)
    assert ours.seed(3) == theirs.seed(3)
    np.testing.assert_array_equal(ours.reset(), theirs.reset())
    random = np.random.default_rng(0)
    ended = cut = 0
    for _ in range(300):
        actions = random.integers(2, size=5)
        got, expected = ours.step(actions), theirs.step(actions)
        for mine, other in zip(got[:3], expected[:3], strict=True):
            np.testing.assert_array_equal(mine, other)
            assert np.asarray(mine).dtype == np.asarray(other).dtype
        for done, mine, other in zip(got[2], got[3], expected[3], strict=True):
            assert bool(mine) == done
            if done:
                np.testing.assert_array_equal(
                    mine.pop("terminal_observation"), other.pop("terminal_observation")
                )
                mine.pop("episode")
                assert mine == other
                cut += other["TimeLimit.truncated"]
                ended += not other["TimeLimit.truncated"]
        assert ours.reset_infos == theirs.reset_infos
    assert ended > 10
    assert cut > 10 or make is cartpole


def test_a_step_that_terminates_and_truncates_counts_as_terminated() -> None:
    venv = adapted(Walk, 1)
    venv.seed(0)
    venv.reset()
    walk = venv.env.envs[0]  # type: ignore[attr-defined]
    walk.count, walk.x = 7, 5.0
    _, _, dones, infos = venv.step(np.array([1]))
    assert dones[0]
    assert infos[0]["TimeLimit.truncated"] is False


def test_the_weights_after_training_are_those_of_training_on_dummy_vec_env() -> None:
    """Episodes are short: many terminate, and many are truncated, where PPO adds a value."""

    def weights(venv: Any) -> list[NDArray[np.float32]]:
        model = PPO("MlpPolicy", venv, n_steps=64, batch_size=64, n_epochs=2, seed=4, device="cpu")
        model.learn(1024)
        return [value.numpy() for value in model.policy.state_dict().values()]

    for make in (Walk, cartpole):
        ours, theirs = weights(adapted(make, 4)), weights(DummyVecEnv([make] * 4))
        for mine, other in zip(ours, theirs, strict=True):
            np.testing.assert_array_equal(mine, other)


def test_episode_statistics_are_gymnasiums() -> None:
    """`RecordEpisodeStatistics` sums in float64, too. Times are of another clock."""
    venv = adapted(Walk, 6)
    other = RecordEpisodeStatistics(SyncVectorEnv([Walk] * 6, autoreset_mode=SAME_STEP))
    venv.seed(11)
    venv.reset()
    other.reset(seed=11)
    random = np.random.default_rng(1)
    episodes = 0
    for _ in range(200):
        actions = random.integers(3, size=6)
        _, _, dones, infos = venv.step(actions)
        expected = other.step(actions)[4]
        for world in np.flatnonzero(dones):
            got = infos[world]["episode"]
            assert got["r"] == expected["episode"]["r"][world]
            assert got["l"] == expected["episode"]["l"][world]
            assert got["t"] > 0
            episodes += 1
    assert episodes > 50


def test_statistics_of_the_game_are_collected_by_episode() -> None:
    venv = adapted(Walk, 3, info_keywords=["count"], summed_keywords=["gained"])
    venv.seed(2)
    venv.reset()
    squares: list[list[float]] = [[], [], []]
    episodes = 0
    for _ in range(60):
        observations, _, dones, infos = venv.step(np.array([0, 1, 2]))
        for world, done in enumerate(dones):
            last = infos[world]["terminal_observation"] if done else observations[world]  # type: ignore[index]
            squares[world].append(float(last[0]) ** 2)
            if done:
                episode = infos[world]["episode"]
                assert episode["count"] == episode["l"] == len(squares[world])
                # Observations are float32.
                assert episode["gained"] == pytest.approx(sum(squares[world]), rel=1e-5)
                squares[world].clear()
                episodes += 1
    assert episodes > 10


def test_returned_arrays_are_never_overwritten() -> None:
    """stable-baselines3 keeps an observation until after the next step, and adds to rewards.

    If the environment reused the array, the next observation would replace the stored one: training
    would run, and learn from wrong pairs.
    """
    venv = adapted(Walk, 4)
    venv.seed(0)
    kept: list[tuple[Any, Any]] = []
    observations: Any = venv.reset()
    for _ in range(30):
        kept.append((observations, observations.copy()))
        observations, rewards, dones, infos = venv.step(np.array([0, 1, 2, 2]))
        kept += [(rewards, rewards.copy()), (dones, dones.copy())]
        for info in infos:
            if info:
                kept.append((info["terminal_observation"], info["terminal_observation"].copy()))
        assert len({id(info) for info in infos}) == 4
    for array, before in kept:
        np.testing.assert_array_equal(array, before)
    assert rewards.flags.writeable


def test_each_world_can_get_a_seed_of_its_own() -> None:
    venv = adapted(Walk, 3)
    venv.set_seeds([9, 5, 7])
    seen = venv.reset()
    for world, seed in enumerate((9, 5, 7)):
        np.testing.assert_array_equal(seen[world], Walk().reset(seed=seed)[0])  # type: ignore[index]
    with pytest.raises(ValueError, match="2 seeds for 3 worlds"):
        venv.set_seeds([1, 2])


def test_seeds_hold_for_the_next_reset_only() -> None:
    venv = adapted(Walk, 3)
    assert venv.seed(5) == [5, 6, 7]
    first = venv.reset()
    again = venv.reset()
    venv.seed(5)
    assert (first != again).any()  # type: ignore[union-attr]
    np.testing.assert_array_equal(venv.reset(), first)
    single, _ = Walk().reset(seed=6)
    np.testing.assert_array_equal(first[1], single)  # type: ignore[index]


def test_options_hold_for_all_worlds_and_the_next_reset_only() -> None:
    venv = adapted(Walk, 2)
    venv.set_options({"shift": 100})
    assert (venv.reset()[:, 0] > 90).all()  # type: ignore[index,call-overload]
    assert (venv.reset()[:, 0] < 90).all()  # type: ignore[index,call-overload]


def test_each_world_can_have_options_of_its_own() -> None:
    """As in stable-baselines3's own vector environment, seeds included."""
    options = [{"shift": 50}, {}, {"shift": 50}, {"shift": 80}]
    ours, theirs = adapted(Walk, 4), DummyVecEnv([Walk] * 4)
    for venv in (ours, theirs):
        venv.seed(9)
        venv.set_options(options)
    np.testing.assert_array_equal(ours.reset(), theirs.reset())
    assert ours.reset_infos == theirs.reset_infos
    for _ in range(20):
        for mine, other in zip(
            *(each.step(np.ones(4, int))[:3] for each in (ours, theirs)), strict=True
        ):
            np.testing.assert_array_equal(mine, other)


def test_statistics_continue_from_a_saved_state() -> None:
    venv, other = (adapted(Walk, 3, summed_keywords=["gained"]) for _ in range(2))
    untouched = venv.get_statistics()
    for each in (venv, other):
        each.seed(4)
        each.reset()
        for _ in range(5):
            each.step(np.array([1, 1, 1]))
    other.set_statistics(untouched)
    other.set_statistics(venv.get_statistics())
    episodes = 0
    for _ in range(20):
        for mine, theirs in zip(
            *(each.step(np.ones(3, int))[3] for each in (venv, other)), strict=True
        ):
            episodes += bool(mine)
            for key in ("r", "l", "gained") if mine else ():
                assert mine["episode"][key] == theirs["episode"][key]
    assert episodes > 3


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.DISABLED])
def test_other_autoreset_modes_are_refused(mode: AutoresetMode) -> None:
    with pytest.raises(ValueError, match="SameStep"):
        GymnasiumVecEnv(SyncVectorEnv([Walk], autoreset_mode=mode))


def test_attributes_and_methods_of_single_environments() -> None:
    venv = adapted(Walk, 3)
    venv.reset()
    assert venv.get_attr("count") == [0, 0, 0]
    assert venv.get_attr("count", 1) == [0]
    assert venv.get_attr("count", [0, 2]) == [0, 0]
    venv.set_attr("count", 3)
    assert venv.get_attr("count") == [3, 3, 3]
    assert [frame[0, 0, 0] for frame in venv.env_method("render")] == [3, 3, 3]
    assert not venv.has_attr("no_such_attribute")
    with pytest.raises(ValueError, match="some worlds only"):
        venv.set_attr("count", 3, indices=[1])
    with pytest.raises(ValueError, match="some worlds only"):
        venv.env_method("render", indices=1)


class Batch(VectorEnv[Any, Any, Any]):
    """A native batch: one object for all worlds."""

    metadata = {"autoreset_mode": SAME_STEP}  # noqa: RUF012 (Gymnasium's way)
    num_envs = 3
    single_observation_space = gym.spaces.Box(0, 1, (1,), np.float32)
    single_action_space = gym.spaces.Discrete(2)
    level = "ripple"

    def halves(self) -> NDArray[np.float64]:
        return np.arange(self.num_envs) / 2

    def name(self) -> str:
        return "abc"


def test_attributes_and_methods_of_a_native_batch() -> None:
    venv = GymnasiumVecEnv(Batch())
    assert venv.get_attr("level", [0, 1]) == ["ripple", "ripple"]
    venv.set_attr("level", "comb")
    assert venv.get_attr("level") == ["comb"] * 3
    assert venv.env_method("halves") == [0.0, 0.5, 1.0]
    assert venv.env_method("name") == ["abc"] * 3
    assert venv.env_is_wrapped(TimeLimit) == [False] * 3


def test_wrappers_are_found_and_no_monitor_is_needed() -> None:
    venv = adapted(cartpole, 2)
    assert venv.env_is_wrapped(TimeLimit) == [True, True]
    assert venv.env_is_wrapped(gym.wrappers.ClipAction) == [False, False]
    assert venv.env_is_wrapped(Monitor, indices=[1]) == [True]
    # Without a monitor stable-baselines3's evaluation warns, and warnings are errors here.
    model = PPO("MlpPolicy", venv, n_steps=8, batch_size=16, device="cpu", seed=0)
    mean, _ = evaluate_policy(model, venv, n_eval_episodes=4)
    assert 1 <= float(mean) <= 30  # type: ignore[arg-type]


def test_pictures_of_all_worlds_are_tiled_into_one() -> None:
    venv = adapted(Walk, 4)
    venv.reset()
    venv.step(np.array([1, 1, 1, 1]))
    assert venv.render_mode == "rgb_array"
    picture = venv.render()
    assert picture is not None
    assert picture.shape == (8, 12, 3)
    assert (picture == 1).all()
    venv.close()


def test_it_can_be_wrapped_by_stable_baselines3() -> None:
    venv = VecNormalize(adapted(Walk, 3))
    model = PPO("MlpPolicy", venv, n_steps=32, batch_size=32, n_epochs=1, device="cpu", seed=0)
    model.learn(192)
    assert model.ep_info_buffer
    assert np.isfinite(model.ep_info_buffer[0]["r"])


def test_masks_say_which_keys_a_worlds_info_has() -> None:
    infos = {
        "score": np.array([1, 2]),
        "_score": np.array([True, False]),
        "deep": {"x": np.array([3, 4]), "_x": np.array([False, True])},
        "_deep": np.array([False, True]),
        "final_obs": np.array([None, None]),
        "_final_obs": np.array([True, True]),
    }
    assert world_info(infos, 0) == {"score": 1}
    assert world_info(infos, 1) == {"deep": {"x": 4}}


def test_an_info_of_a_world_is_its_own() -> None:
    """A vector environment may write the infos of its next step into the same arrays."""
    objects = np.array([[1], [2]], object)
    objects[0, 0] = ["a"]
    infos = {"row": np.ones((2, 3)), "one": np.arange(2), "objects": objects}
    infos |= {f"_{name}": np.ones(2, bool) for name in infos}
    info = world_info(infos, 0)
    infos["row"][:] = 7
    infos["one"][:] = 7
    objects[0, 0].append("b")
    assert info["row"].tolist() == [1, 1, 1]
    assert info["one"] == 0
    assert info["objects"].tolist() == [["a"]]


def test_a_single_environment_is_refused_with_advice_that_works() -> None:
    """The advice was a keyword that `gym.make` refuses."""
    with pytest.raises(TypeError, match=r"gym.make_vec\(id, num_envs, autoreset_mode='SameStep'\)"):
        GymnasiumVecEnv(gym.make("arkanoid:Arkanoid-v0"))  # type: ignore[arg-type]
    GymnasiumVecEnv(gym.make_vec("arkanoid:Arkanoid-v0", 2, autoreset_mode="SameStep"))
    other = {"vectorization_mode": "sync", "vector_kwargs": {"autoreset_mode": SAME_STEP}}
    GymnasiumVecEnv(gym.make_vec("arkanoid:Arkanoid-v0", 2, **other))  # type: ignore[arg-type]


def test_films_are_as_fast_as_the_game() -> None:
    """`VecVideoRecorder` found no speed and took 30 frames a second, twice as many as there are."""
    worlds = gym.make_vec(
        "arkanoid:Arkanoid-v0", 2, autoreset_mode="SameStep", render_mode="rgb_array"
    )
    venv = GymnasiumVecEnv(worlds)
    assert venv.metadata["render_fps"] == 15
    assert venv.render_mode == "rgb_array"


def test_masks_of_actions_and_lives_come_through() -> None:
    worlds = gym.make_vec("arkanoid:Arkanoid-v0", 3, autoreset_mode="SameStep")
    venv = GymnasiumVecEnv(worlds)
    venv.reset()
    masks = np.stack(venv.env_method("action_masks"))
    assert masks.shape == (3, 6)
    assert venv.has_attr("action_masks")
