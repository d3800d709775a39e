"""The small part of Atari's interface that wrappers ask for, with the wrappers themselves."""

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv

GAME = "arkanoid:ArkanoidNoFrameskip-v0"


def play(env, steps):
    """Play at random; return the ends of episodes, and the numbers of lives at their beginnings."""
    seen, info = env.reset(seed=0)
    env.action_space.seed(0)
    begun = []
    for _ in range(steps):
        assert env.observation_space.contains(seen)
        seen, _, terminated, truncated, info = env.step(env.action_space.sample())
        if terminated or truncated:
            begun.append(info["lives"])
            seen, _ = env.reset()
    return begun


def test_stable_baselines3s_wrapper():
    """Every life ends an episode, and fire serves."""
    wrappers = pytest.importorskip("stable_baselines3.common.atari_wrappers")
    env = wrappers.AtariWrapper(gym.make(GAME))
    assert env.observation_space.shape == (84, 84, 1)
    assert {0, 1, 2} <= set(play(env, 600))


def test_fire_reset_and_episodic_life_of_stable_baselines3():
    """They work without the library for pictures, too."""
    wrappers = pytest.importorskip("stable_baselines3.common.atari_wrappers")
    env = wrappers.FireResetEnv(
        wrappers.EpisodicLifeEnv(gym.make("Arkanoid-v0", actions="discrete4"))
    )
    seen, _ = env.reset(seed=0)
    assert seen[env.unwrapped.layout["ball_held"]].sum() == 0
    assert {0, 1, 2} <= set(play(env, 600))


def test_gymnasiums_preprocessing():
    env = gym.wrappers.AtariPreprocessing(gym.make(GAME), terminal_on_life_loss=True)
    assert env.observation_space.shape == (84, 84)
    assert set(play(env, 600)) == {2}  # it begins a new game after each life
    colours = gym.wrappers.AtariPreprocessing(gym.make(GAME), grayscale_obs=False, screen_size=60)
    colours.reset(seed=0)
    assert colours.step(1)[0].shape == (60, 60, 3)
    with pytest.raises(ValueError, match="frame-skip"):
        gym.wrappers.AtariPreprocessing(gym.make(GAME, frame_skip=4))


def test_the_emulators_pictures_are_the_environments():
    looks = {"observation": "rgb", "size": (40, 30), "channels": "last"}
    colours, grey = ArkanoidEnv(**looks), ArkanoidEnv(**looks, grey=True)
    in_colours, seen = (each.reset(seed=0) and each.step(4)[0] for each in (colours, grey))
    buffer = np.empty((40, 30), np.uint8)
    assert grey.ale.getScreenGrayscale(buffer) is buffer
    assert np.array_equal(buffer, seen[:, :, 0])
    assert np.array_equal(grey.ale.getScreenGrayscale(), buffer)
    assert np.array_equal(grey.ale.getScreenRGB(), in_colours)


READ_ONLY = np.empty((4, 4, 3), np.uint8)
READ_ONLY.flags.writeable = False


@pytest.mark.parametrize(
    ("colours", "buffer", "error"),
    [
        (True, np.empty((40, 30), np.uint8), ValueError),
        (True, np.empty((40, 30, 1), np.uint8), ValueError),
        (True, np.empty((0, 30, 3), np.uint8), ValueError),
        (True, np.empty(40, np.uint8), ValueError),
        (True, np.empty((5000, 1, 3), np.uint8), ValueError),
        (True, np.empty((40, 30, 3)), TypeError),
        (True, [[0]], TypeError),
        (True, READ_ONLY, ValueError),
        (False, np.empty((40, 30, 3), np.uint8), ValueError),
        (False, b"", TypeError),
    ],
)
def test_a_buffer_that_takes_no_picture_is_refused(colours, buffer, error):
    """NumPy's words spoke of shapes that could not be broadcast, or of division by zero."""
    env = ArkanoidEnv()
    env.reset(seed=0)
    show = env.ale.getScreenRGB if colours else env.ale.getScreenGrayscale
    with pytest.raises(error, match=r"the buffer must be a writable array of uint8, \[height, wi"):
        show(buffer)


def test_lives_are_those_of_info():
    env = ArkanoidEnv(lives=2)
    _, info = env.reset(seed=0)
    lives = {info["lives"]}
    terminated = False
    while not terminated:
        _, _, terminated, _, info = env.step(0)
        assert env.ale.lives() == info["lives"]
        assert env.ale.game_over() == terminated
        lives.add(info["lives"])
    assert lives == {0, 1, 2}
