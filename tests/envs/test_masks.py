"""Masks of actions: what is masked does nothing, what does something is not masked."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.actions import COMMANDS

# All that a command leaves behind whatever it does.
REMEMBERED = ("move", "fire")


def state(env):
    """Return what a world is but for the latest command."""
    record = env._batch.worlds.copy()
    for name in REMEMBERED:
        record[name] = 0.0
    return record.tobytes()


@pytest.mark.parametrize("actions", ["discrete3", "discrete4", "discrete6"])
def test_what_is_masked_does_nothing(actions):
    """A masked action leads to the state that the same action without its masked part leads to.

    But in decisions that bring what the mask can't foresee: a new ball, or a power.
    """
    env = ArkanoidEnv(actions=actions, capsule_rate=1.0, levels="seeds:0-99", speed=2.0, lives=9)
    env.reset(seed=0)
    generator = np.random.default_rng(0)
    table = COMMANDS[actions].tolist()
    compared = dict.fromkeys(range(len(table)), 0)
    for _ in range(6000):
        masks = env.action_masks()
        assert masks.dtype == np.bool_
        assert masks[0]
        legal = np.flatnonzero(masks)
        illegal = np.flatnonzero(~masks)
        if len(illegal):
            action = int(generator.choice(illegal))
            move, fire = table[action]
            can_move = move == 0.0 or masks[table.index([move, 0.0])]
            can_fire = fire == 1.0 and masks[table.index([0.0, 1.0])]
            instead = table.index([move if can_move else 0.0, float(can_fire)])
            other = env.clone()
            info = env.clone().step(action)[-1]
            if info["lives_lost"] + info["capsules_caught"] + info["rounds_cleared"] == 0:
                done = env.clone()
                done.step(action)
                other.step(instead)
                assert state(done) == state(other), (action, instead)
                compared[action] += 1
        # Along the walls more often than by chance.
        preferred = [action for action in legal if table[action][0] == (-1.0, 1.0)[_ // 60 % 2]]
        chosen = generator.choice(preferred if preferred and _ % 3 else legal)
        *_, terminated, truncated, _info = env.step(int(chosen))
        if terminated or truncated:
            env.reset()
    masked = [action for action in range(len(table)) if table[action] != [0.0, 0.0]]
    assert all(compared[action] > 20 for action in masked), compared


def test_what_does_something_is_not_masked():
    env = ArkanoidEnv(frame_skip=1)
    env.reset(seed=0)
    assert env.action_masks().all()  # the ball lies on the paddle, in the middle
    env.step(3)
    assert env.action_masks().tolist() == [True, True, True, False, False, False]
    while env.action_masks()[1]:
        env.step(1)
    assert env._batch.worlds["paddle_x"][0] == env._batch.worlds["paddle_half"][0]
    assert env.action_masks().tolist() == [True, False, True, False, False, False]


def test_the_open_gate_is_worth_a_move():
    env = ArkanoidEnv()
    env.reset(seed=0)
    world = env._batch.worlds
    world["paddle_x"] = 11.0 - world["paddle_half"]
    assert env.action_masks().tolist() == [True, True, False, True, True, False]
    world["exit_open"] = 1
    assert env.action_masks().all()
    cleared = env.step(2)[-1]["rounds_cleared"]
    assert cleared == 1


def test_masks_of_many_worlds_are_those_of_each():
    env = ArkanoidVectorEnv(5, lives=100)
    env.reset(seed=3)
    singles = [ArkanoidEnv(lives=100) for _ in range(5)]
    for index, single in enumerate(singles):
        single.reset(seed=3 + index)
    generator = np.random.default_rng(1)
    for _ in range(60):
        actions = generator.integers(0, 6, 5)
        env.step(actions)
        for single, action in zip(singles, actions, strict=True):
            single.step(action)
        masks = env.action_masks()
        assert masks.shape == (5, 6)
        assert np.array_equal(masks, [single.action_masks() for single in singles])
        assert np.array_equal(masks, env.call("action_masks"))


def test_continuous_actions_have_no_masks():
    with pytest.raises(ValueError, match="continuous and have no masks"):
        ArkanoidEnv(actions="box").action_masks()
