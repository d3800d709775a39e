"""d3rlpy: offline learning from recorded games, and what the result plays.

Version 2.8 wants Gymnasium 1.0, with which the single environment works.
"""

import logging

import d3rlpy
import gymnasium as gym
import numpy as np
import structlog
from arkanoid.envs import Replay, replay_transitions

structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.WARNING))
GAME = "arkanoid:ArkanoidLite-v0"


def recorded(games: int) -> list[Replay]:
    """Return recorded games of random play; `arkanoid play` writes such files of games by hand."""
    env = gym.make(GAME, lives=1).unwrapped
    recorder = env.record()
    env.action_space.seed(0)
    replays = []
    for seed in range(games):
        env.reset(seed=seed)
        while not env.step(env.action_space.sample())[2]:
            pass
        replays.append(recorder.replay())
    return replays


def main() -> None:
    """Make a data set of replays, learn from it, and play."""
    steps = [step for replay in recorded(20) for step in replay_transitions(replay)]
    dataset = d3rlpy.dataset.MDPDataset(
        observations=np.stack([step.observation for step in steps]),
        actions=np.array([step.action for step in steps]),
        rewards=np.array([step.reward for step in steps], np.float32),
        terminals=np.array([step.terminated for step in steps], np.float32),
        timeouts=np.array([step.truncated for step in steps], np.float32),
        action_space=d3rlpy.ActionSpace.DISCRETE,
        action_size=int(gym.make(GAME).action_space.n),
    )
    print(f"data: {dataset.size()} games, {dataset.transition_count} transitions")
    learner = d3rlpy.algos.DiscreteCQLConfig(batch_size=64).create(device="cpu")
    evaluator = d3rlpy.metrics.EnvironmentEvaluator(gym.make(GAME, max_decisions=500), n_trials=2)
    learner.fit(
        dataset,
        n_steps=400,
        n_steps_per_epoch=200,
        evaluators={"environment": evaluator},
        logger_adapter=d3rlpy.logging.NoopAdapterFactory(),
        show_progress=False,
    )
    print(f"learnt: reward {evaluator(learner, dataset):.3f} a game")


if __name__ == "__main__":
    main()
