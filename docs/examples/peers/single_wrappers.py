"""Gymnasium's wrappers for single environments: pictures, films, statistics, clocks, actions.

`AtariPreprocessing` itself works only with the Atari emulator. The keywords `observation="rgb",
grey=True, stack=4` give such pictures, without drawing the frames that are skipped. The wrappers
below make them step by step.
"""

from pathlib import Path

import gymnasium as gym
import numpy as np
from gymnasium import wrappers
from gymnasium.utils.env_checker import check_env

GAME = "arkanoid:Arkanoid-v0"


def play(env: gym.Env, steps: int = 200) -> np.ndarray:
    """Play at random, and return the last observation."""
    observation, _ = env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(steps):
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)
        if terminated or truncated:
            observation, _ = env.reset()
    env.close()
    return observation


def atari_like() -> gym.Env:
    """Return the game as Atari is observed: four grey pictures of 84 × 84, four ticks apart."""
    env = gym.make(GAME, observation="rgb", size=(168, 132), frame_skip=1)
    env = wrappers.TransformObservation(
        env, lambda seen: seen.transpose(1, 2, 0), gym.spaces.Box(0, 255, (168, 132, 3), np.uint8)
    )
    env = wrappers.MaxAndSkipObservation(env, skip=4)
    env = wrappers.ResizeObservation(wrappers.GrayscaleObservation(env), (84, 84))
    return wrappers.FrameStackObservation(env, 4)


def main() -> None:
    """Check the environment, and play it in several stacks of wrappers."""
    check_env(gym.make(GAME, render_mode="rgb_array").unwrapped)
    print("check_env: passed")
    print("like Atari's, by wrappers:", *play(atari_like()).shape)
    keywords = gym.make(GAME, observation="rgb", grey=True, stack=4)
    print("like Atari's, by keywords:", *play(keywords).shape)

    numbers = wrappers.RecordEpisodeStatistics(gym.make(GAME, max_episode_steps=50))
    numbers = wrappers.NormalizeReward(wrappers.NormalizeObservation(numbers))
    play(wrappers.TimeAwareObservation(wrappers.FrameStackObservation(numbers, 2)))
    print("TimeLimit:", max(numbers.get_wrapper_attr("length_queue")), "steps in the longest")

    moves = wrappers.RescaleAction(gym.make(GAME, actions="box"), np.float32(-2), np.float32(2))
    play(wrappers.StickyAction(wrappers.ClipAction(moves), 0.25))
    print("actions: rescaled, clipped, sticky")

    filmed = wrappers.RecordVideo(
        gym.make(GAME, render_mode="rgb_array", lives=1), "films", video_length=60
    )
    play(filmed)
    print("films:", *sorted(film.name for film in Path("films").iterdir()))


if __name__ == "__main__":
    main()
