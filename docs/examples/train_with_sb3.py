"""Stable-baselines3 in two ways: on its own vector of single environments, and on the native batch.

The native batch steps all games in one call and is much faster. `GymnasiumVecEnv` adapts it without
changing a number. Its worlds must restart in the step that ends their episode:
`autoreset_mode="SameStep"`.
"""

import gymnasium as gym
import torch
from arkanoid.agents.adapter import GymnasiumVecEnv
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.vec_env import VecEnv

GAME = "arkanoid:ArkanoidLite-v0"
EASY = {"levels": "ripple", "lives": 1}


def native(count: int) -> VecEnv:
    """Return `count` games as one native batch."""
    worlds = gym.make_vec(
        GAME, count, vectorization_mode="vector_entry_point", autoreset_mode="SameStep", **EASY
    )
    return GymnasiumVecEnv(worlds)


def main() -> None:
    """Train a little in both ways, and a third time from pictures."""
    torch.set_num_threads(1)  # the networks are too small for more
    singles = make_vec_env(GAME, n_envs=4, seed=0, env_kwargs=EASY)
    PPO("MlpPolicy", singles, n_steps=128, n_epochs=2, seed=0).learn(1024)
    print("make_vec_env: trained")

    worlds = native(64)
    agent = PPO("MlpPolicy", worlds, n_steps=64, batch_size=512, n_epochs=4, seed=0)
    agent.learn(16_384)
    mean, spread = evaluate_policy(agent, native(16), n_eval_episodes=16)
    print(f"native batch: trained, reward {mean:.2f} ± {spread:.2f}")

    # Four grey pictures with the channels first, as "CnnPolicy" expects them.
    pictures = EASY | {"observation": "rgb", "grey": True, "stack": 4}
    seeing = make_vec_env(GAME, n_envs=2, seed=0, env_kwargs=pictures)
    PPO("CnnPolicy", seeing, n_steps=32, batch_size=64, n_epochs=1, seed=0).learn(64)
    print("pictures: trained")


if __name__ == "__main__":
    main()
