"""Transitions of a replay are those that the player's environment gave."""

from itertools import pairwise

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv, ReplayDivergedError, replay_transitions
from arkanoid.envs.state import INFO_FIELDS
from helpers.states import portable_bytes

VIEWS = [
    {},
    {"observation": "grid"},
    {"observation": "rgb", "size": 30, "grey": True, "stack": 3},
    {"observation": "dict", "size": 24, "channels": "last"},
    {"landing": True},
]


def same(one, other):
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        return all(same(one[name], other[name]) for name in one)
    return one.dtype == other.dtype and one.tobytes() == other.tobytes()


def played(seen, actions="discrete6", **game):
    """Play a game at random; return its replay and what `step` gave."""
    env = ArkanoidEnv(**seen, actions=actions, capsule_rate=1.0, **game)
    recorder = env.record()
    before, _ = env.reset(seed=3)
    env.action_space.seed(1)
    steps = []
    over = False
    while not over:
        action = env.action_space.sample()
        after, *rest = env.step(action)
        steps.append((before, action, *rest, after))
        _, terminated, truncated, info = rest
        over = truncated or info["lives"] == 0
        before = env.reset()[0] if terminated and not over else after
    return recorder.replay(), steps


def played_in_a_batch(mode, **keywords):
    """Play in the second of three worlds; return its replay and what `step` gave for that world."""
    env = ArkanoidVectorEnv(3, autoreset_mode=mode, **keywords)
    recorder = env.record(1)
    before = env.reset(seed=3)[0][1]
    generator = np.random.default_rng(1)
    steps = []
    begins = False
    while True:
        actions = generator.integers(0, 6, 3)
        seen, rewards, *flags, infos = env.step(actions)
        terminated, truncated = (bool(flag[1]) for flag in flags)
        ended = mode == "SameStep" and (terminated or truncated)
        after = infos["final_obs"][1] if ended else seen[1]
        found = infos["final_info"] if ended else infos
        info = {name: found[name][1].item() for name in INFO_FIELDS}
        if not begins:
            steps.append(
                (before, actions[1], rewards[1].item(), terminated, truncated, info, after)
            )
        if truncated or info["lives"] == 0:
            return recorder.finished, steps
        begins = mode == "NextStep" and terminated
        before = seen[1]
        done = flags[0] | flags[1]
        if mode == "Disabled" and done.any():
            before = env.reset(options={"reset_mask": done})[0][1]


def agree(transitions, steps):
    """Compare transitions with what `step` gave."""
    assert len(transitions) == len(steps) >= 20
    for transition, (before, action, reward, terminated, truncated, info, after) in zip(
        transitions, steps, strict=True
    ):
        assert same(transition.observation, before)
        assert transition.action == action
        assert transition.reward == reward
        assert transition.terminated is terminated
        assert transition.truncated is truncated
        assert transition.info == info
        assert same(transition.next_observation, after)


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("recorded", [*VIEWS[:3], VIEWS[-1]])
def test_transitions_are_what_the_environment_gave(view, recorded):
    """In any observation, whatever was observed when the game was recorded."""
    game = {"sticky_action": 0.25, "speed": 2.0}
    replay = played(recorded, **game)[0]
    steps = played(view, **game)[1]
    transitions = list(replay_transitions(replay, **view))
    agree(transitions, steps)
    assert all(one.next_observation is two.observation for one, two in pairwise(transitions))


LIVES = {"episodic_life": True, "lives": 4, "speed": 2.0, "life_penalty": 0.5}


@pytest.mark.parametrize("view", VIEWS)
def test_each_life_is_an_episode_if_the_player_had_it_so(view):
    """No transition ended at a lost life, and stacks of pictures went on behind it."""
    replay, steps = played(view, sticky_action=0.25, **LIVES)
    transitions = list(replay_transitions(replay, episodic_life=True, **view))
    agree(transitions, steps)
    assert sum(step.terminated for step in transitions) == 4
    whole = list(replay_transitions(replay, **view))
    assert [step.terminated for step in whole] == [False] * (len(whole) - 1) + [True]


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
@pytest.mark.parametrize("view", VIEWS[::2])
def test_each_life_of_a_world_in_a_batch_is_an_episode(view, mode):
    replay, steps = played_in_a_batch(mode, **view, **LIVES)
    agree(list(replay_transitions(replay, episodic_life=True, **view)), steps)


