"""What a policy's output means: probabilities of actions, their logarithms and entropies.

The same numbers as stable-baselines3's distributions, without an object for each step.
"""

import math
from typing import Protocol

import torch
from gymnasium import spaces
from stable_baselines3.common.policies import ActorCriticPolicy
from torch import Tensor

_HALF_LOG = 0.5 * math.log(2 * math.pi)


class Actions(Protocol):
    """A space's actions, drawn from the outputs [n, outputs] of a policy's last layer."""

    def noise(self, *shape: int) -> Tensor:
        """Return what decides so many draws, [*shape, outputs], from torch's random numbers."""
        ...

    def renew(self, noise: Tensor, generator: torch.Generator) -> None:
        """Draw noise anew, in place, with a generator of its device."""
        ...

    def draw(self, outputs: Tensor, noise: Tensor) -> Tensor:
        """Return one action per row."""
        ...

    def judge(self, outputs: Tensor, actions: Tensor) -> tuple[Tensor, Tensor]:
        """Return the logarithms of the actions' probabilities [n], and the mean entropy."""
        ...


class Choices:
    """Actions of a `Discrete` space; outputs are logits.

    A draw is the largest of the logits minus the logarithms of exponential numbers (the Gumbel
    trick): one maximum, and no probabilities are needed while playing.
    """

    def __init__(self, policy: ActorCriticPolicy) -> None:
        space = policy.action_space
        assert isinstance(space, spaces.Discrete)
        self._count = int(space.n)

    def noise(self, *shape: int) -> Tensor:
        """Return what decides so many draws."""
        return torch.empty(*shape, self._count).exponential_().log_()

    def renew(self, noise: Tensor, generator: torch.Generator) -> None:
        """Draw noise anew, in place."""
        noise.exponential_(generator=generator).log_()

    def draw(self, outputs: Tensor, noise: Tensor) -> Tensor:
        """Return one action per row."""
        return (outputs - noise).argmax(-1)

    def judge(self, outputs: Tensor, actions: Tensor) -> tuple[Tensor, Tensor]:
        """Return the logarithms of the actions' probabilities, and the mean entropy."""
        # Actions first: over few, adjacent numbers log_softmax is 15 times slower.
        logs = torch.log_softmax(outputs.movedim(-1, 0), 0)
        chosen = logs.gather(0, actions.unsqueeze(0)).squeeze(0)
        return chosen, -(logs.exp() * logs).sum() / chosen.numel()


class Reals:
    """Actions of a `Box` space; outputs are means of Gaussians, whose deviations are learnt."""

    def __init__(self, policy: ActorCriticPolicy) -> None:
        self._policy = policy

    def noise(self, *shape: int) -> Tensor:
        """Return what decides so many draws."""
        return torch.randn(*shape, len(self._policy.log_std))

    def renew(self, noise: Tensor, generator: torch.Generator) -> None:
        """Draw noise anew, in place."""
        noise.normal_(generator=generator)

    def draw(self, outputs: Tensor, noise: Tensor) -> Tensor:
        """Return one action per row."""
        return outputs + self._policy.log_std.exp() * noise

    def judge(self, outputs: Tensor, actions: Tensor) -> tuple[Tensor, Tensor]:
        """Return the logarithms of the actions' densities, and the mean entropy."""
        logs = self._policy.log_std
        squares = ((actions - outputs) / logs.exp()).square()
        log_prob = (-0.5 * squares - logs - _HALF_LOG).sum(-1)
        return log_prob, (0.5 + _HALF_LOG + logs).sum()


def actions_of(policy: ActorCriticPolicy) -> Actions | None:
    """Return the actions of a policy, or None if its space has none of these forms."""
    if isinstance(policy.action_space, spaces.Discrete):
        return Choices(policy)
    if isinstance(policy.action_space, spaces.Box) and not policy.use_sde:
        return Reals(policy)
    return None
