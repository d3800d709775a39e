"""Masks of actions: what is masked does nothing, what does something is not masked."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.actions import COMMANDS
from arkanoid.envs.state import World

# All that a command leaves behind whatever it does.
REMEMBERED = ("move", "fire")


@pytest.fixture
def few_bricks(tmp_path):
    path = tmp_path / "few.txt"
    path.write_text(FEW_BRICKS)
    return path


def state(env):
    """Return what a world is but for the latest command."""
    worlds = env._batch.worlds
    # Field by field: what lies between the fields is nothing.
    return b"".join(worlds[name].tobytes() for name in World.names if name not in REMEMBERED)


# Capsules, lost lives and new rounds come often, and several of them within one decision.
LIVELY = {"capsule_rate": 1.0, "lives": 9, "levels": "seeds:0-99"}
GAMES = [
    {"speed": 2.0, "frame_skip": 4},
    {"speed": 2.0, "frame_skip": 1},
    {"speed": 3.0, "frame_skip": 2, "sticky_action": 0.3},
    {"speed": 1.0, "frame_skip": 9, "episodic_life": True},
    {"speed": 5.0, "frame_skip": 4, "episodic_life": True, "paddle": 3.0},
    {"speed": 1.5, "frame_skip": 17, "capsules": False},
    {"speed": 1.0, "frame_skip": 40},
    {"speed": 2.0, "frame_skip": 6, "levels": "warden"},
    {"speed": 2.0, "frame_skip": 8, "levels": "FEW", "sticky_action": 0.1},
    {"speed": 20.0, "frame_skip": 3, "levels": "FEW", "deflection": "physical"},
]
# Rounds of few bricks are soon cleared.
FEW_BRICKS = "name: Few\n\n.....w.....\n....b......\n"


def without_masked_parts(table, action, masks):
    """Return the action that is left of a masked one without its parts that do nothing."""
    move, fire = table[action]
    if move != 0.0 and not masks[table.index([move, 0.0])]:
        move = 0.0
    if fire == 1.0 and not masks[table.index([0.0, 1.0])]:
        fire = 0.0
    return table.index([move, fire])


@pytest.mark.parametrize("game", GAMES, ids=str)
@pytest.mark.parametrize("actions", ["discrete3", "discrete4", "discrete6"])
def test_what_is_masked_does_nothing(actions, game, few_bricks):
    """A masked action leads to the state that the same action without its masked part leads to.

    Fire was masked although a ball was about to be lost, and the next one waited to be served
    within the same decision.
    """
    keywords = LIVELY | game
    if keywords["levels"] == "FEW":
        keywords["levels"] = [few_bricks]
    env = ArkanoidEnv(actions=actions, **keywords)
    env.reset(seed=0)
    generator = np.random.default_rng(0)
    table = COMMANDS[actions].tolist()
    compared = np.zeros(len(table), int)
    for decision in range(4000):
        masks = env.action_masks()
        assert masks.dtype == np.bool_
        assert masks[0]
        for action in np.flatnonzero(~masks).tolist():
            instead = without_masked_parts(table, action, masks)
            assert masks[instead]
            one, other = env.clone(), env.clone()
            assert one.step(action)[1:] == other.step(instead)[1:]
            assert state(one) == state(other), (action, instead)
            compared[action] += 1
        # Along the walls more often than by chance.
        legal = np.flatnonzero(masks)
        side = (-1.0, 1.0)[decision // 200 % 2]
        preferred = [action for action in legal if table[action][0] == side]
        chosen = generator.choice(preferred if preferred and decision % 3 else legal)
        *_, terminated, truncated, _info = env.step(int(chosen))
        if terminated or truncated:
            env.reset()
    moves = [action for action in range(len(table)) if table[action][0] != 0.0]
    assert compared[moves].all(), compared


def test_fire_is_masked_most_of_the_time():
    """A mask that hides nothing would be right, too, and useless."""
    env = ArkanoidEnv(lives=100)
    env.reset(seed=0)
    generator = np.random.default_rng(0)
    hidden = 0
    for _ in range(2000):
        hidden += not env.action_masks()[3]
        if env.step(int(generator.integers(6)))[2]:
            env.reset()
    assert hidden > 1000


def test_fire_serves_the_next_ball_within_the_decision():
    env = ArkanoidEnv(actions="discrete4", lives=9)
    env.reset(seed=0)
    served = 0
    while served < 3:
        one, other = env.clone(), env.clone()
        lost = one.step(1)[-1]["lives_lost"]
        other.step(0)
        if lost and state(one) != state(other):
            assert env.action_masks()[1]
            served += 1
        env.step(0)


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
