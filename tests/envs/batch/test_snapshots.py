"""Snapshots, clones and copies: what goes on from them is the same, bit for bit."""

import copy
import pickle
import zlib

import arkanoid  # noqa: F401
import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.batch import setup
from arkanoid.envs.state import World
from gymnasium.vector import AutoresetMode
from helpers.processes import run_python
from helpers.repository import EXAMPLES
from helpers.states import latest_observations
from hypothesis import given, settings
from hypothesis import strategies as st

# Episodes that end often, in both ways, and use every random draw.
LIVELY = {
    "lives": 1,
    "max_decisions": 90,
    "sticky_action": 0.25,
    "speed": 3.0,
    "capsule_rate": 1.0,
    "levels": ["warden", "ripple"],
}
MODES = ["NextStep", "SameStep", "Disabled"]
# Ways to see a game; a stack of pictures remembers earlier ones.
SEEN = [
    {},
    {"landing": True},
    {"observation": "grid"},
    {"observation": "rgb", "size": 24, "grey": True, "stack": 3},
    {"observation": "rgb", "size": (20, 16)},
]


def bits(result):
    """Return all that a reset, step or restore returns as something that compares by its bits."""
    if isinstance(result, tuple):
        return [bits(part) for part in result]
    if isinstance(result, dict):
        return {key: bits(value) for key, value in result.items()}
    if isinstance(result, np.ndarray) and result.dtype == object:
        return [bits(part) for part in result]
    if isinstance(result, np.ndarray):
        return (result.dtype.str, result.shape, result.tobytes())
    return result


def play(env, steps, seed):
    """Return what an env shows over random play; it is reset whenever it must be."""
    env.action_space.seed(seed)
    shown = []
    for _ in range(steps):
        shown.append(bits(env.step(env.action_space.sample())))
        over = np.atleast_1d(env.state["done"]) != 0
        if isinstance(env, ArkanoidEnv) and over[0]:
            shown.append(bits(env.reset()))
        elif env.metadata.get("autoreset_mode") is AutoresetMode.DISABLED and over.any():
            shown.append(bits(env.reset(options={"reset_mask": over})))
    return shown


def begun(count=None, steps=50, seed=0, **keywords):
    """Return an env (count None) or vector env that has been played for some steps."""
    keywords = LIVELY | keywords
    env = ArkanoidEnv(**keywords) if count is None else ArkanoidVectorEnv(count, **keywords)
    env.reset(seed=seed)
    play(env, steps, seed)
    return env


@settings(max_examples=40, deadline=None)
@given(
    before=st.integers(0, 300),
    between=st.integers(0, 200),
    seed=st.integers(0, 10**6),
    actions=st.sampled_from(["discrete6", "discrete3", "box"]),
    lively=st.booleans(),
    seen=st.sampled_from(SEEN),
)
def test_a_game_goes_on_from_any_point_as_it_did(before, between, seed, actions, lively, seen):
    keywords = (LIVELY if lively else {}) | {"actions": actions, "frame_skip": 1 + seed % 4} | seen
    env, other = ArkanoidEnv(**keywords), ArkanoidEnv(**keywords)
    env.reset(seed=seed)
    play(env, before, seed)
    snapshot = env.snapshot()
    first = play(env, 100, 1)
    play(env, between, 2)
    env.restore(snapshot)
    assert play(env, 100, 1) == first
    other.restore(snapshot)
    assert other.snapshot() == snapshot
    assert play(other, 100, 1) == first


@settings(max_examples=25, deadline=None)
@given(
    mode=st.sampled_from(MODES),
    steps=st.integers(0, 200),
    seed=st.integers(0, 10**6),
    count=st.integers(1, 9),
    threads=st.integers(1, 3),
    seen=st.sampled_from(SEEN),
)
def test_a_vector_env_goes_on_from_any_point_as_it_did(mode, steps, seed, count, threads, seen):
    """Worlds that wait for their reset included, and with any number of threads."""
    env = begun(count, steps, seed, autoreset_mode=mode, threads=threads, **seen)
    snapshot = env.snapshot()
    first = play(env, 120, 1)
    env.restore(snapshot)
    assert play(env, 120, 1) == first
    other = ArkanoidVectorEnv(count, autoreset_mode=mode, threads=1, **LIVELY | seen)
    other.restore(snapshot)
    assert play(other, 120, 1) == first
    env.close()


