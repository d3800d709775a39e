"""Environments that are used wrongly: the mistake is named, and nothing goes on behind it."""

import re

import arkanoid  # noqa: F401
import gymnasium as gym
import numpy as np
import pytest
from arkanoid.agents.adapter import GymnasiumVecEnv
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from helpers.processes import run_program

MODES = list(AutoresetMode)
# Capsules, lost lives and ends of episodes are frequent.
LIVELY = {"capsule_rate": 1.0, "lives": 1, "max_decisions": 40, "levels": "seeds:0-99"}


# Before the first reset.


@pytest.mark.parametrize("mode", MODES)
def test_worlds_are_not_stepped_before_their_reset(mode):
    """The generator's state was 0: rewards were NaN, and drawing a capsule never ended."""
    env = ArkanoidVectorEnv(3, autoreset_mode=mode, **LIVELY)
    actions = np.zeros(3, int)
    with pytest.raises(ResetNeeded, match=r"reset\(\).*\[0, 1, 2\]"):
        env.step(actions)
    env.reset(seed=0, options={"reset_mask": np.array([True, False, True])})
    with pytest.raises(ResetNeeded, match=r"\[1\]"):
        env.step(actions)
    env.reset(options={"reset_mask": np.array([False, True, False])})
    assert np.isfinite(env.step(actions)[1]).all()


def test_one_game_is_not_stepped_before_its_reset():
    env = ArkanoidEnv()
    with pytest.raises(ResetNeeded, match=r"reset\(\)"):
        env.step(0)
    with pytest.raises(ResetNeeded):
        env.clone().step(0)
    with pytest.raises(ResetNeeded):
        gym.make("Arkanoid-v0").step(0)
    other = ArkanoidEnv()
    other.reset(seed=0)
    env.restore(other.snapshot())
    assert env.step(3)[0].tobytes() == other.step(3)[0].tobytes()


@pytest.mark.parametrize("native", [True, False])
def test_the_adapter_is_not_stepped_before_its_reset(native):
    if native:
        env = ArkanoidVectorEnv(2, autoreset_mode="SameStep")
    else:
        env = SyncVectorEnv([ArkanoidEnv] * 2, autoreset_mode=AutoresetMode.SAME_STEP)
    worlds = GymnasiumVecEnv(env)
    with pytest.raises(ResetNeeded):
        worlds.step(np.zeros(2, int))
    worlds.reset()
    worlds.step(np.zeros(2, int))


def test_what_was_never_reset_is_not_shown():
    """Frames of it were pictures of no game, and masks those of a paddle without a width."""
    single = ArkanoidEnv(render_mode="rgb_array")
    assert single.ale.lives() == 0
    shows = [single.render, single.action_masks, single.clone().render]
    shows += [single.ale.getScreenRGB, single.ale.getScreenGrayscale]
    shows += [ArkanoidEnv(render_mode="human").render]
    native = ArkanoidVectorEnv(2, render_mode="rgb_array", autoreset_mode="SameStep")
    sync = SyncVectorEnv(
        [lambda: ArkanoidEnv(render_mode="rgb_array")] * 2, autoreset_mode=AutoresetMode.SAME_STEP
    )
    for env in (native, sync):
        adapted = GymnasiumVecEnv(env)
        shows += [lambda env=env: env.call("render"), adapted.get_images, adapted.render]
        shows += [lambda env=adapted: env.env_method("action_masks")]
    for show in (*shows, native.render, native.action_masks):
        with pytest.raises(ResetNeeded, match=r"call reset\(\) before the first"):
            show()
    native.reset(seed=0, options={"reset_mask": np.array([True, False])})
    with pytest.raises(ResetNeeded, match=r"worlds \[1\] had none"):
        native.render()
    single.reset(seed=0)
    for env in (native, sync):
        env.reset(seed=0)
    for show in shows[:2]:
        assert show() is not None
    assert len(native.render()) == 2
    assert ArkanoidVectorEnv(2).render() is None


# Arguments.

