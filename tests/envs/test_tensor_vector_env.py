"""Games as tensors: on ``device="cpu"`` the very entries of a graphics card run natively.

Everything is compared, bit for bit, with `ArkanoidVectorEnv`.
"""

import copy
import gc
import pickle

import gymnasium as gym
import numpy as np
import pytest
import torch
from helpers.processes import INTERPRETED, run_program
from helpers.tensors import LIVELY, draw_actions, make, same, same_step

WORLDS = 6
KINDS = {
    "vector": {},
    "landing": {"landing": True, "life_penalty": 1.0, "levels": "seeds:0-99"},
    "grid": {"observation": "grid"},
    "rgb": {"observation": "rgb", "grey": True, "stack": 3, "size": 48},
    # A picture that does not consist of whole words, with all colours.
    "odd": {"observation": "rgb", "stack": 2, "size": (43, 37), "channels": "last"},
    "dict": {"observation": "dict", "stack": 2, "size": 40, "actions": "box"},
}
MODES = ("NextStep", "SameStep", "Disabled")


def pair(count=WORLDS, **keywords):
    return make("cpu", count, **keywords), make(None, count, **keywords)


def begun(count=WORLDS, game="Arkanoid-v0", **keywords):
    """Return a tensor environment that was reset."""
    env = make("cpu", count, game, **keywords)
    env.reset(seed=0)
    return env


def play(env, other, decisions, seed=0, disabled=False):
    """Play the same decisions in both, and compare all; return how many episodes ended."""
    random = np.random.default_rng(seed)
    ends = 0
    for _ in range(decisions):
        actions = draw_actions(other, random)
        expected = other.step(actions)
        same_step(env.step(torch.from_numpy(actions)), expected)
        over = expected[2] | expected[3]
        ends += int(over.sum())
        if disabled and over.any():
            results = [
                each.reset(options={"reset_mask": mask})
                for each, mask in ((env, torch.from_numpy(over)), (other, over))
            ]
            for found, array in zip(*results, strict=True):
                same(found, array)
    return ends


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("kind", KINDS)
def test_every_step_is_that_of_arrays(kind, mode):
    env, other = pair(autoreset_mode=mode, **(LIVELY | KINDS[kind]))
    for found, expected in zip(env.reset(seed=7), other.reset(seed=7), strict=True):
        same(found, expected)
    assert play(env, other, 40, disabled=mode == "Disabled") >= WORLDS
    assert env.state.tobytes() == other.state.tobytes()
    assert env.snapshot() == other.snapshot()


@pytest.mark.parametrize("mode", MODES)
def test_lives_as_episodes(mode):
    env, other = pair(autoreset_mode=mode, capsule_rate=1.0, lives=2, episodic_life=True)
    env.reset(seed=1)
    other.reset(seed=1)
    assert play(env, other, 150, disabled=mode == "Disabled") > 0


def test_options_and_masks_in_the_midst_of_games():
    env, other = pair(**LIVELY, observation="dict", size=40, stack=2)
    mask = np.arange(WORLDS) % 2 == 0
    for options in (None, {"level": "vault"}, {"reset_mask": mask, "seed": 4}):
        found = env.reset(seed=3, options=options)
        for part, expected in zip(found, other.reset(seed=3, options=options), strict=True):
            same(part, expected)
        play(env, other, 10)
    for each in (env, other):
        each.set_start(2, {"level": "vault"})
    play(env, other, 30)
    assert env.snapshot() == other.snapshot()


@pytest.mark.parametrize("kind", ["vector", "grid", "rgb", "dict"])
def test_snapshots_move_both_ways(kind):
    env, other = pair(**(LIVELY | KINDS[kind]))
    env.reset(seed=5)
    other.reset(seed=5)
    play(env, other, 12)
    fresh_env, fresh_other = pair(**(LIVELY | KINDS[kind]))
    same(fresh_env.restore(other.snapshot())[0], fresh_other.restore(env.snapshot())[0])
    play(fresh_env, fresh_other, 12, seed=1)
    one = fresh_env.snapshot(1)
    assert one == fresh_other.snapshot(1)
    for found, expected in zip(env.spread(one, 9), other.spread(one, 9), strict=True):
        same(found, expected)
    play(env, other, 12, seed=2)


