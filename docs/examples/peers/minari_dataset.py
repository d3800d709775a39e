"""Minari: a data set of recorded play, written by its collector, and one of a replay.

Games by hand (`arkanoid play`) leave replays; `replay_transitions` makes data of them, in any
observation.
"""

import os
import tempfile
from itertools import chain

os.environ.setdefault("MINARI_DATASETS_PATH", tempfile.mkdtemp())

import gymnasium as gym
import minari
import numpy as np
from arkanoid.envs import Replay, replay_transitions
from minari.data_collector import EpisodeBuffer

GAME = "arkanoid:ArkanoidLite-v0"


def collected() -> minari.MinariDataset:
    """Return a data set that the collector wrote while the game was played at random."""
    env = minari.DataCollector(gym.make(GAME, lives=1))
    env.action_space.seed(0)
    for episode in range(5):
        env.reset(seed=episode)
        over = False
        while not over:
            _, _, terminated, truncated, _ = env.step(env.action_space.sample())
            over = terminated or truncated
    dataset = env.create_dataset("arkanoid/random-v0", algorithm_name="random")
    env.close()
    return dataset


def recorded() -> Replay:
    """Return a recorded game."""
    env = gym.make(GAME).unwrapped
    recorder = env.record()
    env.reset(seed=7)
    env.action_space.seed(7)
    while not env.step(env.action_space.sample())[2]:
        pass
    return recorder.replay()


def of_replays(*replays: Replay) -> minari.MinariDataset:
    """Return a data set of replays, as pictures, an episode per game."""
    looks = {"observation": "rgb", "grey": True, "size": 42}
    episodes = []
    for number, replay in enumerate(replays):
        steps = list(replay_transitions(replay, **looks))
        seen = chain([steps[0].observation], (step.next_observation for step in steps))
        episodes.append(
            EpisodeBuffer(
                id=number,
                observations=list(seen),
                actions=[step.action for step in steps],
                rewards=[step.reward for step in steps],
                terminations=[step.terminated for step in steps],
                truncations=[step.truncated for step in steps],
            )
        )
    return minari.create_dataset_from_buffers(
        "arkanoid/replays-v0",
        buffer=episodes,
        env=gym.make(GAME, **looks),
        algorithm_name="random",
    )


def main() -> None:
    """Write both data sets, read them again, and make the environment that one was collected in."""
    dataset = minari.load_dataset(collected().spec.dataset_id)
    env = dataset.recover_environment()
    episodes, steps = dataset.total_episodes, dataset.total_steps
    print(f"collected: {episodes} episodes, {steps} steps of {env.spec.id}")

    replay = recorded()
    (episode,) = minari.load_dataset(of_replays(replay).spec.dataset_id).iterate_episodes()
    assert np.isclose(episode.rewards.sum(), replay.result.reward)
    assert episode.terminations[-1]
    print(f"of a replay: {len(episode.actions)} steps, pictures {episode.observations.shape}")


if __name__ == "__main__":
    main()
