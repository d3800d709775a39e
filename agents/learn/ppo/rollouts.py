"""What PPO collects between two updates, in whole arrays, and its minibatches."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.vec_env import VecEnv
from torch import Tensor

from .actions import Actions
from .observations import observations_for


@dataclass
class Minibatch:
    """Decisions [n] for one gradient step.

    Attributes:
        outputs: of the policy's last layer, [n, outputs], with gradients.
        values: with gradients.
        actions: as `Actions.draw` returned them.
        old_log_prob: of the policy that took the actions.
        advantages: not normalised.
        returns: what the values should become.
        old_values: before the update.
        decisions: step * worlds + world of each.
    """

    outputs: Tensor
    values: Tensor
    actions: Tensor
    old_log_prob: Tensor
    advantages: Tensor
    returns: Tensor
    old_values: Tensor
    decisions: Tensor


class Rollout:
    """Decisions of ``steps`` steps in each world. Its memory is used again for each rollout.

    Args:
        policy: who plays.
        actions: what its outputs mean.
        env: where.
        steps: decisions of each world.
        batch_size: of the minibatches.
    """

    def __init__(
        self, policy: ActorCriticPolicy, actions: Actions, env: VecEnv, steps: int, batch_size: int
    ) -> None:
        worlds, device = env.num_envs, policy.device
        self.key = (id(policy), id(env), steps, worlds, batch_size)
        self.steps, self.worlds = steps, worlds
        self._policy, self._space = policy, actions
        self._batch_size = batch_size
        self._observations = observations_for(policy, env, steps, batch_size)
        # The last layer is linear in every policy of stable-baselines3.
        outputs: int = policy.action_net.out_features  # type: ignore[assignment]
        self._outputs = torch.empty((steps, worlds, outputs), device=device)
        self.rewards = np.empty((steps, worlds), np.float32)
        self.dones = np.empty((steps, worlds), np.bool_)
        self._actions: list[Tensor] = []
        # Time and world of each truncated episode, and its last observation.
        self._cut: list[tuple[int, int, Any]] = []
        self.values = np.empty((steps + 1, worlds), np.float32)
        self.returns = np.empty((steps, worlds), np.float32)

    def begin(self) -> None:
        """Forget the last rollout, and draw the random numbers of this one."""
        # All random numbers are drawn by the processor: checkpoints keep its generator.
        self._noise = self._space.noise(self.steps, self.worlds).to(self._outputs.device)
        self._actions.clear()
        self._cut.clear()

    def act(self, step: int, observations: Any) -> Tensor:
        """Return the actions of a step."""
        outputs = self._outputs[step]
        outputs.copy_(self._observations.act(step, observations))
        actions = self._space.draw(outputs, self._noise[step])
        self._actions.append(actions)
        return actions

    def add(self, step: int, rewards: Any, dones: Any, ended: dict[int, dict[str, Any]]) -> None:
        """Keep what a step gave; ``ended`` has the infos of episodes that ended."""
        self.rewards[step] = rewards
        self.dones[step] = dones
        for world, info in ended.items():
            last = info.get("terminal_observation")
            if last is not None and info.get("TimeLimit.truncated", False):
                self._cut.append((step, world, last))

    def finish(self, last: Any, gamma: float, gae_lambda: float) -> None:
        """Compute all values, advantages and returns; ``last`` are the latest observations.

        Raises ValueError if the policy's outputs are not finite.
        """
        if not torch.isfinite(self._outputs).all():
            raise ValueError("found invalid values: the policy's outputs are not finite")
        values = self._observations.values(last)
        self.values[:] = values.cpu().numpy()
        self._add_values_of_cut_episodes(gamma)
        advantages = _advantages(self.rewards, self.dones, self.values, gamma, gae_lambda)
        np.add(advantages, self.values[:-1], out=self.returns)
        actions = torch.stack(self._actions)
        numbers = (
            self._space.judge(self._outputs, actions)[0],
            torch.from_numpy(advantages),
            torch.from_numpy(self.returns),
            values[:-1],
        )
        arranged = self._observations.arranged
        self._of_runs = torch.stack([arranged(each.to(actions.device)) for each in numbers])
        self._actions_of_runs = arranged(actions)
        count = self.steps * self.worlds
        self._decisions = arranged(torch.arange(count).view(self.steps, self.worlds))

    def _add_values_of_cut_episodes(self, gamma: float) -> None:
        """A truncated episode would have gone on: its last reward includes the value of that."""
        if not self._cut:
            return
        steps, worlds, last = zip(*self._cut, strict=True)
        seen = torch.as_tensor(np.stack(last), device=self._outputs.device)
        values = self._policy.predict_values(seen).flatten().cpu().numpy()
        self.rewards[list(steps), list(worlds)] += gamma * values

    def minibatches(self) -> Iterator[Minibatch]:
        """Yield all decisions once, in a new random order."""
        run = self._observations.run
        runs = self._batch_size // run
        drawn = torch.randperm(self._of_runs.shape[1])
        order = drawn.to(self._outputs.device)
        numbers = self._of_runs.index_select(1, order).flatten(1).split(runs * run, 1)
        actions = self._actions_of_runs.index_select(0, order).flatten(0, 1).split(runs * run)
        decisions = self._decisions[drawn].flatten().split(runs * run)
        networks = self._observations.evaluated(order, runs)
        for (outputs, values), chosen, four, indices in zip(
            networks, actions, numbers, decisions, strict=True
        ):
            log_prob, advantages, returns, old = four
            yield Minibatch(outputs, values, chosen, log_prob, advantages, returns, old, indices)


def _advantages(
    rewards: NDArray[np.float32],
    dones: NDArray[np.bool_],
    values: NDArray[np.float32],
    gamma: float,
    gae_lambda: float,
) -> NDArray[np.float32]:
    """Return generalised advantage estimates [steps, worlds]; ``values`` has a step more."""
    goes_on = (1.0 - dones).astype(np.float32)
    errors: Any = rewards + gamma * values[1:] * goes_on - values[:-1]
    weights = gamma * gae_lambda * goes_on
    latest = np.zeros(rewards.shape[1], np.float32)
    for step in range(len(rewards) - 1, -1, -1):
        latest = errors[step] + weights[step] * latest
        errors[step] = latest
    advantages: NDArray[np.float32] = errors
    return advantages