NO_OPTIONS = [
    ([], TypeError, "options must be None or a dictionary"),
    ("level", TypeError, "options must be None or a dictionary"),
    (0, TypeError, "options must be None or a dictionary"),
    ({"levle": 1}, ValueError, "unknown reset option 'levle'; did you mean 'level'"),
    ({1: 1}, ValueError, "unknown reset option '1'"),
    ({"level": 1.0}, TypeError, "options.'level'.,.* must be an integer"),
    ({"level": True}, TypeError, "options.'level'.,.* must be an integer"),
    ({"level": ["vault"]}, TypeError, "options.'level'.,.* must be an integer"),
    ({"level": 0}, ValueError, "options.'level'.,.* must be between"),
    ({"level": "vualt"}, ValueError, "Did you mean 'vault'"),
    ({"level": ""}, ValueError, "level"),
    ({"level": 1, "seed": 1}, ValueError, "either a level or a seed"),
    ({"seed": "1"}, TypeError, "options.'seed'. must be an integer"),
    ({"seed": 1.0}, TypeError, "options.'seed'. must be an integer"),
    ({"seed": -1}, ValueError, "options.'seed'. must be between"),
    ({"seed": 2**63}, ValueError, "options.'seed'. must be between 0 and 9223372036854775807"),
    ({"difficulty": "1"}, TypeError, "options.'difficulty'. must be a number"),
    ({"difficulty": True}, TypeError, "options.'difficulty'. must be a number"),
    ({"difficulty": float("nan")}, ValueError, "options.'difficulty'. must be between"),
]


@pytest.mark.parametrize(("options", "error", "said"), NO_OPTIONS, ids=str)
def test_what_is_no_option_is_refused_and_changes_nothing(options, error, said):
    """An empty list was taken as no options."""
    for env in (ArkanoidEnv(), ArkanoidVectorEnv(2)):
        env.reset(seed=0)
        before = env.snapshot()
        with pytest.raises(error, match=said):
            env.reset(options=options)
        assert env.snapshot() == before


def test_a_single_game_takes_no_mask():
    """It was taken, and did nothing."""
    env = ArkanoidEnv()
    with pytest.raises(ValueError, match=r"reset_mask'. is for vector environments"):
        env.reset(options={"reset_mask": np.array([True])})
    with pytest.raises(ValueError, match=r"known: level, seed, repeat, difficulty$"):
        env.reset(options={"xyz": 1})


def test_the_largest_seed_of_a_level_and_a_path_are_legal(tmp_path):
    path = tmp_path / "one.txt"
    path.write_text("name: One\n\n.....w.....\n")
    for env in (ArkanoidEnv(), ArkanoidVectorEnv(2)):
        env.reset(seed=0, options={"seed": 2**63 - 1})
        env.reset(seed=0, options={"level": path})
        assert (env.state["bricks_left"] == 1).all()


@pytest.mark.parametrize(
    "size", [512.0, "512", b"512", (), (512,), (1, 2, 3), (1.0, 2), True, {1: 2}, (0, 5)], ids=repr
)
def test_what_is_no_size_of_frames_is_refused(size):
    """512.0 was told that a float is not iterable, and () was taken as the default."""
    for make in (ArkanoidEnv, lambda **keywords: ArkanoidVectorEnv(2, **keywords)):
        with pytest.raises((TypeError, ValueError), match="render_size must be"):
            make(render_mode="rgb_array", render_size=size)


@pytest.mark.parametrize(
    ("keyword", "value"),
    [
        ("threads", 1.5),
        ("threads", "2"),
        ("threads", True),
        ("copy", "no"),
        ("max_episode_steps", "5"),
    ],
)
def test_keywords_of_the_batch_are_checked(keyword, value):
    with pytest.raises(TypeError, match=f"{keyword}.* must be"):
        ArkanoidVectorEnv(2, **{keyword: value})


def test_too_many_worlds_are_refused_in_a_sentence():
    """10^12 were legal, and NumPy had no room for an array of a shape that nobody knew."""
    with pytest.raises(ValueError, match="num_envs must be between 1 and 1073741824; got 10000"):
        ArkanoidVectorEnv(10**12)
    looks = {"observation": "rgb", "size": 4096, "stack": 64}
    with pytest.raises(MemoryError, match="num_envs=1073741824 does not fit into memory"):
        ArkanoidVectorEnv(1 << 30, **looks)


@pytest.mark.parametrize("world", ["0", 1.0, True, [1]], ids=repr)
def test_what_is_no_index_of_a_world_is_refused(world):
    """Errors spoke of slices, and recording the world None of an ambiguous array."""
    env = ArkanoidVectorEnv(2)
    env.reset(seed=0)
    for call in (env.snapshot, env.record):
        with pytest.raises(TypeError, match="world must be an integer"):
            call(world)
    with pytest.raises(TypeError, match="world must be an integer"):
        env.record(None)


