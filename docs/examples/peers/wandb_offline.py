"""Weights & Biases: a run without a network, with its curve, a film and the settings.

`wandb sync` sends it later. `RecordVideo` writes the film (it needs `moviepy`).
"""

import os
from pathlib import Path

os.environ.setdefault("WANDB_MODE", "offline")
os.environ.setdefault("WANDB_SILENT", "true")

import gymnasium as gym
import wandb
from gymnasium.wrappers import RecordEpisodeStatistics, RecordVideo


def main() -> None:
    """Log a few games of random play."""
    env = gym.make("arkanoid:ArkanoidLite-v0", render_mode="rgb_array", render_size=128, lives=1)
    run = wandb.init(project="arkanoid", config=env.unwrapped.config.plain())
    env = RecordVideo(env, "films", episode_trigger=lambda episode: episode == 0)
    env = RecordEpisodeStatistics(env)
    env.action_space.seed(0)
    for episode in range(5):
        env.reset(seed=episode)
        over = False
        while not over:
            _, _, terminated, truncated, info = env.step(env.action_space.sample())
            over = terminated or truncated
        run.log({"return": info["episode"]["r"], "length": info["episode"]["l"], **info_of(info)})
    env.close()
    (film,) = Path("films").glob("*.mp4")
    run.log({"film": wandb.Video(str(film), format="mp4")})
    returns = run.summary["return"]
    run.finish()
    kept = sorted(path.name for path in Path("wandb").glob("offline-run-*/*.wandb"))
    assert len(kept) == 1
    print(f"logged offline: {episode + 1} games, the last one's return {returns:.3f}, a film")


def info_of(info: dict) -> dict[str, float]:
    """Return what `info` tells of a game, for a chart each."""
    return {f"game/{key}": info[key] for key in ("score", "lives", "round", "bricks_left")}


if __name__ == "__main__":
    main()
