"""PPO with RLlib on the native vector environment: on this machine, or on a cluster.

Each environment runner is a process on any machine where Ray finds a free core, and steps all its
worlds with one call. In a clone, install with ``pip install -c constraints-ray.txt -e ".[ray]"``::

    python rllib_ppo.py --runners 2 --decisions 300_000 --save model
    python rllib_ppo.py --runners 64 --address auto    # on a node of a running cluster
"""

import argparse
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import ray
import torch
from ray.rllib.algorithms.algorithm import Algorithm
from ray.rllib.algorithms.ppo import PPO, PPOConfig
from ray.tune.registry import register_env

# Start Ray on this machine alone, even if a cluster runs here. 200 MB hold the episodes on their
# way from the runners to the learner.
ALONE = {"address": "local", "include_dashboard": False, "object_store_memory": 200_000_000}


class SpreadSeeds(gym.vector.VectorWrapper):
    """Gives all worlds of all runners different seeds.

    RLlib seeds runner k with ``seed + k``, and a vector environment its world i with ``seed + i``.
    So world 1 of a runner would play the games of world 0 of the next one.
    """

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        """Reset all worlds, each with its own seed, which follows from ``seed``."""
        if seed is None:
            return self.env.reset(options=options)
        seeds = np.random.SeedSequence(seed).generate_state(self.num_envs, np.uint64) >> 1
        return self.env.reset(seed=seeds.tolist(), options=options)


def make_worlds(settings: dict[str, Any]) -> gym.vector.VectorEnv:
    """Return a runner's worlds. RLlib adds ``num_envs`` to the settings.

    The autoreset mode stays at its default NEXT_STEP, the only one that RLlib understands. ``copy``
    stays True, because RLlib keeps the observations. A runner has one core, so one thread steps.
    """
    keywords = {"vectorization_mode": "vector_entry_point", "threads": 1} | dict(settings)
    return SpreadSeeds(gym.make_vec(**keywords))


def log_score(*, episode: Any, metrics_logger: Any, **others: Any) -> None:
    """Add the mean score of the latest 100 episodes to RLlib's statistics."""
    metrics_logger.log_value("score", episode.get_infos(-1)["score"], window=100)


def make_config(
    runners: int = 2,
    worlds: int = 64,
    seed: int | None = 0,
    env_id: str = "arkanoid:ArkanoidLite-v0",
    **keywords: Any,
) -> PPOConfig:
    """Return the settings of a training.

    Args:
        runners: number of processes that play. With 0 this process plays, too.
        worlds: number of worlds per runner.
        seed: for worlds, weights and actions. With None it is different each time.
        env_id: includes the module to import, because each runner is a fresh process.
        **keywords: for the environment.
    """
    register_env("arkanoid", make_worlds)
    # Without a penalty for losing the ball, nothing is learnt in a short time.
    settings = {"id": env_id, "life_penalty": 0.2} | keywords
    return (
        PPOConfig()
        .environment("arkanoid", env_config=settings)
        .env_runners(
            num_env_runners=runners,
            num_envs_per_env_runner=worlds,
            gym_env_vectorize_mode="vector_entry_point",
            sample_timeout_s=600,  # the first step on a new machine compiles the kernels
        )
        .rl_module(
            model_config={
                "fcnet_hiddens": [64, 64],
                "fcnet_activation": "relu",
                "vf_share_layers": False,
            }
        )
        .training(
            train_batch_size_per_learner=8192,
            minibatch_size=1024,
            num_epochs=4,
            lr=2e-3,
            gamma=0.98,
            lambda_=0.9,
            clip_param=0.2,
            entropy_coeff=0.003,
            use_kl_loss=False,
            grad_clip=0.5,
        )
        .callbacks(on_episode_end=log_score)
        .debugging(seed=seed)
    )


def train(algorithm: Algorithm, decisions: int) -> None:
    """Train for this number of decisions in all worlds together; print one line per iteration."""
    played = 0
    while played < decisions:
        episodes = algorithm.train()["env_runners"]
        played = int(episodes["num_env_steps_sampled_lifetime"])
        if "score" in episodes:  # missing until the first episode has ended
            print(
                f"{played:9,} decisions: return {episodes['episode_return_mean']:6.2f},"
                f" {episodes['episode_len_mean']:5.0f} decisions, score {episodes['score']:6.0f}"
            )


def parse() -> argparse.Namespace:
    """Return the arguments of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--env", default="arkanoid:ArkanoidLite-v0", help="module:id")
    parser.add_argument("--runners", type=int, default=2, help="processes that play")
    parser.add_argument("--worlds", type=int, default=64, help="number per runner")
    parser.add_argument("--decisions", type=int, default=1_000_000, help="in all worlds together")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--address", help="of a running cluster, or auto; default: this machine")
    parser.add_argument("--save", type=Path, metavar="FOLDER", help="save the algorithm here")
    return parser.parse_args()


def main() -> None:
    """Train as the command line says."""
    arguments = parse()
    torch.set_num_threads(1)  # the networks are too small for more
    ray.init(**({"address": arguments.address} if arguments.address else ALONE))
    try:
        config = make_config(arguments.runners, arguments.worlds, arguments.seed, arguments.env)
        algorithm: PPO = config.build_algo()
        train(algorithm, arguments.decisions)
        if arguments.save:
            print("saved:", algorithm.save_to_path(arguments.save.resolve()))
        algorithm.stop()
    finally:
        ray.shutdown()


if __name__ == "__main__":
    main()
