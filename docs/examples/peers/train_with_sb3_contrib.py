"""Sb3-contrib: an agent with a memory on the native batch, and one that learns off the policy.

Both take the same adapter as stable-baselines3 itself: see `train_with_sb3.py`.
"""

import gymnasium as gym
from arkanoid.agents.adapter import GymnasiumVecEnv
from sb3_contrib import QRDQN, RecurrentPPO
from stable_baselines3.common.vec_env import VecEnv

GAME = "arkanoid:ArkanoidLite-v0"


def native(count: int) -> VecEnv:
    """Return `count` games that one kernel steps."""
    worlds = gym.make_vec(
        GAME,
        count,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        levels="ripple",
        lives=1,
    )
    return GymnasiumVecEnv(worlds)


def main() -> None:
    """Train each a little."""
    remembers = RecurrentPPO("MlpLstmPolicy", native(16), n_steps=64, n_epochs=2, seed=0)
    remembers.learn(4096)
    print(f"RecurrentPPO: {remembers.num_timesteps} steps, {episodes(remembers)} episodes")

    replays = QRDQN("MlpPolicy", native(16), buffer_size=20_000, learning_starts=1000, seed=0)
    replays.learn(8192)
    print(f"QRDQN: {replays.num_timesteps} steps, {episodes(replays)} episodes")


def episodes(agent: RecurrentPPO | QRDQN) -> int:
    """Return how many of the latest episodes the agent knows the return of."""
    return len(agent.ep_info_buffer or [])


if __name__ == "__main__":
    main()
