"""Games of a policy, recorded decision by decision."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv

from ...envs.config import Config
from ..experiment.datasets import Episode
from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from .episodes import begin_episodes
from .policy import Policy
from .suites import WHOLE_GAMES, EpisodeStart

# Games that are played side by side.
_SIDE_BY_SIDE = 16


def record_games(
    experiment: Experiment,
    make_policy: Callable[[VectorEnv[Any, Any, Any], int], Policy],
    played: Config,
    seen: Config,
    seeds: Sequence[int],
    most_decisions: int,
    starts: Sequence[EpisodeStart] = (WHOLE_GAMES,),
) -> Iterator[Episode]:
    """Yield the games that a policy plays.

    Args:
        experiment: says which environment.
        make_policy: makes the policy for the worlds that it plays in, and for a seed.
        played: the configuration of these worlds.
        seen: the same game, as the recording shows it.
        seeds: of each level's games.
        most_decisions: a game that is longer is truncated.
        starts: how games begin, one for each level.
    """
    for start in starts:
        for first in range(0, len(seeds), _SIDE_BY_SIDE):
            some = seeds[first : first + _SIDE_BY_SIDE]
            worlds = make_worlds(experiment, len(some), played)
            # How a game is seen does not change it: both are played with the same actions.
            shown = worlds if seen == played else make_worlds(experiment, len(some), seen)
            try:
                policy = make_policy(worlds, some[0])
                yield from _record(worlds, shown, policy, start, some, most_decisions)
            finally:
                worlds.close()
                shown.close()


def _record(
    worlds: VectorEnv[Any, Any, Any],
    shown: VectorEnv[Any, Any, Any],
    policy: Policy,
    start: EpisodeStart,
    seeds: Sequence[int],
    most_decisions: int,
) -> list[Episode]:
    count = worlds.num_envs
    observations, _ = begin_episodes(worlds, seeds, (start,))
    pictures = observations
    if shown is not worlds:
        pictures, _ = begin_episodes(shown, seeds, (start,))
    logs: list[_Log] = [_Log(picture) for picture in pictures]
    playing, decisions = np.arange(count), 0
    space = worlds.single_action_space
    actions = np.zeros((count, *(space.shape or ())), space.dtype)
    while playing.size:
        actions[playing] = policy(observations[playing], playing)
        observations, rewards, terminated, truncated, infos = worlds.step(actions)
        pictures = observations
        if shown is not worlds:
            pictures, _, _, _, infos = shown.step(actions)
        over = terminated | truncated
        for world in playing.tolist():
            picture = infos["final_obs"][world] if over[world] else pictures[world]
            logs[world].add(picture, actions[world], rewards[world], terminated[world])
        decisions += 1
        playing = playing[~over[playing]] if decisions < most_decisions else playing[:0]
    return [log.episode(seed) for log, seed in zip(logs, seeds, strict=True)]


class _Log:
    """The decisions of one game so far."""

    def __init__(self, observation: Any) -> None:
        self.observations = [np.array(observation)]
        self.actions: list[Any] = []
        self.rewards: list[float] = []
        self.terminated = False

    def add(self, observation: Any, action: Any, reward: float, terminated: bool) -> None:
        """Add a decision, and what is seen after it."""
        self.observations.append(np.array(observation))
        self.actions.append(np.array(action))
        self.rewards.append(float(reward))
        self.terminated = bool(terminated)

    def episode(self, seed: int) -> Episode:
        """Return the game."""
        return Episode(
            np.stack(self.observations),
            np.stack(self.actions),
            np.array(self.rewards),
            self.terminated,
            seed,
        )
