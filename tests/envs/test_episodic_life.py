"""`episodic_life`: an episode ends with each life, and the game goes on behind it."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv, play_replay
from gymnasium.vector import AutoresetMode

GAME = {"levels": "seeds:0-99", "capsule_rate": 1.0, "speed": 2.0, "lives": 4}


def play(env, decisions, seed=5):
    """Play at random; return observations [n], rewards [n] and whether a game ended, per decision.

    What a reset returns is compared with what the step before returned, but for a new game's.
    """
    generator = np.random.default_rng(0)
    before, _ = env.reset(seed=seed)
    steps = []
    for _ in range(decisions):
        after, reward, terminated, truncated, info = env.step(int(generator.integers(6)))
        over = truncated or info["lives"] == 0
        steps.append((before.tobytes(), reward, over))
        if terminated and not over:
            again, begun = env.reset()
            assert again.tobytes() == after.tobytes()
            assert begun["lives"] == info["lives"] > 0
            assert begun["score"] == info["score"]
            assert begun["lives_lost"] == 0
        elif over:
            after, _ = env.reset()
        before = after
    return steps


@pytest.mark.parametrize("keywords", [{}, {"sticky_action": 0.3}, {"observation": "grid"}])
def test_the_game_is_the_same_with_and_without(keywords):
    """The agent sees more episodes; what is played, seen and paid is the same, bit for bit."""
    whole = ArkanoidEnv(**GAME, **keywords)
    lives = ArkanoidEnv(episodic_life=True, **GAME, **keywords)
    one, other = play(whole, 3000), play(lives, 3000)
    assert one == other
    assert sum(over for *_, over in one) > 3


def test_every_lost_life_ends_an_episode():
    env = ArkanoidEnv(episodic_life=True, **GAME)
    env.reset(seed=1)
    generator = np.random.default_rng(1)
    ends = 0
    for _ in range(2000):
        _, _, terminated, truncated, info = env.step(int(generator.integers(6)))
        assert terminated == (info["lives_lost"] > 0)
        if terminated or truncated:
            ends += 1
            env.reset()
    assert ends > 20


def lose_a_life(env):
    """Do nothing until a life is lost."""
    while True:
        _, _, terminated, _, info = env.step(0)
        if terminated:
            return info


@pytest.mark.parametrize("reset", [{"seed": 7}, {"options": {"level": None}}])
def test_a_seed_or_options_begin_a_new_game(reset):
    env = ArkanoidEnv(episodic_life=True)
    env.reset(seed=0)
    assert lose_a_life(env)["lives"] == 2
    assert env.reset()[1]["lives"] == 2
    assert lose_a_life(env)["lives"] == 1
    first, info = env.reset(**reset)
    assert info["lives"] == 3
    if "seed" in reset:
        assert first.tobytes() == ArkanoidEnv(episodic_life=True).reset(**reset)[0].tobytes()


def test_a_reset_in_the_middle_of_an_episode_begins_a_new_game():
    env = ArkanoidEnv(episodic_life=True)
    env.reset(seed=0)
    lose_a_life(env)
    env.reset()
    env.step(0)
    assert env.reset()[1]["lives"] == 3


def test_the_clock_cuts_the_game_not_the_life():
    """A lost life does not give the game more time."""
    env = ArkanoidEnv(episodic_life=True, max_decisions=200, lives=100)
    env.reset(seed=0)
    for decision in range(1, 201):
        _, _, terminated, truncated, _ = env.step(0)
        if terminated and not truncated:
            env.reset()
        assert truncated == (decision == 200)
    assert env.reset()[1]["lives"] == 100


def test_the_first_picture_of_a_life_fills_the_stack():
    env = ArkanoidEnv(episodic_life=True, observation="rgb", size=40, grey=True, stack=4)
    env.reset(seed=0)
    lose_a_life(env)
    seen, _ = env.reset()
    assert (seen == seen[0]).all()
    assert not (env.step(4)[0] == seen).all()


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_a_batch_goes_on_by_itself(mode):
    env = ArkanoidVectorEnv(3, autoreset_mode=mode, episodic_life=True, **GAME)
    _, infos = env.reset(seed=0)
    generator = np.random.default_rng(0)
    score = infos["score"]
    ends = 0
    for _ in range(500):
        _, _, terminated, _, infos = env.step(generator.integers(0, 6, 3))
        going_on = infos["score"] != 0
        assert (infos["score"] >= score)[going_on].all()
        score = infos["score"]
        ends += (terminated & (infos["lives"] > 0)).sum()
    assert ends > 10


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_a_recording_holds_whole_games(mode):
    """A replay does not end with a life, and knows nothing of the episodes that were made of it."""
    env = ArkanoidVectorEnv(2, autoreset_mode=mode, episodic_life=True, **GAME)
    recorder = env.record(1)
    env.reset(seed=4)
    generator = np.random.default_rng(2)
    replays = []
    lives = 0
    for _ in range(1500):
        _, _, terminated, truncated, _ = env.step(generator.integers(0, 6, 2))
        lives += terminated[1]
        if recorder.finished is not None and recorder.finished not in replays[-1:]:
            replays.append(recorder.finished)
        done = terminated | truncated
        if mode == "Disabled" and done.any():
            env.reset(options={"reset_mask": done})
    assert lives > len(replays) > 2
    for replay in replays:
        assert replay.result.terminated
        assert replay.result.lives == 0
        assert not replay.config.episodic_life
        assert play_replay(replay) == replay.result


def test_a_life_lost_with_the_last_decision_does_not_break_its_replay():
    """The decision that both loses a life and is the last is no terminated game."""
    env = ArkanoidEnv()
    env.reset(seed=0)
    decisions = 1
    while not env.step(0)[-1]["lives_lost"]:
        decisions += 1
    env = ArkanoidEnv(episodic_life=True, max_decisions=decisions)
    recorder = env.record()
    env.reset(seed=0)
    for _ in range(decisions):
        _, _, terminated, truncated, _ = env.step(0)
    assert terminated
    assert truncated
    assert play_replay(recorder.replay()).truncation == 1
    assert env.reset()[1]["lives"] == 3


def test_a_snapshot_knows_that_a_life_was_lost():
    env, other = (ArkanoidEnv(episodic_life=True, **GAME) for _ in range(2))
    env.reset(seed=2)
    lives = lose_a_life(env)["lives"]
    other.restore(env.snapshot())
    assert other.reset()[1]["lives"] == env.reset()[1]["lives"] == lives