def test_no_loop_waits_for_a_healthy_generator_or_a_free_place():
    """With a generator that always gives 0 a capsule was drawn forever, deaf to Ctrl-C."""
    run_program(
        """
import numpy as np
from arkanoid.envs.batch.batch import Autoreset, Batch
from arkanoid.envs.config import Config

everywhere = np.ones(4, np.bool_)
for levels in ("seeds:0-99", "warden"):
    batch = Batch(4, Config(capsule_rate=1.0, speed=3.0, levels=levels), Autoreset.SAME_STEP)
    batch.reset(everywhere, seeds=range(4))
    generator = np.random.default_rng(0)
    for step in range(1500):
        batch.worlds["random"] = 0
        if step % 10 == 0:
            # The counters say that there is room, and there is none.
            for things in ("beam", "shard", "enemy"):
                batch.worlds[f"{things}_state"] = 2
            batch.worlds["beams"] = batch.worlds["shards"] = batch.worlds["enemies"] = 0
            batch.worlds["shard_wait"] = batch.worlds["enemy_wait"] = 1
            batch.worlds["power"] = 3
            batch.commands[:, 1] = 1.0
        batch.commands[:, 0] = generator.uniform(-1.0, 1.0, 4)
        batch.step()
        assert np.isfinite(batch.outcomes["reward"]).all()
""",
    )


# After the end.


def play_to_the_end(env):
    env.reset(seed=0)
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step(1)
        over = terminated or truncated


@pytest.mark.parametrize("rules", [{"lives": 1}, {"max_decisions": 30}, {"episodic_life": True}])
def test_a_game_that_is_over_does_not_go_on(rules):
    """It went on and paid, and its clock left the observation's space."""
    env = ArkanoidEnv(**rules)
    play_to_the_end(env)
    before = env.snapshot()
    copied, restored = env.clone(), ArkanoidEnv(**rules)
    restored.restore(before)
    for each in (env, copied, restored):
        for _ in range(2):
            with pytest.raises(ResetNeeded, match="episode is over"):
                each.step(1)
        assert each.snapshot() == before
        observation, _ = each.reset()
        assert each.observation_space.contains(observation)
        each.step(1)


def test_without_autoreset_finished_worlds_must_be_reset():
    native = ArkanoidVectorEnv(2, autoreset_mode="Disabled", max_decisions=3)
    # Gymnasium's own asserts.
    makers = [lambda: ArkanoidEnv(max_decisions=3)] * 2
    sync = SyncVectorEnv(makers, autoreset_mode=AutoresetMode.DISABLED)
    for env, error in ((native, ResetNeeded), (sync, AssertionError)):
        env.reset(seed=0)
        actions = np.zeros(2, int)
        for _ in range(3):
            env.step(actions)
        with pytest.raises(error):
            env.step(actions)
        env.reset(options={"reset_mask": np.array([True, False])})
        with pytest.raises(error):
            env.step(actions)
        env.reset(options={"reset_mask": np.array([False, True])})
        env.step(actions)


# Recorders.


def test_replaced_recorders_do_not_pile_up():
    """One per episode stayed, and each of them recorded all the rest."""
    env = ArkanoidEnv(max_decisions=20)
    for episode in range(30):
        recorder = env.record()
        env.reset(seed=episode)
        for _ in range(20):
            env.step(episode % 6)
        assert recorder.finished.result.decisions == 20
    assert list(env._batch.listeners) == [recorder]
    del recorder
    assert len(env._batch.listeners) == 0


@pytest.mark.parametrize("make", [ArkanoidEnv, lambda **keywords: ArkanoidVectorEnv(2, **keywords)])
@pytest.mark.parametrize(
    ("actions", "space"),
    [("box", "Box(-1.0, 1.0, (2,), float32)"), ("discrete6", "Discrete(6)")],
)
def test_what_is_no_array_is_refused_and_the_space_named(make, actions, space):
    """Torch and NumPy said what they could not do, and nobody what was wanted."""
    torch = pytest.importorskip("torch")
    env = make(actions=actions)
    env.reset(seed=0)
    before = env.snapshot()
    tensor = torch.zeros(2, requires_grad=True)
    for action in ([[0], [1, 2]], [[0, 0], [1]], tensor, tensor.expand(2, 2)):
        with pytest.raises(TypeError, match=rf"is not in {re.escape(space)}"):
            env.step(action)
    assert env.snapshot() == before