def test_everything_else_is_asked_as_of_arrays():
    env, other = pair(render_mode="rgb_array", render_size=64, **LIVELY)
    env.reset(seed=2)
    other.reset(seed=2)
    play(env, other, 9)
    for frame, expected in zip(env.render(), other.render(), strict=True):
        assert np.array_equal(frame, expected)
    same(env.action_masks(), other.action_masks())
    for mask, expected in zip(env.call("action_masks"), other.call("action_masks"), strict=True):
        same(mask, expected)
    for name in ("config", "render_mode", "action_space", "layout"):
        assert env.get_attr(name) == other.get_attr(name), name
    assert env.call("snapshot") == other.call("snapshot")
    assert env.get_action_meanings() == other.get_action_meanings()
    assert env.observation_space == other.observation_space
    assert "ArkanoidTensorVectorEnv" in repr(env)
    env.close()
    play(env, other, 3)  # as with arrays


def test_illegal_actions_stand_still_and_are_counted():
    """An exception would have to wait for the device."""
    env, other = pair(3)
    env.reset(seed=0)
    other.reset(seed=0)
    for _ in range(5):
        found = env.step(torch.tensor([6, -1, 2**40]))
        same_step(found, other.step([0, 0, 0]))
    before = env.illegal_actions
    assert before.tolist() == [5, 5, 5]
    env.step([9, 9, 9])
    # It was the very tensor that the next steps count in.
    assert (env.illegal_actions - before).tolist() == [1, 1, 1]
    env, other = pair(2, actions="box")
    env.reset(seed=0)
    other.reset(seed=0)
    found = env.step(torch.tensor([[float("nan"), 1.0], [7.0, 1.0]]))
    same_step(found, other.step(np.array([[0.0, 0.0], [1.0, 1.0]])))
    assert env.illegal_actions.tolist() == [1, 0]


def test_worlds_that_are_over_stay_in_mode_disabled():
    env = begun(2, autoreset_mode="Disabled", max_decisions=3)
    actions = torch.zeros(2, dtype=torch.int64)
    for _ in range(3):
        seen, _, _, truncated, _ = env.step(actions)
    assert truncated.all()
    before = env.snapshot()
    again, rewards, terminated, still_truncated, _ = env.step(actions)
    assert torch.equal(again, seen)
    assert not rewards.any()
    assert not terminated.any()
    assert still_truncated.all()
    assert env.state["done"].all()
    worlds = env.state.tobytes()
    env.reset(options={"reset_mask": torch.tensor([True, False])})
    assert env.state.tobytes() != worlds
    assert env.snapshot(1) != before
    assert env.state["done"].tolist()[1] != 0


@pytest.mark.parametrize("kind", ["vector", "grid", "rgb", "dict"])
def test_worlds_that_are_over_tell_the_same_after_a_restore_or_a_copy(kind):
    """There, their episodes seemed to go on: neither terminated nor truncated, infos all 0."""
    keywords = {**KINDS[kind], "autoreset_mode": "Disabled", "max_decisions": 3}
    env = begun(2, **keywords)
    still = np.zeros(env.action_space.shape, env.action_space.dtype)
    for _ in range(3):
        last = env.step(still)
    twins = copy.deepcopy(env), make("cpu", 2, **keywords)
    restored = twins[1].restore(env.snapshot())
    for key, value in last[4].items():
        assert torch.equal(restored[1][key], value), key
    waiting = env.step(still)
    assert waiting[3].all()
    assert waiting[4]["truncation"].tolist() == [1, 1]
    for twin in twins:
        assert str(twin.step(still)) == str(waiting)


def test_a_world_that_is_over_counts_nothing():
    """Who added up infos counted the last decision again and again."""
    env = begun(1, "ArkanoidLite-v0", autoreset_mode="Disabled", lives=1, life_penalty=1.0)
    for _ in range(3000):
        _, rewards, terminated, _, infos = env.step([0])
        if terminated:
            break
    assert (infos["lives_lost"].item(), rewards.item()) == (1, -1.0)
    for _ in range(2):
        _, rewards, terminated, _, infos = env.step([0])
        assert terminated.item()
        assert (infos["lives_lost"].item(), rewards.item()) == (0, 0.0)
        assert infos["lives"].item() == 0
    assert env.restore(env.snapshot())[1]["lives_lost"].item() == 0


@pytest.mark.parametrize("copied", [True, False])
@pytest.mark.parametrize("kind", ["vector", "rgb"])
def test_copies(kind, copied):
    env = begun(2, copy=copied, autoreset_mode="SameStep", **KINDS[kind])
    actions = torch.zeros(2, dtype=torch.int64)
    first, second = env.step(actions), env.step(actions)
    shared = [
        found.data_ptr() == other.data_ptr()
        for found, other in zip(first[:4], second[:4], strict=True)
    ]
    shared.append(first[4]["score"].data_ptr() == second[4]["score"].data_ptr())
    shared.append(first[4]["_score"].data_ptr() == second[4]["_score"].data_ptr())
    assert shared == [not copied] * 6


