"""sbx: stable-baselines3's algorithms in JAX, on the native batch and by an id alone.

It takes the same adapter as stable-baselines3 itself: see `train_with_sb3.py`.
"""

import arkanoid  # noqa: F401 (registers the ids)
import gymnasium as gym
from arkanoid.agents.adapter import GymnasiumVecEnv
from sbx import PPO, SAC


def main() -> None:
    """Train PPO on many games, and SAC on one."""
    worlds = gym.make_vec(
        "ArkanoidLite-v0",
        16,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        lives=1,
    )
    many = PPO("MlpPolicy", GymnasiumVecEnv(worlds), n_steps=64, n_epochs=2, seed=0)
    many.learn(4096)
    print(f"PPO: {many.num_timesteps} steps, {len(many.ep_info_buffer or [])} episodes")

    one = SAC("MlpPolicy", "ArkanoidContinuous-v0", learning_starts=500, train_freq=8, seed=0)
    one.learn(1000)
    print(f"SAC: {one.num_timesteps} steps")


if __name__ == "__main__":
    main()
