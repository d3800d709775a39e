"""Tianshou 2: PPO on its own vector of environments, with a collector and a few short epochs.

Tianshou resets finished episodes itself, so it takes single environments and not Gymnasium's vector
environments.
"""

import gymnasium as gym
import torch
from tianshou.algorithm import PPO
from tianshou.algorithm.modelfree.reinforce import DiscreteActorPolicy
from tianshou.algorithm.optim import AdamOptimizerFactory
from tianshou.data import Collector, CollectStats, VectorReplayBuffer
from tianshou.env import DummyVectorEnv
from tianshou.trainer import OnPolicyTrainerParams
from tianshou.utils.net.common import Net
from tianshou.utils.net.discrete import DiscreteActor, DiscreteCritic


def game() -> gym.Env:
    """Return a game with one life."""
    return gym.make("arkanoid:ArkanoidLite-v0", levels="ripple", lives=1)


def agent(env: gym.Env) -> PPO:
    """Return PPO with one small network for the policy and one for the values."""
    shape, actions = env.observation_space.shape, env.action_space.n
    seen = [Net(state_shape=shape, hidden_sizes=[64, 64]) for _ in range(2)]
    actor = DiscreteActor(preprocess_net=seen[0], action_shape=actions, softmax_output=False)
    policy = DiscreteActorPolicy(actor=actor, action_space=env.action_space)
    critic = DiscreteCritic(preprocess_net=seen[1])
    return PPO(policy=policy, critic=critic, optim=AdamOptimizerFactory(lr=3e-4))


def main() -> None:
    """Collect some steps, then train."""
    torch.manual_seed(0)
    ppo = agent(game())
    worlds = DummyVectorEnv([game] * 8)
    worlds.seed(0)
    training = Collector[CollectStats](ppo, worlds, VectorReplayBuffer(20_000, 8))
    collected = training.collect(n_step=1024, reset_before_collect=True)
    print(f"collected: {collected.n_collected_steps} steps")
    ppo.run_training(
        OnPolicyTrainerParams(
            training_collector=training,
            test_collector=Collector[CollectStats](ppo, DummyVectorEnv([game] * 4)),
            max_epochs=3,
            epoch_num_steps=4096,
            collection_step_num_env_steps=1024,
            test_step_num_episodes=8,
            update_step_num_repetitions=2,
            batch_size=256,
            verbose=False,
            show_progress=False,
        )
    )
    print(f"trained: {training.collect_step} steps, {training.collect_episode} episodes")


if __name__ == "__main__":
    main()
