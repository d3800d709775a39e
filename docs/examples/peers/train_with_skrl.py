"""skrl: PPO on the native batch, with continuous actions and with discrete ones.

Its Gaussian policies act beyond the bounds of the action space, and the environment counts that as
at the bound. With `autoreset_mode="SameStep"` every step that skrl keeps is one of the game.
"""

import gymnasium as gym
from skrl.agents.torch.ppo import PPO, PPO_CFG
from skrl.envs.wrappers.torch import Wrapper, wrap_env
from skrl.memories.torch import RandomMemory
from skrl.trainers.torch import SequentialTrainer
from skrl.utils import set_seed
from skrl.utils.model_instantiators.torch import (
    categorical_model,
    deterministic_model,
    gaussian_model,
)

WORLDS, ROLLOUTS = 32, 32
NETWORK = [{"name": "net", "input": "OBSERVATIONS", "layers": [64, 64], "activations": "elu"}]


def agent(env: Wrapper) -> PPO:
    """Return PPO with small networks for the policy and for the values."""
    spaces = {
        "observation_space": env.observation_space,
        "action_space": env.action_space,
        "device": env.device,
    }
    discrete = isinstance(env.action_space, gym.spaces.Discrete)
    policy = categorical_model if discrete else gaussian_model
    models = {
        "policy": policy(**spaces, network=NETWORK, output="ACTIONS"),
        "value": deterministic_model(**spaces, network=NETWORK, output="ONE"),
    }
    settings = PPO_CFG(rollouts=ROLLOUTS, learning_epochs=2, mini_batches=4)
    settings.experiment.write_interval = settings.experiment.checkpoint_interval = 0
    memory = RandomMemory(memory_size=ROLLOUTS, num_envs=env.num_envs, device=env.device)
    return PPO(models=models, memory=memory, **spaces, cfg=settings)


def main() -> None:
    """Train a little on either kind of actions."""
    set_seed(0)
    for name in ("ArkanoidContinuous-v0", "ArkanoidLite-v0"):
        worlds = gym.make_vec(
            f"arkanoid:{name}",
            WORLDS,
            vectorization_mode="vector_entry_point",
            autoreset_mode="SameStep",
        )
        env = wrap_env(worlds)
        settings = {"timesteps": 4 * ROLLOUTS, "headless": True, "disable_progressbar": True}
        SequentialTrainer(env=env, agents=agent(env), cfg=settings).train()
        print(f"{name}: {4 * ROLLOUTS * WORLDS} steps in {env.action_space}")


if __name__ == "__main__":
    main()
