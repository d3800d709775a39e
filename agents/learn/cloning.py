"""Behaviour cloning: a network learns from recorded games, before PPO begins.

The policy learns to take the recorded actions: their negative log-likelihood is the loss. The value
function learns the discounted returns of the recorded games; its loss has the weight that it has in
PPO.
"""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import PPO

from ..experiment.datasets import Episode, read_dataset
from ..experiment.errors import SettingsError
from ..experiment.settings import Experiment

# The part of the episodes that is not learned, but tells when to stop.
_HELD_OUT = 0.1
# Decisions whose loss is computed at once, if nothing is learned.
_CHUNK = 4096


@dataclass(frozen=True)
class Demonstrations:
    """The decisions of recorded games, one after the other.

    Attributes:
        observations: before each decision, [n, ...].
        actions: [n, ...].
        returns: discounted sum of the rewards from each decision to its game's end, float32 [n].
        certain: the part of the return that does not depend on what came after a game that was
            cut, float32 [n]: 1 where the game was lost in the end.
        lengths: decisions of each game.
    """

    observations: NDArray[Any]
    actions: NDArray[Any]
    returns: NDArray[np.float32]
    certain: NDArray[np.float32]
    lengths: tuple[int, ...]

    @classmethod
    def of(cls, episodes: list[Episode], gamma: float) -> "Demonstrations":
        """Return the decisions of episodes; ``gamma`` discounts each later reward once more."""
        return cls(
            observations=np.concatenate([one.observations[:-1] for one in episodes]),
            actions=np.concatenate([one.actions for one in episodes]),
            returns=np.concatenate([discounted(one.rewards, gamma) for one in episodes]),
            certain=np.concatenate([_certain(one, gamma) for one in episodes]),
            lengths=tuple(len(one.actions) for one in episodes),
        )

    def digest(self) -> str:
        """Return the SHA-256, in hexadecimal, of all that is learned."""
        digest = hashlib.sha256()
        for array in (self.observations, self.actions, self.returns, self.certain):
            digest.update(f"{array.dtype.str} {array.shape}\n".encode())
            digest.update(np.ascontiguousarray(array).data)
        return digest.hexdigest()


@dataclass(frozen=True)
class Cloned:
    """How well a network imitates episodes that it did not learn from.

    Attributes:
        loss: mean negative log-likelihood of their actions.
        accuracy: the part of their decisions in which it takes the same action; None if actions are
            continuous.
    """

    loss: float
    accuracy: float | None


def read_demonstrations(experiment: Experiment, model: PPO) -> Demonstrations:
    """Return the data set that the experiment imitates.

    Raises `SettingsError` if it is missing or damaged, does not fit the model, or has one episode
    only.
    """
    name = experiment.imitation.dataset
    episodes = read_dataset(name, model.observation_space, model.action_space)
    if len(episodes) < 2:
        raise SettingsError(f"{name}: it needs two episodes: one of them tells how good a clone is")
    return Demonstrations.of(episodes, experiment.ppo.gamma)


def clone(model: PPO, data: Demonstrations, experiment: Experiment) -> Cloned:
    """Train a model's network on demonstrations; keep the weights of the best epoch.

    Best is the lowest loss on episodes that are not learned from, a tenth of all. All random
    numbers come from a generator of their own, seeded by the experiment's seed.
    """
    settings = experiment.imitation
    random = np.random.default_rng(experiment.seed)
    learned, held_out = _split(data.lengths, random)
    policy = model.policy
    # What it never sees, such as another player's doubt, cannot tell how much noise PPO needs.
    weights = [value for name, value in policy.named_parameters() if name != "log_std"]
    optimizer = torch.optim.Adam(weights, lr=settings.learning_rate)
    best, kept = None, {}
    for epoch in range(1, settings.epochs + 1):
        policy.set_training_mode(True)
        for batch in _batches(random.permutation(learned), settings.batch_size):
            loss, value_loss, _ = _losses(model, data, batch)
            optimizer.zero_grad()
            (loss.mean() + experiment.ppo.vf_coef * value_loss.mean()).backward()
            torch.nn.utils.clip_grad_norm_(weights, experiment.ppo.max_grad_norm)
            optimizer.step()
        result = _measure(model, data, held_out)
        print(f"cloning  epoch {epoch} of {settings.epochs}: {_in_words(result)}")
        if best is None or result.loss < best.loss:
            best = result
            kept = {name: value.clone() for name, value in policy.state_dict().items()}
    optimizer.zero_grad()
    assert best is not None
    policy.load_state_dict(kept)
    return best


def discounted(rewards: NDArray[np.float64], gamma: float) -> NDArray[np.float32]:
    """Return, for each reward [n], the discounted sum of it and all that follow."""
    returns = np.empty(len(rewards), np.float32)
    total = 0.0
    for index in range(len(rewards) - 1, -1, -1):
        total = rewards[index] + gamma * total
        returns[index] = total
    return returns


def _certain(episode: Episode, gamma: float) -> NDArray[np.float32]:
    count = len(episode.actions)
    if episode.terminated:
        return np.ones(count, np.float32)
    certain: NDArray[np.float32] = (1.0 - gamma ** np.arange(count, 0, -1)).astype(np.float32)
    return certain


def _split(
    lengths: tuple[int, ...], random: np.random.Generator
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the decisions of the episodes to learn, and those of the others."""
    episodes = random.permutation(len(lengths))
    count = max(1, round(_HELD_OUT * len(lengths)))
    owner = np.repeat(np.arange(len(lengths)), lengths)
    held_out = np.isin(owner, episodes[:count])
    return np.flatnonzero(~held_out), np.flatnonzero(held_out)


def _batches(indices: NDArray[np.int64], size: int) -> Iterator[NDArray[np.int64]]:
    for first in range(0, len(indices), size):
        # In order, so that memory is read from its beginning to its end.
        yield np.sort(indices[first : first + size])


def _losses(
    model: PPO, data: Demonstrations, batch: NDArray[np.int64]
) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """Return both losses of each decision, and the observations."""
    policy, device = model.policy, model.device
    observations: Any = policy.obs_to_tensor(data.observations[batch])[0]
    actions = torch.as_tensor(data.actions[batch], device=device)
    values, likelihood, _ = policy.evaluate_actions(observations, actions)
    returns = torch.as_tensor(data.returns[batch], device=device)
    certain = torch.as_tensor(data.certain[batch], device=device)
    return -likelihood, certain * (values.flatten() - returns) ** 2, observations


@torch.no_grad()
def _measure(model: PPO, data: Demonstrations, indices: NDArray[np.int64]) -> Cloned:
    """Return how well the model imitates decisions."""
    model.policy.set_training_mode(False)
    loss, same = 0.0, 0
    for batch in _batches(indices, _CHUNK):
        losses, _, observations = _losses(model, data, batch)
        loss += float(losses.double().sum())
        actions = model.policy.get_distribution(observations).mode().cpu().numpy()
        same += int((actions == data.actions[batch]).sum())
    discrete = data.actions.ndim == 1
    return Cloned(loss / len(indices), same / len(indices) if discrete else None)


def _in_words(result: Cloned) -> str:
    words = f"loss {result.loss:.3f}"
    return words if result.accuracy is None else f"{words}, same action {result.accuracy:.3f}"
