"""Gymnasium's wrappers for vector environments, on the native batch.

`NormalizeObservation` needs Gymnasium's default mode, `autoreset_mode="NextStep"`: the step after
the end of an episode ignores its action and begins the next episode.
"""

import gymnasium as gym
import numpy as np
from arkanoid.envs import ArkanoidVectorEnv
from gymnasium.wrappers import vector

GAME = "arkanoid:ArkanoidLite-v0"
STEPS = 400


def make(**keywords: object) -> gym.vector.VectorEnv:
    """Return eight short games."""
    return gym.make_vec(
        GAME, 8, vectorization_mode="vector_entry_point", lives=1, levels="ripple", **keywords
    )


def play(env: gym.vector.VectorEnv) -> np.ndarray:
    """Play at random, and return the last observations."""
    observations, _ = env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(STEPS):
        observations, *_ = env.step(env.action_space.sample())
        assert observations.shape == env.observation_space.shape
    env.close()
    return observations


def main() -> None:
    """Play in several stacks of wrappers."""
    numbers = vector.RecordEpisodeStatistics(make())
    scaled = vector.NormalizeReward(vector.NormalizeObservation(numbers), gamma=0.99)
    play(vector.ClipReward(scaled, -10, 10))
    print(f"statistics: {numbers.episode_count} episodes, mean length {lengths(numbers):.0f}")

    restarting = vector.RecordEpisodeStatistics(make(autoreset_mode="SameStep"))
    play(vector.NormalizeReward(restarting))
    print(f"same step: {restarting.episode_count} episodes, mean length {lengths(restarting):.0f}")

    pictures = make(observation="rgb", size=84)
    last_axis = vector.TransformObservation(
        pictures,
        lambda seen: seen.transpose(0, 2, 3, 1),
        single_observation_space=gym.spaces.Box(0, 255, (84, 84, 3), np.uint8),
    )
    small = vector.ResizeObservation(vector.GrayscaleObservation(last_axis), (42, 42))
    print("pictures:", play(vector.DtypeObservation(small, np.float32)).shape)

    listed = vector.DictInfoToList(make())
    _, infos = listed.reset(seed=0)
    print("infos:", len(infos), "of", infos[0]["lives"], "life")
    assert isinstance(listed.unwrapped, ArkanoidVectorEnv)


def lengths(env: vector.RecordEpisodeStatistics) -> float:
    """Return the mean length of the latest episodes."""
    return float(np.mean(env.length_queue))


if __name__ == "__main__":
    main()
