"""PPO in one file, in the manner of CleanRL, that never leaves the graphics card.

With ``device=...`` the environment takes and gives tensors of torch there: nothing is copied, and
nothing waits. Without a card the same program runs on the processor, slowly.

Run: python docs/examples/train_on_gpu.py [worlds] [updates]
"""

import sys

import gymnasium as gym
import torch
from torch import Tensor, nn
from torch.distributions import Categorical

STEPS, EPOCHS, MINIBATCHES = 32, 2, 4
DISCOUNT, SMOOTHING, CLIP = 0.99, 0.95, 0.2
DEVICE = "cuda" if torch.cuda.is_available() else "cpu"


class Agent(nn.Module):
    """A policy and a value: two networks with the same hidden layers."""

    def __init__(self, seen: int, actions: int) -> None:
        super().__init__()
        self.actor, self.critic = (
            nn.Sequential(nn.Linear(seen, 64), nn.Tanh(), nn.Linear(64, 64), nn.Tanh(), head)
            for head in (nn.Linear(64, actions), nn.Linear(64, 1))
        )

    def forward(self, seen: Tensor) -> tuple[Categorical, Tensor]:
        """Return the policy and the value of observations [..., n]."""
        return Categorical(logits=self.actor(seen)), self.critic(seen).squeeze(-1)


@torch.no_grad()
def rollout(agent: Agent, env: gym.vector.VectorEnv, seen: Tensor) -> tuple[list[Tensor], Tensor]:
    """Play STEPS steps; return observations, actions, log-probabilities, advantages, returns."""
    kept: list[list[Tensor]] = []
    for _ in range(STEPS):
        policy, value = agent(seen)
        action = policy.sample()
        after, reward, terminated, truncated, infos = env.step(action)
        # An episode that was cut goes on in thought: its value stands for the rest of the game.
        # Rows of other worlds have no meaning, and 0 takes them out, without waiting for the card.
        cut = truncated & ~terminated
        gain = reward.float() + DISCOUNT * torch.where(cut, agent(infos["final_obs"])[1], 0.0)
        goes_on = (~(terminated | truncated)).float()
        kept.append([seen, action, policy.log_prob(action), value, gain, goes_on])
        seen = after
    seens, actions, logs, values, gains, going = (
        torch.stack(column) for column in zip(*kept, strict=True)
    )
    advantages, value = torch.zeros_like(gains), agent(seen)[1]
    advantage = torch.zeros_like(value)
    for step in reversed(range(STEPS)):
        error = gains[step] + DISCOUNT * value * going[step] - values[step]
        advantage = error + DISCOUNT * SMOOTHING * going[step] * advantage
        advantages[step], value = advantage, values[step]
    batch = [seens, actions, logs, advantages, advantages + values]
    return [each.flatten(0, 1) for each in batch], seen


def improve(agent: Agent, adam: torch.optim.Optimizer, batch: list[Tensor]) -> None:
    """Make the gradient steps of one update."""
    for _ in range(EPOCHS):
        for part in torch.randperm(len(batch[0]), device=DEVICE).chunk(MINIBATCHES):
            seen, action, log, advantage, goal = (each[part] for each in batch)
            policy, value = agent(seen)
            ratio = (policy.log_prob(action) - log).exp()
            advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
            gain = torch.min(ratio * advantage, ratio.clamp(1 - CLIP, 1 + CLIP) * advantage)
            loss = 0.5 * (value - goal).square() - gain - 0.01 * policy.entropy()
            adam.zero_grad()
            loss.mean().backward()
            nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
            adam.step()


def main(worlds: int, updates: int) -> None:
    """Train. With more worlds and updates it learns to play."""
    torch.manual_seed(0)
    env = gym.make_vec(
        "arkanoid:ArkanoidLite-v0",
        worlds,
        vectorization_mode="vector_entry_point",
        device=DEVICE,
        autoreset_mode="SameStep",
        lives=1,
    )
    agent = Agent(env.single_observation_space.shape[0], env.single_action_space.n).to(DEVICE)
    adam = torch.optim.Adam(agent.parameters(), lr=1e-3, eps=1e-5)
    seen, _ = env.reset(seed=0)
    for update in range(updates):
        batch, seen = rollout(agent, env, seen)
        improve(agent, adam, batch)
        bricks = env.unwrapped.state["bricks_broken"].mean()
        print(f"{(update + 1) * worlds * STEPS:9} steps: {bricks:.2f} bricks in the present games")
    env.close()


if __name__ == "__main__":
    many = 4096 if DEVICE == "cuda" else 64
    main(*(int(word) for word in sys.argv[1:] or (many, 5)))
