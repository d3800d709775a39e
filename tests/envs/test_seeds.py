"""What a seed determines, and what is no seed."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from gymnasium.error import Error
from gymnasium.vector import AutoresetMode, SyncVectorEnv

# Games that end often, draw random numbers often, and whose levels options change.
LIVELY = {"lives": 1, "max_decisions": 25, "sticky_action": 0.25, "speed": 3.0, "levels": "train"}
OPTIONS = [{"level": "vault"}, {"level": 7}, {"seed": 5}, {"difficulty": 1.0}]
ILLEGAL = ["1", b"1", -1, 2**64, 1.0, True, np.float64(1.0), np.bool_(True), [1], {}]


def shown(env, first, steps=120):
    """Return all that a vector environment shows in a fixed play after a reset, as bytes."""
    generator = np.random.default_rng(0)
    parts = [first[0].tobytes()]
    for _ in range(steps):
        observations, rewards, *ends, infos = env.step(generator.integers(0, 6, env.num_envs))
        parts += [observations.tobytes(), rewards.tobytes(), *(end.tobytes() for end in ends)]
        parts.append(infos["bricks_left"].tobytes())
    return b"".join(parts)


@pytest.mark.parametrize("seed", ILLEGAL, ids=repr)
def test_what_is_no_seed_is_refused_and_changes_nothing(seed):
    """Vector environments took 1.9 as 1, "1" as 1, -1 as 2**64 - 1 and 2**64 as 0."""
    single, worlds = ArkanoidEnv(), ArkanoidVectorEnv(2)
    for env in (single, worlds):
        env.reset(seed=0)
        before = env.snapshot()
        with pytest.raises((TypeError, ValueError), match="seed"):
            env.reset(seed=seed)
        assert env.snapshot() == before
    before = single.snapshot()
    with pytest.raises((TypeError, ValueError), match="seed"):
        worlds.spread(before, seed=seed)
    with pytest.raises((TypeError, ValueError), match="seed"):
        single.clone(seed=seed)
    for each in ([seed, 1], [1, seed]):
        with pytest.raises((TypeError, ValueError), match="seed"):
            worlds.reset(seed=each)


@pytest.mark.parametrize("seed", [[1.9, 1], ["1", 1], [-1, 1], [1, -1], [1], [1, 2, 3]], ids=repr)
def test_lists_are_refused_as_gymnasium_refuses_them(seed):
    sync = SyncVectorEnv([ArkanoidEnv] * 2)
    with pytest.raises((Error, TypeError, ValueError, AssertionError)):
        sync.reset(seed=seed)
    with pytest.raises((TypeError, ValueError), match="seed"):
        ArkanoidVectorEnv(2).reset(seed=seed)


def test_the_largest_seeds_are_legal():
    env = ArkanoidVectorEnv(2)
    env.reset(seed=2**64 - 2)
    with pytest.raises(ValueError, match="seed"):
        env.reset(seed=2**64 - 1)
    first = env.reset(seed=[2**64 - 1, 3])[0]
    assert first.tobytes() == env.reset(seed=np.array([2**64 - 1, 3], np.uint64))[0].tobytes()
    assert ArkanoidEnv().reset(seed=np.int64(3))[0].tobytes() == first[1].tobytes()


@pytest.mark.parametrize("options", [{"level": "nowhere"}, {"level": 0}, {"difficulty": 2.0}])
def test_an_illegal_option_changes_nothing(options):
    """The worlds had their new seeds and their old games."""
    for env in (ArkanoidEnv(), ArkanoidVectorEnv(2)):
        env.reset(seed=0, options={"level": 3})
        before = env.snapshot()
        with pytest.raises(ValueError, match=next(iter(options))):
            env.reset(seed=9, options=options)
        assert env.snapshot() == before


@pytest.mark.parametrize("options", OPTIONS, ids=repr)
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_a_seed_determines_all_that_follows(mode, options):
    """A reset with a seed and no options kept the level that an earlier reset had asked for."""
    fresh = ArkanoidVectorEnv(3, autoreset_mode=mode, **LIVELY)
    expected = shown(fresh, fresh.reset(seed=4))
    sync = SyncVectorEnv([lambda: ArkanoidEnv(**LIVELY)] * 3, autoreset_mode=mode)
    for env in (ArkanoidVectorEnv(3, autoreset_mode=mode, **LIVELY), sync):
        with_options = shown(env, env.reset(seed=4, options=options))
        assert with_options != expected
        assert shown(env, env.reset(seed=4)) == expected
        assert shown(env, env.reset(seed=4, options=options)) == with_options


def test_one_game_forgets_its_options_with_a_seed_only():
    env, fresh = ArkanoidEnv(), ArkanoidEnv()
    env.reset(seed=1, options={"level": "vault", "difficulty": 0.5})
    vault = env.state["kind"].copy()
    env.reset()
    assert np.array_equal(env.state["kind"], vault)  # no seed: they stay in force
    env.reset(seed=2)
    fresh.reset(seed=2)
    assert env.state["start_difficulty"] == fresh.state["start_difficulty"] == -1.0
    assert np.array_equal(env.state["kind"], fresh.state["kind"])
    env.reset()
    fresh.reset()
    assert np.array_equal(env.state["kind"], fresh.state["kind"])
    # Other options with a seed: nothing is left of the earlier ones.
    env.reset(seed=3, options={"level": "vault"})
    env.reset(seed=3, options={"difficulty": 0.5})
    assert not np.array_equal(env.state["kind"], vault)


def test_only_the_worlds_that_get_a_seed_forget_their_options():
    env = ArkanoidVectorEnv(3)
    env.reset(seed=0, options={"level": "vault"})
    vault = env.state["kind"][0].copy()
    env.reset(seed=[None, 7, None])
    same = (env.state["kind"] == vault).all(axis=1)
    assert same.tolist() == [True, False, True]
    env.reset(seed=0, options={"reset_mask": np.array([True, False, False])})
    same = (env.state["kind"] == vault).all(axis=1)
    assert same.tolist() == [False, False, True]
