"""Noticing in training that a policy has collapsed: it hardly looks at what it sees any more.

Three signs, each of which no healthy policy shows:

- Nearly all actions of all worlds are the same.
- The policy is almost certain of its actions, and its episodes return no more than doing nothing or
  playing at random. (Good policies become certain, too, and new ones are poor but uncertain.)
- On a level of the validation it takes nearly always the same action, is almost certain of it, and
  never clears the level. Elsewhere such a policy can be good.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import torch
from gymnasium.spaces import Discrete
from numpy.typing import NDArray
from stable_baselines3.common.callbacks import BaseCallback

from ..experiment.seeds import Purpose, spread_seed, spread_seeds
from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from ..measure.baselines import NoOp, RandomPolicy
from ..measure.episodes import play_episodes
from ..measure.policy import Policy
from .callbacks import recent_mean
from .playing import network_input

ALWAYS = 0.99  # as often, or as probable, counts as always
CERTAIN = 0.05  # an entropy below this part of the largest one counts as certain
PATIENCE = 20_000  # decisions in a row that show a collapse before it is said
_GAMES = 64  # that doing nothing and playing at random are measured with
_NAMED = 6  # levels that a warning names
_LOOK_EVERY = 8  # decisions between two looks at the probabilities in a validation
_ADVICE = "start a new run with a larger 'ppo.ent_coef' or a smaller 'ppo.learning_rate'"

Warn = Callable[[str], None]


class CollapseWatch(BaseCallback):
    """Warns once when rollouts show that the policy has collapsed.

    It draws no random number that the training would draw. Actions must be discrete; velocities
    are not watched.

    Args:
        experiment: its game is played to measure doing nothing and playing at random.
        state: this callback's, empty or from a checkpoint; it is changed in place.
        warn: gets the warning.
    """

    def __init__(self, experiment: Experiment, state: dict[str, Any], warn: Warn) -> None:
        super().__init__()
        self._experiment = experiment
        self._state = state
        self._warn = warn
        self._entropy: float | None = None
        self._taken = np.zeros(0)
        self._floor: float | None = None
        state.setdefault("collapsed", 0)

    def _on_rollout_start(self) -> None:
        space = self.training_env.action_space
        self._taken = np.zeros(int(space.n) if isinstance(space, Discrete) else 0, np.int64)
        # Of the latest update. It is still there, because it is written after the next rollout.
        logged = self.logger.name_to_value.get("train/entropy_loss")
        self._entropy = None if logged is None else -float(logged)

    def _on_step(self) -> bool:
        if self._taken.size:
            actions = torch.as_tensor(self.locals["actions"]).cpu().numpy().ravel()
            self._taken += np.bincount(actions.astype(np.int64), minlength=self._taken.size)
        return True

    def _on_rollout_end(self) -> None:
        reason = self._sign() if self._taken.size else None
        if reason is None:
            self._state["collapsed"] = 0
            return
        before = self._state["collapsed"]
        self._state["collapsed"] = before + int(self._taken.sum())
        if before < PATIENCE <= self._state["collapsed"]:
            step = self.model.num_timesteps
            self._warn(f"the policy has collapsed at {step:,} decisions: {reason}; {_ADVICE}")

    def _sign(self) -> str | None:
        """Return how the latest rollout shows a collapse, or None."""
        share = self._taken.max() / self._taken.sum()
        if share >= ALWAYS:
            return f"{100 * share:.1f} % of its actions are the same"
        if self._entropy is None or self._entropy > CERTAIN * math.log(self._taken.size):
            return None
        mean = recent_mean(self.model, "r")
        if mean is None:
            return None
        if self._floor is None:
            self._floor = _blind_return(self._experiment)
        if mean > self._floor:
            return None
        return (
            f"it is certain of its actions, but its return of {mean:.3g} is no more than the "
            f"{self._floor:.3g} of doing nothing or playing at random"
        )


def _blind_return(experiment: Experiment) -> float:
    """Return what doing nothing returns, or playing at random if that is more."""
    worlds = make_worlds(experiment, _GAMES)
    try:
        space = worlds.single_action_space
        seed = spread_seed(experiment.seed, Purpose.BLIND, _GAMES)
        seeds = spread_seeds(experiment.seed, Purpose.BLIND, _GAMES)
        policies = (NoOp(space), RandomPolicy(space, _GAMES, seed))
        return max(
            float(play_episodes(worlds, policy, seeds)["return"].mean()) for policy in policies
        )
    finally:
        worlds.close()


class Watched:
    """A policy that counts its actions, and looks now and then how probable they are.

    Args:
        policy: the policy that plays.
        model: the model whose policy it is, with discrete actions.
        num_worlds: how many worlds it plays in.
    """

    def __init__(self, policy: Policy, model: Any, num_worlds: int) -> None:
        self._policy = policy
        self._network = model.policy
        self._taken = np.zeros((num_worlds, int(model.action_space.n)))
        self._certainty = np.zeros((num_worlds, 2))  # the sum of probabilities, and their number
        self._calls = 0

    def __call__(self, observations: Any, worlds: NDArray[np.int64]) -> NDArray[Any]:
        """Return the policy's actions."""
        actions = self._policy(observations, worlds)
        self._taken[worlds, actions] += 1
        if self._calls % _LOOK_EVERY == 0:
            seen = network_input(self._network, observations)
            with torch.no_grad():
                probs = self._network.get_distribution(seen).distribution.probs
            self._certainty[worlds] += np.stack(
                [probs.max(1)[0].cpu().numpy(), np.ones(len(worlds))], 1
            )
        self._calls += 1
        return actions

    def stuck(self, cleared: NDArray[np.float64]) -> list[int]:
        """Return the levels on which it always takes one action, surely, and that it never clears.

        Args:
            cleared: whether each level was cleared, [episodes, levels].
        """
        levels = cleared.shape[1]
        taken = self._taken.reshape(levels, -1, self._taken.shape[1]).sum(axis=1)
        certainty = self._certainty.reshape(levels, -1, 2).sum(axis=1)
        same = taken.max(axis=1) >= ALWAYS * taken.sum(axis=1)
        sure = certainty[:, 0] >= ALWAYS * certainty[:, 1]
        return np.flatnonzero(same & sure & (cleared.max(axis=0) == 0)).tolist()


def stuck_warning(levels: Sequence[str], step: int) -> str:
    """Return the warning about levels on which a policy is stuck."""
    names = ", ".join(levels[:_NAMED])
    if len(levels) > _NAMED:
        names += f" and {len(levels) - _NAMED} more levels"
    return (
        f"the policy has collapsed on {names}: at {step:,} decisions it always takes "
        f"the same action there, and clears nothing; {_ADVICE}"
    )
