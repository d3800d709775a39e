"""TorchRL on a graphics card: games, collector and PPO are on it, and no observation leaves it.

Without a card the same program runs on the processor, slowly.

Run: python torchrl_on_gpu.py [games] [updates]
"""

import sys
from typing import Any

import gymnasium as gym
import torch
from tensordict import TensorDict, TensorDictBase
from tensordict.nn import TensorDictModule
from torchrl.collectors import Collector
from torchrl.data import Binary, Categorical, Composite, Unbounded
from torchrl.envs import EnvBase, check_env_specs
from torchrl.modules import MLP, ProbabilisticActor, ValueOperator
from torchrl.objectives import ClipPPOLoss
from torchrl.objectives.value import GAE

GAME = "arkanoid:ArkanoidLite-v0"
STEPS, EPOCHS, MINIBATCHES = 32, 2, 4
DEVICE = torch.device("cuda" if torch.cuda.is_available() else "cpu")


class Games(EnvBase):
    """Many games as one TorchRL environment; it hands on the tensors of the games themselves."""

    def __init__(self, count: int, device: torch.device, **keywords: Any) -> None:
        super().__init__(device=device, batch_size=[count])
        self.worlds: Any = gym.make_vec(
            GAME,
            count,
            vectorization_mode="vector_entry_point",
            device=device,
            autoreset_mode="SameStep",
            **keywords,
        )
        size = self.worlds.single_observation_space.shape[0]
        seen, flag = Unbounded((count, size), device), Binary(1, (count, 1), device, torch.bool)
        self.observation_spec = Composite(observation=seen, shape=(count,))
        self.action_spec = Categorical(self.worlds.single_action_space.n, (count,), device)
        self.reward_spec = Unbounded((count, 1), device)
        names = ("done", "terminated", "truncated")
        self.done_spec = Composite({name: flag.clone() for name in names}, shape=(count,))
        self._seed: int | None = None

    def _reset(self, tensordict: TensorDictBase | None, **others: Any) -> TensorDictBase:
        # A collector asks for new episodes of games that have ended. They have begun already, in
        # the step that ended the old ones: to begin them here would wait for the card.
        if tensordict is None or tensordict.get("_reset", None) is None:
            self.worlds.reset(seed=self._seed)
            self._seed = None
        return TensorDict({"observation": self.worlds.unwrapped.observe()}, self.batch_size)

    def _step(self, tensordict: TensorDictBase) -> TensorDictBase:
        seen, rewards, terminated, truncated, infos = self.worlds.step(tensordict["action"])
        done = (terminated | truncated).unsqueeze(-1)
        return TensorDict(
            {
                "observation": torch.where(done, infos["final_obs"], seen),
                "reward": rewards.float().unsqueeze(-1),
                "done": done,
                "terminated": terminated.unsqueeze(-1),
                "truncated": truncated.unsqueeze(-1),
            },
            self.batch_size,
        )

    def _set_seed(self, seed: int | None) -> None:
        self._seed = seed


def main(games: int, updates: int) -> None:
    """Check the environment, and train. With more games and updates it learns to play."""
    torch.manual_seed(0)
    check_env_specs(Games(4, DEVICE))
    env = Games(games, DEVICE, lives=1)
    env.set_seed(0)
    hidden = {"num_cells": [64, 64], "activation_class": torch.nn.Tanh, "device": DEVICE}
    hidden["in_features"] = env.observation_spec["observation"].shape[-1]
    network = MLP(out_features=env.action_spec.n, **hidden)
    actor = ProbabilisticActor(
        TensorDictModule(network, ["observation"], ["logits"]),
        in_keys=["logits"],
        distribution_class=torch.distributions.Categorical,
        return_log_prob=True,
    )
    critic = ValueOperator(MLP(out_features=1, **hidden))
    batch = games * STEPS
    collector = Collector(
        env,
        actor,
        frames_per_batch=batch,
        total_frames=updates * batch,
        auto_register_policy_transforms=False,
    )
    advantage = GAE(gamma=0.99, lmbda=0.95, value_network=critic)
    loss = ClipPPOLoss(actor, critic, entropy_coeff=0.01, normalize_advantage=True)
    adam = torch.optim.Adam(loss.parameters(), lr=1e-3, eps=1e-5)
    for number, data in enumerate(collector):
        if number == 0:  # within an episode, each observation is what the step before led to
            seen, after, done = (
                data["observation"],
                data["next", "observation"],
                data["next", "done"],
            )
            same = (after[:, :-1] == seen[:, 1:]).all(-1)
            assert torch.equal(same, ~done[:, :-1, 0])
        advantage(data)
        flat = data.reshape(-1)
        for _ in range(EPOCHS):
            for part in torch.randperm(batch, device=DEVICE).chunk(MINIBATCHES):
                losses = loss(flat[part])
                sum(value for key, value in losses.items() if key.startswith("loss_")).backward()
                torch.nn.utils.clip_grad_norm_(loss.parameters(), 0.5)
                adam.step()
                adam.zero_grad()
        bricks = env.worlds.unwrapped.state["bricks_broken"].mean()
        print(f"{(number + 1) * batch:9} steps: {bricks:.2f} bricks in the present games")
    collector.shutdown()


if __name__ == "__main__":
    many = 4096 if DEVICE.type == "cuda" else 32
    main(*(int(word) for word in sys.argv[1:] or (many, 3)))