@pytest.mark.parametrize("kind", ["landing", "dict"])
def test_results_belong_to_the_caller(kind):
    """With ``copy=True``, what is written into them changes neither games nor later results."""
    env, other = pair(autoreset_mode="SameStep", **(LIVELY | KINDS[kind]))
    random = np.random.default_rng(3)
    results = env.reset(seed=3)
    other.reset(seed=3)
    for _ in range(30):
        scribble(results)
        actions = draw_actions(other, random)
        results = env.step(torch.from_numpy(actions))
        same_step(results, other.step(actions))
    seen = env.observe()
    scribble(env.observe())
    assert str(env.observe()) == str(seen)
    assert env.snapshot() == other.snapshot()


def scribble(results):
    """Write nonsense into all tensors."""
    if isinstance(results, torch.Tensor):
        results.copy_(~results if results.dtype == torch.bool else torch.ones_like(results))
    else:
        for part in results.values() if isinstance(results, dict) else results:
            scribble(part)


def test_results_outlive_the_environment():
    env = begun(3, copy=False)
    env.step([1, 1, 1])
    results = env.step([2, 2, 2])[:2]
    before = [each.tolist() for each in results]
    del env
    gc.collect()
    begun(3).step([0, 0, 0])  # it may get the memory that is free now
    assert [each.tolist() for each in results] == before


def test_one_game_and_the_seeds_of_each_game():
    env, other = pair(1, **LIVELY)
    same(env.reset(seed=9)[0], other.reset(seed=9)[0])
    play(env, other, 30)
    env, other = pair(3)
    seeds = [5, 2**60, 5]
    found = env.reset(seed=seeds)[0]
    same(found, other.reset(seed=seeds)[0])
    play(env, other, 3)
    assert [env.snapshot(world) for world in range(3)] == [other.snapshot(w) for w in range(3)]


def test_wrappers_of_functions_get_tensors():
    """Gymnasium's others want arrays, and say so in words of their own."""
    vector = gym.wrappers.vector
    env, other = (
        vector.TransformReward(vector.TransformObservation(each, abs), lambda gained: gained / 4)
        for each in pair(3, life_penalty=1.0, **LIVELY)
    )
    same(env.reset(seed=1)[0], other.reset(seed=1)[0])
    play(env, other, 30)


@pytest.mark.parametrize("copier", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
@pytest.mark.parametrize("kind", ["vector", "rgb"])
def test_a_copy_of_the_environment_plays_on_by_itself(kind, copier):
    """It would have written into the tensors of the first one, by their addresses."""
    env, other = pair(**(LIVELY | KINDS[kind]))
    env.reset(seed=3)
    other.reset(seed=3)
    play(env, other, 5)
    env.step(np.full(WORLDS, -1))
    other.step(np.zeros(WORLDS, int))
    before = env.snapshot()
    twin = copier(env)
    assert twin.illegal_actions.tolist() == [1] * WORLDS
    play(twin, copy.deepcopy(other), 10)
    assert env.snapshot() == before
    play(env, other, 10)


def test_inference_mode_around_the_making_of_an_environment():
    """Its tensors could not be written outside."""
    with torch.inference_mode():
        env = make("cpu", 2)
    env.reset(seed=0)
    env.step([0, 0])


def test_the_same_interpreted():
    program = """
import arkanoid, gymnasium as gym, hashlib, torch
digest = hashlib.sha256()
for keywords in ({"landing": True}, {"observation": "grid"},
                 {"observation": "rgb", "size": (20, 18), "stack": 2, "grey": True}):
    env = gym.make_vec("Arkanoid-v0", num_envs=2, vectorization_mode="vector_entry_point",
                       device="cpu", autoreset_mode="SameStep", max_decisions=2, frame_skip=1,
                       **keywords)
    digest.update(env.reset(seed=0)[0].numpy().tobytes())
    for action in (1, 2, 0):
        seen, rewards, *_, infos = env.step([action, 0])
        digest.update(seen.numpy().tobytes() + rewards.numpy().tobytes())
        digest.update(infos["final_obs"].numpy().tobytes() + env.snapshot())
print(digest.hexdigest())
"""
    compiled = run_program(program, warnings="default").stdout
    assert run_program(program, warnings="default", changes=INTERPRETED).stdout == compiled
