"""AgileRL: a small population of PPO agents on the native batch.

Its own vector environments are processes of one game each; the native batch stands in for them.
"""

import gymnasium as gym
from agilerl.algorithms.ppo import PPO
from agilerl.training.train_on_policy import train_on_policy

WORLDS = 32


def main() -> None:
    """Train two agents for a few updates, and measure them."""
    worlds = gym.make_vec(
        "arkanoid:ArkanoidLite-v0",
        WORLDS,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        lives=1,
        max_decisions=300,
    )
    population = [
        PPO(
            worlds.single_observation_space,
            worlds.single_action_space,
            index=index,
            num_envs=WORLDS,
            learn_step=1024,
            batch_size=256,
            lr=3e-4,
        )
        for index in range(2)
    ]
    population, returns = train_on_policy(
        worlds,
        "ArkanoidLite-v0",
        "PPO",
        population,
        max_steps=4096,
        evo_steps=2048,
        eval_steps=300,
        verbose=False,
    )
    print(f"trained: {len(population)} agents, returns {returns}")


if __name__ == "__main__":
    main()