def test_restore_returns_what_was_shown_last():
    env = ArkanoidEnv(**LIVELY)
    shown = env.reset(seed=0)
    assert bits(env.restore(env.snapshot())) == bits(shown)
    over = False
    while not over:
        observation, _, terminated, truncated, info = env.step(3)
        over = terminated or truncated
    snapshot = env.snapshot()
    env.reset()
    assert bits(env.restore(snapshot)) == bits((observation, info))


def test_a_restored_vector_env_writes_into_the_array_that_it_always_returns():
    env = begun(4, copy=False, autoreset_mode="SameStep")
    observations = env.step(np.zeros(4, int))[0]
    before = observations.copy()
    snapshot = env.snapshot()
    play(env, 10, 0)
    assert env.restore(snapshot)[0] is observations
    assert observations.tobytes() == before.tobytes()


def test_how_episodes_begin_is_restored():
    """The reset options stay in force, and the generator goes on, also without a seed."""
    env = ArkanoidEnv(**LIVELY)
    env.reset(seed=0, options={"level": "spiral"})
    snapshot = env.snapshot()
    first = bits(env.reset())
    env.reset(seed=5, options={"level": "comb"})
    env.restore(snapshot)
    assert bits(env.reset()) == first
    fresh = ArkanoidEnv(**LIVELY)
    fresh.restore(snapshot)
    assert bits(fresh.reset()) == first


@pytest.mark.parametrize("seen", SEEN)
@pytest.mark.parametrize("mode", MODES)
def test_a_world_moves_between_a_vector_env_and_a_single_one(mode, seen):
    """Also where one of them has come further than the other since it began."""
    keywords = {"max_decisions": 1000, "lives": 100} | seen
    vector = begun(5, autoreset_mode=mode, **keywords)
    single = begun(steps=7, **keywords)
    for world in range(5):
        observation, _ = single.restore(vector.snapshot(world))
        assert observation.tobytes() == latest_observations(vector)[world].tobytes()
    observations, infos = vector.spread(single.snapshot())
    assert all(row.tobytes() == observation.tobytes() for row in observations)
    assert len(set(infos["score"].tolist())) == 1
    # With the same actions all go on alike, and like the single one.
    for action in [0, 1, 4, 2, 5, 2]:
        result = vector.step(np.full(5, action))
        alone = single.step(action)
        assert all(row.tobytes() == alone[0].tobytes() for row in result[0])
        assert result[1].tolist() == [alone[1]] * 5


def test_seeds_give_the_futures_their_own_luck():
    """Without one all draw the numbers that lie ahead; the serve tells."""
    env = ArkanoidEnv()
    env.reset(seed=0)
    futures = ArkanoidVectorEnv(64)
    served = {}
    for seed in (None, 7, 7):
        futures.spread(env.snapshot(), seed)
        observations = futures.step(np.full(64, 3))[0]
        speeds = observations[:, futures.layout["ball_vx"]][:, 0].tolist()
        served.setdefault(seed, speeds)
        assert served[seed] == speeds
    assert len(set(served[None])) == 1
    assert len(set(served[7])) == 64
    copies = [env.clone(), env.clone(), env.clone(seed=7), env.clone(seed=7), env.clone(seed=8)]
    shown = [clone.step(3)[0].tobytes() for clone in copies]
    assert shown[0] == shown[1] != shown[2] == shown[3] != shown[4]


COPIES = {
    "clone": lambda env: env.clone(),
    "copy.deepcopy": copy.deepcopy,
    "pickle": lambda env: pickle.loads(pickle.dumps(env)),
}


