"""imitation: behavioural cloning and GAIL from recorded games.

Version 1.0 wants Gymnasium 0.29, with which the single environment works.
"""

import gymnasium as gym
import numpy as np
from arkanoid.envs import Replay, replay_transitions
from imitation.algorithms import bc
from imitation.algorithms.adversarial.gail import GAIL
from imitation.data.types import Trajectory
from imitation.rewards.reward_nets import BasicRewardNet
from imitation.util.util import make_vec_env
from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy

GAME = "arkanoid:ArkanoidLite-v0"


def demonstrate(games: int) -> list[Replay]:
    """Return recorded games of someone who follows the ball; `arkanoid play` records yours."""
    env = gym.make(GAME, lives=1, max_decisions=300).unwrapped
    recorder = env.record()
    paddle, ball = (env.layout[name].start for name in ("paddle", "ball_x"))
    replays = []
    for seed in range(games):
        seen, _ = env.reset(seed=seed)
        over = False
        while not over:
            aside = seen[ball] - seen[paddle]
            seen, _, terminated, truncated, _ = env.step(
                0 if abs(aside) < 0.05 else 1 + (aside > 0)
            )
            over = terminated or truncated
        replays.append(recorder.replay())
    return replays


def trajectory(replay: Replay) -> Trajectory:
    """Return a recorded game as `imitation` holds it."""
    steps = list(replay_transitions(replay))
    seen = [steps[0].observation, *(step.next_observation for step in steps)]
    return Trajectory(
        obs=np.stack(seen),
        acts=np.array([step.action for step in steps]),
        infos=np.array([step.info for step in steps]),
        terminal=steps[-1].terminated,
    )


def main() -> None:
    """Clone who follows the ball, and then learn to be mistaken for them."""
    random = np.random.default_rng(0)
    shown = [trajectory(replay) for replay in demonstrate(8)]
    print(f"shown: {len(shown)} games, {sum(len(game) for game in shown)} decisions")

    env = gym.make(GAME, lives=1, max_decisions=300)
    clone = bc.BC(
        observation_space=env.observation_space,
        action_space=env.action_space,
        demonstrations=shown,
        rng=random,
    )
    before, _ = evaluate_policy(clone.policy, env, 10, warn=False)
    clone.train(n_epochs=5, progress_bar=False, log_interval=10_000)
    after, _ = evaluate_policy(clone.policy, env, 10, warn=False)
    print(f"behavioural cloning: reward {before:.3f}, then {after:.3f}")

    worlds = make_vec_env(GAME, rng=random, n_envs=4, env_make_kwargs={"max_decisions": 300})
    learner = PPO("MlpPolicy", worlds, n_steps=128, batch_size=64, seed=0)
    discriminator = BasicRewardNet(worlds.observation_space, worlds.action_space)
    gail = GAIL(
        demonstrations=shown,
        demo_batch_size=128,
        gen_replay_buffer_capacity=512,
        venv=worlds,
        gen_algo=learner,
        reward_net=discriminator,
        allow_variable_horizon=True,
    )
    gail.train(1024)
    print(f"GAIL: {learner.num_timesteps} steps")


if __name__ == "__main__":
    main()