def test_a_clock_cuts_a_game_of_several_lives():
    replay, steps = played({}, **LIVES | {"lives": 20}, max_decisions=100)
    transitions = list(replay_transitions(replay, episodic_life=True))
    agree(transitions, steps)
    assert transitions[-1].truncated
    assert sum(step.terminated for step in transitions) > 0


def test_a_file_will_do_and_actions_take_another_form(tmp_path):
    replay, steps = played({}, "discrete3")
    replay.save(tmp_path / "game.replay")
    for actions in ("discrete4", "discrete6", "box"):
        numbers = [step[1] for step in steps]
        transitions = list(replay_transitions(tmp_path / "game.replay", actions))
        env = ArkanoidEnv(actions=actions)
        assert all(env.action_space.contains(each.action) for each in transitions)
        if actions == "discrete6":
            assert [each.action for each in transitions] == numbers
        if actions == "box":
            moves = [each.action.tolist() for each in transitions]
            assert moves == [[(0.0, -1.0, 1.0)[number], 0.0] for number in numbers]


def test_what_a_form_of_actions_lacks_is_named():
    replay, _ = played({}, "box", max_decisions=5)
    with pytest.raises(ValueError, match=r"'discrete6' has no action for velocity and fire .* 0"):
        replay_transitions(replay, "discrete6")
    for actions in ("buttons", "", []):
        with pytest.raises(ValueError, match="actions must be box or one of"):
            replay_transitions(replay, actions)


def test_only_what_is_seen_can_be_chosen():
    replay, _ = played({}, max_decisions=5)
    with pytest.raises(ValueError, match="'reward' does not say how a game is seen"):
        replay_transitions(replay, reward="score")
    with pytest.raises(ValueError, match="leave it out"):
        list(replay_transitions(replay, grey=True))


def test_a_game_that_takes_another_course_is_noticed():
    replay, _ = played({}, "discrete3")
    commands = replay.commands.copy()
    commands[:, 0] = np.abs(commands[:, 0])
    object.__setattr__(replay, "commands", commands)
    with pytest.raises(ReplayDivergedError):
        list(replay_transitions(replay))


@pytest.mark.parametrize("vector", [False, True])
@pytest.mark.parametrize("form", [np.float64, np.float16, np.longdouble])
def test_continuous_actions_are_played_recorded_and_yielded_as_one_number(vector, form):
    """A step played 0.3 with 64 bits, and the transition had it with 32: another action."""
    actions = np.random.default_rng(0).uniform(-1.1, 1.1, (40, 2)).astype(form)
    actions[:3, 1] = 1e-60, -1e-60, 1.0  # the first one is no float32 above 0
    env = ArkanoidVectorEnv(1, actions="box") if vector else ArkanoidEnv(actions="box")
    plain = ArkanoidEnv(actions="box")
    recorder = env.record()
    env.reset(seed=0)
    plain.reset(seed=0)
    for action in actions:
        env.step(action[np.newaxis] if vector else action)
        plain.step(action.astype(np.float32))
        state = env.state[0] if vector else env.state
        assert state.tobytes() == plain.state.tobytes()
    transitions = list(replay_transitions(recorder.replay()))
    env.reset(seed=0)
    for transition in transitions:
        env.step(transition.action[np.newaxis] if vector else transition.action)
    assert portable_bytes(env.state[0] if vector else env.state) == portable_bytes(plain.state)
    velocities = np.array([each.action[0] for each in transitions])
    assert velocities.dtype == np.float32
    assert (velocities == np.clip(actions[:, 0].astype(np.float32), -1, 1)).all()


def test_velocities_that_are_no_float32_are_no_continuous_actions():
    """Their transitions had another action than was played."""
    replay, _ = played({}, "box", max_decisions=5)
    commands = replay.commands.copy()
    commands[2, 0] = 0.3
    object.__setattr__(replay, "commands", commands)
    with pytest.raises(ValueError, match=r"'box' has no action .*0\.3,.* decision 2: .*float32"):
        replay_transitions(replay)
