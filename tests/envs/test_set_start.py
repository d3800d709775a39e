"""Choosing the next level of a world while its present game goes on."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidVectorEnv
from arkanoid.envs.batch.playback import play_replay
from arkanoid.envs.levels import generate_level

LITE = {"actions": "discrete3", "capsules": False, "enemies": False, "levels": "seeds:0-99"}


def lattice(env: ArkanoidVectorEnv, world: int) -> np.ndarray:
    return env.state["kind"][world]


def generated(seed: int, difficulty: float) -> np.ndarray:
    return generate_level(seed, difficulty=difficulty).kinds.ravel()


def play_until_a_game_ends(env: ArkanoidVectorEnv) -> np.ndarray:
    """Do nothing until games end; return which, bool [n]."""
    for _ in range(1000):
        *_, terminated, truncated, _ = env.step(np.zeros(env.num_envs, np.int64))
        if (terminated | truncated).any():
            return terminated | truncated
    raise AssertionError("no game has ended")


def test_the_present_game_goes_on_and_the_next_begins_on_the_chosen_level() -> None:
    env = ArkanoidVectorEnv(2, autoreset_mode="SameStep", lives=1, **LITE)
    other = ArkanoidVectorEnv(2, autoreset_mode="SameStep", lives=1, **LITE)
    for each in (env, other):
        each.reset(seed=1)
        each.step(np.array([1, 2]))
    env.set_start(0, {"seed": 7, "difficulty": 0.25})
    for _ in range(20):
        one, two = env.step(np.array([0, 0])), other.step(np.array([0, 0]))
        np.testing.assert_array_equal(one[0], two[0])
    ended = np.zeros(2, np.bool_)
    while not ended.all():
        now = play_until_a_game_ends(env)
        for world in np.flatnonzero(now & ~ended):
            chosen = np.array_equal(lattice(env, world), generated(7, 0.25))
            assert chosen == (world == 0)
        ended |= now
    env.close()
    other.close()


def test_a_level_that_repeats_is_played_again_and_a_new_choice_comes_with_the_next_round() -> None:
    env = ArkanoidVectorEnv(1, autoreset_mode="SameStep", **LITE, lives=1000)
    env.reset(seed=0, options={"seed": 3, "difficulty": 0.0, "repeat": True})
    chosen = [(3, 0.0), (11, 0.5), (12, 0.5)]
    rounds = 1
    env.set_start(0, {"seed": 11, "difficulty": 0.5, "repeat": True})
    for _ in range(200_000):
        state = env.state[0]
        in_play = state["ball_y"][0]
        # It follows the ball, and steers it by hitting with changing parts of the paddle.
        offset = 12.0 * np.sin(0.37 * state["decisions"] + rounds)
        gap = state["ball_x"][0] + offset - state["paddle_x"]
        env.step(np.array([0 if abs(gap) < 2 or in_play < 0 else 1 if gap < 0 else 2]))
        if env.state["rounds_cleared"][0]:
            np.testing.assert_array_equal(lattice(env, 0), generated(*chosen[rounds]))
            rounds += 1
            if rounds == len(chosen):
                break
            env.set_start(0, {"seed": 12, "difficulty": 0.5, "repeat": True})
    assert rounds == len(chosen)
    env.close()


def test_a_snapshot_and_a_reset_know_the_choice() -> None:
    env = ArkanoidVectorEnv(2, autoreset_mode="SameStep", **LITE)
    env.reset(seed=1)
    env.set_start(1, {"seed": 7, "difficulty": 0.25, "repeat": True})
    snapshot = env.snapshot()
    env.reset()
    np.testing.assert_array_equal(lattice(env, 1), generated(7, 0.25))
    env.reset(seed=5)
    env.restore(snapshot)
    env.reset()
    np.testing.assert_array_equal(lattice(env, 1), generated(7, 0.25))
    # A seed forgets the choice.
    env.reset(seed=5)
    assert not np.array_equal(lattice(env, 1), generated(7, 0.25))


def test_a_replay_of_a_level_that_repeats_is_the_game_again() -> None:
    env = ArkanoidVectorEnv(1, autoreset_mode="SameStep", lives=1, **LITE)
    recorder = env.record()
    env.reset(seed=0, options={"seed": 3, "difficulty": 0.5, "repeat": True})
    play_until_a_game_ends(env)
    replay = recorder.finished
    assert replay is not None
    assert play_replay(replay) == replay.result
    env.set_start(0, {"seed": 4})
    with pytest.raises(RuntimeError, match="no game is recorded"):
        recorder.replay()
    play_until_a_game_ends(env)
    env.step(np.zeros(1, np.int64))
    recorder.replay()


@pytest.mark.parametrize(
    ("world", "options", "error", "words"),
    [
        (0, {"seed": -1}, ValueError, "'seed'"),
        (0, {"sed": 1}, ValueError, "did you mean 'seed'"),
        (0, {"reset_mask": np.ones(2, np.bool_)}, ValueError, "reset_mask"),
        (True, {"seed": 1}, TypeError, "world"),
        (0, {"repeat": True}, ValueError, "give reset 'seed'"),
        (0, {"seed": 1, "repeat": 1}, TypeError, "'repeat'"),
        (0, {"seed": 1, "difficulty": 2.0}, ValueError, "'difficulty'"),
        (2, {"seed": 1}, ValueError, "world must be between 0 and 1"),
    ],
)
def test_an_illegal_choice_changes_nothing(world, options, error, words) -> None:
    env = ArkanoidVectorEnv(2, **LITE)
    env.reset(seed=1)
    before = env.snapshot()
    with pytest.raises(error, match=words):
        env.set_start(world, options)
    assert env.snapshot() == before