@pytest.mark.parametrize("seen", SEEN)
@pytest.mark.parametrize("how", COPIES)
def test_a_copy_goes_on_alike_and_alone(how, seen):
    env = begun(**seen)
    twin = COPIES[how](env)
    before = env.snapshot()
    assert twin.snapshot() == before
    shown = play(twin, 300, 1)
    assert env.snapshot() == before
    assert play(env, 300, 1) == shown


@pytest.mark.parametrize("seen", SEEN)
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("how", ["copy.deepcopy", "pickle"])
def test_a_copy_of_a_vector_env_goes_on_alike_and_alone(how, mode, seen):
    env = begun(9, autoreset_mode=mode, threads=2, **seen)  # its threads have run
    twin = COPIES[how](env)
    before = env.snapshot()
    shown = play(twin, 150, 1)
    assert env.snapshot() == before
    assert play(env, 150, 1) == shown
    env.close()
    twin.close()


def test_the_example_of_a_search_clears_its_level(tmp_path):
    """Monte Carlo search with futures that start from snapshots."""
    done = run_python(EXAMPLES / "monte_carlo.py", cwd=tmp_path)
    assert done.stdout.splitlines()[-1].startswith("cleared, with ")


def test_an_env_that_was_never_reset_can_be_copied_but_has_no_state():
    for env in (ArkanoidEnv(), ArkanoidVectorEnv(2)):
        for how in ("copy.deepcopy", "pickle"):
            twin = COPIES[how](env)
            assert bits(twin.reset(seed=1)) == bits(env.__class__.reset(twin, seed=1))
        with pytest.raises(RuntimeError, match="reset the environment before a snapshot"):
            env.snapshot()


@pytest.mark.parametrize("how", ["copy.deepcopy", "pickle"])
def test_a_copy_has_what_wrappers_count(how):
    """A snapshot has not: `TimeLimit` counts on."""
    env = gym.make("Arkanoid-v0", max_episode_steps=10)
    env.reset(seed=0)
    for _ in range(6):
        env.step(0)
    twin = COPIES[how](env)
    snapshot = env.unwrapped.snapshot()
    for step in range(4):
        for one in (env, twin):
            assert one.step(0)[3] is (step == 3)
    env.unwrapped.restore(snapshot)
    assert env.step(0)[3] is True


