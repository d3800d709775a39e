"""Sb3-contrib on the native batch: a recurrent agent, an off-policy one, and one with masks.

All use the same adapter as stable-baselines3: see `train_with_sb3.py`.
"""

import gymnasium as gym
from arkanoid.agents.adapter import GymnasiumVecEnv
from sb3_contrib import QRDQN, MaskablePPO, RecurrentPPO
from stable_baselines3.common.vec_env import VecEnv

GAME = "arkanoid:ArkanoidLite-v0"


def native(count: int) -> VecEnv:
    """Return `count` games as one native batch."""
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

    # It asks the environment which actions do something (`action_masks`), and tries no others.
    masks = MaskablePPO("MlpPolicy", native(16), n_steps=64, n_epochs=2, seed=0)
    masks.learn(4096)
    print(f"MaskablePPO: {masks.num_timesteps} steps, {episodes(masks)} episodes")


def episodes(agent: RecurrentPPO | QRDQN | MaskablePPO) -> int:
    """Return the number of episodes whose returns the agent has kept."""
    return len(agent.ep_info_buffer or [])


if __name__ == "__main__":
    main()
