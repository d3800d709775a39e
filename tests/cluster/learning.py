"""A training on several processes of this machine, and a check that it learns."""

import time

import gymnasium as gym
from arkanoid.agents.measure.baselines import RandomPolicy
from arkanoid.agents.measure.episodes import play_episodes
from arkanoid.agents.measure.intervals import bootstrap_interval
from episodes import likeliest
from ray.rllib.core.rl_module.rl_module import RLModule
from rllib_ppo import make_config, train

RUNNERS = 2
GAMES = 64
SEED = 1_000_000


def train_locally(decisions: int) -> tuple[RLModule, str]:
    """Train with several environment runners; return the agent and a summary."""
    algorithm = make_config(RUNNERS, seed=0).build_algo()
    start = time.perf_counter()
    train(algorithm, decisions)
    seconds = time.perf_counter() - start
    module = algorithm.get_module()
    algorithm.stop()
    return module, f"{decisions:,} decisions by {RUNNERS} runners in {seconds:.0f} s"


def check_learning(module: RLModule) -> str:
    """Check that the agent beats random play: the intervals of their means do not overlap."""
    measured = {}
    for name in ("agent", "random"):
        worlds = gym.make_vec("arkanoid:ArkanoidLite-v0", num_envs=GAMES, autoreset_mode="SameStep")
        policy = (
            likeliest(module, GAMES)
            if name == "agent"
            else RandomPolicy(worlds.single_action_space, GAMES, SEED)
        )
        played = play_episodes(worlds, policy, range(SEED, SEED + GAMES))
        worlds.close()
        measured[name] = {
            key: bootstrap_interval(played[key].ravel()) for key in ("hits", "score", "return")
        }
    agent, random = measured["agent"], measured["random"]
    assert agent["hits"].low > random["hits"].high
    assert agent["return"].low > random["return"].high
    return "\n".join(
        f"{name:7} brick hits {measured[name]['hits']}, score {measured[name]['score']}"
        for name in measured
    )