def test_clones_have_no_window(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pytest.importorskip("pygame")
    env = ArkanoidEnv(render_mode="human", frame_skip=1)
    env.reset(seed=0)
    assert env._window is not None
    clone, twin = env.clone(), copy.deepcopy(env)
    assert (clone.render_mode, clone._window, twin._window) == (None, None, None)
    clone.step(0)
    assert clone._window is None
    env.close()


@settings(max_examples=200, deadline=None)
@given(data=st.data())
def test_a_changed_bit_is_noticed(data):
    env = begun(2, autoreset_mode="SameStep")
    snapshot = env.snapshot()
    broken = bytearray(snapshot)
    broken[data.draw(st.integers(0, len(snapshot) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    with pytest.raises(ValueError, match=r"no snapshot|corrupt|format"):
        env.restore(bytes(broken))
    assert env.snapshot() == snapshot


@pytest.mark.parametrize("length", [0, 5, 21, 22, 400, -1])
def test_a_cut_snapshot_is_refused(length):
    env = begun()
    with pytest.raises(ValueError, match=r"no snapshot|corrupt"):
        env.restore(env.snapshot()[:length])
    with pytest.raises(ValueError, match="corrupt"):
        env.restore(env.snapshot() + b"more")
    with pytest.raises(TypeError, match="a snapshot is bytes; got str"):
        env.restore("text")


def changed(snapshot, place, number):
    """Return a snapshot with another byte at a place of its content, and the right checksum."""
    broken = bytearray(snapshot)
    broken[22 + place] = number
    broken[10:14] = zlib.crc32(broken[22:]).to_bytes(4, "little")
    return bytes(broken)


def test_snapshots_of_other_versions_are_refused(monkeypatch):
    env = begun()
    snapshot = env.snapshot()
    with pytest.raises(ValueError, match="is of format 2, and this release reads format 1"):
        env.restore(snapshot[:8] + b"\x02\x00" + snapshot[10:])
    rules = snapshot.index(b'"rules": 3') - 22 + len(b'"rules": ')
    with pytest.raises(ValueError, match=r"version 7, and this release plays version 3"):
        env.restore(changed(snapshot, rules, ord("7")))
    layout = snapshot.index(b'"layout": "') - 22 + len(b'"layout": "')
    with pytest.raises(ValueError, match="another release"):
        env.restore(changed(snapshot, layout, ord("x")))
    monkeypatch.setattr(setup, "World", np.dtype([*World.descr, ("more", "<f8")]))
    with pytest.raises(ValueError, match="another release"):
        ArkanoidEnv(**LIVELY).restore(snapshot)


@pytest.mark.parametrize(
    ("keywords", "difference"),
    [
        ({"speed": 2.0}, r"speed is 3.0 there, and 2.0 here"),
        ({"capsules": False}, r"capsules is True there, and False here"),
        ({"actions": "box"}, "actions is 'discrete6' there, and 'box' here"),
        ({"difficulty": 0.5}, "difficulty is None there, and 0.5 here"),
        ({"levels": ["warden"]}, "of other levels"),
        ({"levels": "train"}, "of other levels"),
        ({"observation": "rgb"}, "observation is 'vector' there, and 'rgb' here"),
    ],
)
def test_snapshots_of_other_configurations_are_refused_by_what_differs(keywords, difference):
    snapshot = begun().snapshot()
    other = begun(**keywords)
    before = other.snapshot()
    with pytest.raises(ValueError, match=difference):
        other.restore(snapshot)
    vector = ArkanoidVectorEnv(3, **LIVELY | keywords)
    with pytest.raises(ValueError, match=difference):
        vector.spread(snapshot)
    assert other.snapshot() == before


def test_levels_count_by_their_bricks_and_numbers_by_their_values(tmp_path):
    file = tmp_path / "level.txt"
    file.write_text("...www.....\n")
    snapshot = begun(levels=str(file), speed=3).snapshot()
    ArkanoidEnv(**LIVELY | {"levels": [str(file)], "speed": np.float64(3.0)}).restore(snapshot)
    pictures = LIVELY | {"observation": "rgb"}
    snapshot_of_pictures = begun(observation="rgb", size=16).snapshot()
    ArkanoidEnv(**pictures, size=[16, 16]).restore(snapshot_of_pictures)
    file.write_text("...www...w.\n")
    with pytest.raises(ValueError, match="of other levels"):
        ArkanoidEnv(**LIVELY | {"levels": str(file)}).restore(snapshot)


def test_numbers_of_worlds_must_agree():
    three, one = begun(3), begun()
    with pytest.raises(ValueError, match=r"3 instead of 1; spread\(\)"):
        one.restore(three.snapshot())
    with pytest.raises(ValueError, match="1 instead of 3"):
        three.restore(one.snapshot())
    with pytest.raises(ValueError, match=r"has 3 worlds, and spread\(\) takes that of one"):
        three.spread(three.snapshot())
    with pytest.raises(ValueError, match="world must be between 0 and 2; got 3"):
        three.snapshot(3)
    with pytest.raises(TypeError, match="seed must be an integer"):
        three.spread(one.snapshot(), seed=0.5)
    with pytest.raises(ValueError, match="seed must be between 0"):
        one.clone(seed=-1)


def test_an_episode_that_is_over_has_no_place_where_the_next_would_have_begun():
    env = ArkanoidEnv(max_decisions=1)
    env.reset(seed=0)
    env.step(0)
    snapshot = env.snapshot()
    same_step = ArkanoidVectorEnv(2, autoreset_mode="SameStep", max_decisions=1)
    with pytest.raises(ValueError, match="an episode is over in the snapshot"):
        same_step.spread(snapshot)
    next_step = ArkanoidVectorEnv(2, autoreset_mode="NextStep", max_decisions=1)
    next_step.spread(snapshot)
    assert next_step.step(np.zeros(2, int))[-1]["score"].tolist() == [0, 0]
    assert (next_step.state["decisions"] == 0).all()
