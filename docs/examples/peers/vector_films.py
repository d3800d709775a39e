"""Films of the first world of a vector environment, with Gymnasium's `RecordVideo` (from 1.2 on).

It uses the default mode "NextStep". In "SameStep" a film lacks the last picture of its episode.
"""

from pathlib import Path

import gymnasium as gym
from gymnasium.wrappers.vector import RecordVideo


def main() -> None:
    """Film the first sixty steps of random play."""
    worlds = gym.make_vec(
        "arkanoid:ArkanoidLite-v0",
        num_envs=8,
        vectorization_mode="vector_entry_point",
        render_mode="rgb_array",
    )
    env = RecordVideo(worlds, "films", step_trigger=lambda step: step == 1, video_length=60)
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(100):
        env.step(env.action_space.sample())
    env.close()
    for film in sorted(Path("films").glob("*-step-*.mp4")):
        print(film.name, film.stat().st_size, "bytes")


if __name__ == "__main__":
    main()
