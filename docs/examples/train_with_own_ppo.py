"""PPO in one file, in the manner of CleanRL, on Gymnasium's interface for vector environments.

Worlds restart in the step that ends their episode (`autoreset_mode="SameStep"`), so every step
belongs to an episode and none has to be masked. That step returns the first observation of the next
episode; the last observation of the old one is `infos["final_obs"]`. If an episode was cut and not
lost, its value stands for the rest of the game.
"""

import gymnasium as gym
import numpy as np
import torch
from gymnasium.wrappers.vector import RecordEpisodeStatistics
from torch import Tensor, nn
from torch.distributions import Categorical

WORLDS, STEPS, UPDATES = 128, 32, 8
EPOCHS, MINIBATCHES = 2, 4
DISCOUNT, SMOOTHING, CLIP = 0.99, 0.95, 0.2


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
def cut_values(agent: Agent, infos: dict, cut: np.ndarray) -> Tensor:
    """Return the values of the last observations of episodes that were cut, and 0 elsewhere."""
    values = torch.zeros(len(cut))
    if cut.any():
        values[cut] = agent(torch.from_numpy(np.stack(infos["final_obs"][cut])))[1]
    return values


@torch.no_grad()
def rollout(agent: Agent, env: gym.vector.VectorEnv, seen: Tensor) -> tuple[list[Tensor], Tensor]:
    """Play STEPS steps; return observations, actions, log-probabilities, advantages, returns."""
    kept: list[list[Tensor]] = []
    for _ in range(STEPS):
        policy, value = agent(seen)
        action = policy.sample()
        after, reward, terminated, truncated, infos = env.step(action.numpy())
        gain = torch.from_numpy(reward).float()
        gain += DISCOUNT * cut_values(agent, infos, truncated & ~terminated)
        goes_on = torch.from_numpy(~(terminated | truncated)).float()
        kept.append([seen, action, policy.log_prob(action), value, gain, goes_on])
        seen = torch.from_numpy(after)
    columns = zip(*kept, strict=True)
    seens, actions, logs, values, gains, going = (torch.stack(column) for column in columns)
    advantages, advantage, value = torch.zeros_like(gains), torch.zeros(WORLDS), agent(seen)[1]
    for step in reversed(range(STEPS)):
        error = gains[step] + DISCOUNT * value * going[step] - values[step]
        advantage = error + DISCOUNT * SMOOTHING * going[step] * advantage
        advantages[step], value = advantage, values[step]
    batch = [seens, actions, logs, advantages, advantages + values]
    return [each.flatten(0, 1) for each in batch], seen


def improve(agent: Agent, adam: torch.optim.Optimizer, batch: list[Tensor]) -> None:
    """Make the gradient steps of one update."""
    for _ in range(EPOCHS):
        for part in torch.randperm(WORLDS * STEPS).chunk(MINIBATCHES):
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


def main() -> None:
    """Train for a few seconds. With more UPDATES it learns to play."""
    torch.set_num_threads(1)  # the networks are too small for more
    torch.manual_seed(0)
    worlds = gym.make_vec(
        "arkanoid:ArkanoidLite-v0",
        WORLDS,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        lives=1,
    )
    env = RecordEpisodeStatistics(worlds)
    agent = Agent(env.single_observation_space.shape[0], env.single_action_space.n)
    adam = torch.optim.Adam(agent.parameters(), lr=1e-3, eps=1e-5)
    seen = torch.from_numpy(env.reset(seed=0)[0])
    for update in range(UPDATES):
        batch, seen = rollout(agent, env, seen)
        improve(agent, adam, batch)
        steps = (update + 1) * WORLDS * STEPS
        print(f"{steps:6} steps: reward {np.mean(env.return_queue):.3f} of the latest 100 episodes")
    env.close()


if __name__ == "__main__":
    main()
