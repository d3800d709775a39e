"""Playing whole episodes with a policy, one per seed, many at once."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import torch
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from ...envs.checks import counted
from ..adapter import GymnasiumVecEnv
from ..experiment.errors import SettingsError
from .policy import Policy
from .suites import WHOLE_GAMES, EpisodeStart

# What infos tell of an episode: the value at its end, or the sum over its decisions.
FINAL_KEYWORDS = ("score", "lives", "round", "bricks_left")
SUMMED_KEYWORDS = ("hits", "rounds_cleared")

# The measures of an episode. `cleared` is 1 if the level that it began on was cleared.
MEASURES = ("cleared", "return", "steps", *FINAL_KEYWORDS, *SUMMED_KEYWORDS)


def adapt(worlds: VectorEnv[Any, Any, Any]) -> GymnasiumVecEnv:
    """Return the worlds for stable-baselines3, with the game's own statistics of each episode."""
    if hasattr(worlds.unwrapped, "device"):
        # Imported on demand: it imports torch.
        from ..tensor_adapter import TensorVecEnv

        return TensorVecEnv(worlds, FINAL_KEYWORDS, SUMMED_KEYWORDS)
    return GymnasiumVecEnv(worlds, FINAL_KEYWORDS, SUMMED_KEYWORDS)


def play_episodes(
    worlds: VectorEnv[Any, Any, Any],
    policy: Policy,
    seeds: Sequence[int],
    starts: Sequence[EpisodeStart] = (WHOLE_GAMES,),
    whole_games: bool = True,
    ended: Callable[[int], None] = lambda games: None,
) -> dict[str, NDArray[np.float64]]:
    """Play one episode in each world, equally many on each level; return their measures.

    An episode depends on nothing but its seed, its level and the policy. Only the first one of each
    world counts: to take whichever episodes end first would favour short ones.

    Args:
        worlds: native and in SAME_STEP mode, as many as there are levels times seeds; if they are
            on a device, the policy is given tensors.
        policy: who plays.
        seeds: of each level's episodes.
        starts: how episodes begin, one for each level.
        whole_games: whether an episode lasts until the game is over, or until its level is cleared.
        ended: gets after each step how many episodes have ended with it.

    Returns:
        For each of `MEASURES` an array [episodes, levels].

    Raises:
        SettingsError: a graphics card has too little memory.
    """
    observations, _ = begin_episodes(worlds, seeds, starts)
    try:
        measured = _play(worlds, policy, observations, whole_games, ended)
    except torch.OutOfMemoryError:
        raise SettingsError(
            f"the graphics card has too little memory for {counted(worlds.num_envs, 'game')} at "
            "once: take fewer episodes or levels, or 'training.device' = 'cpu'"
        ) from None
    return {name: values.reshape(len(starts), -1).T for name, values in measured.items()}


def _play(
    worlds: VectorEnv[Any, Any, Any],
    policy: Policy,
    observations: Any,
    whole_games: bool,
    ended: Callable[[int], None],
) -> dict[str, NDArray[np.float64]]:
    """Play all worlds' episodes from their first observations; return measures [worlds]."""
    count = worlds.num_envs
    measured = {name: np.zeros(count) for name in MEASURES}
    playing = np.arange(count)
    space = worlds.single_action_space
    actions = np.zeros((count, *(space.shape or ())), space.dtype)
    while playing.size:
        actions[playing] = policy(observations[playing], playing)
        observations, rewards, terminated, truncated, infos = worlds.step(actions)
        over, latest = _latest(rewards, terminated | truncated, infos)
        measured["steps"][playing] += 1
        for name in ("return", *SUMMED_KEYWORDS):
            measured[name][playing] += latest[name][playing]
        for name in FINAL_KEYWORDS:
            measured[name][playing] = latest[name][playing]
        measured["cleared"][playing] = measured["rounds_cleared"][playing] > 0
        ends = over[playing] if whole_games else over[playing] | (measured["cleared"][playing] > 0)
        playing = playing[~ends]
        ended(int(ends.sum()))
    return measured


def begin_episodes(
    worlds: VectorEnv[Any, Any, Any], seeds: Sequence[int], starts: Sequence[EpisodeStart]
) -> tuple[Any, dict[str, Any]]:
    """Begin the episodes of every level, level by level; return observations and infos."""
    episodes = len(seeds)
    if episodes * len(starts) != worlds.num_envs:
        raise ValueError(
            f"{counted(worlds.num_envs, 'world')} for {counted(len(starts), 'level')} times "
            f"{counted(episodes, 'episode')}"
        )
    of_worlds = [seed for _ in starts for seed in seeds]
    observations: Any = None
    infos: dict[str, Any] = {}
    for index, start in enumerate(starts):
        mask = np.zeros(worlds.num_envs, np.bool_)
        mask[index * episodes : (index + 1) * episodes] = True
        # Without these the options of a world's earlier episodes would stay in force.
        as_configured = {"level": None, "difficulty": None}
        options = {**as_configured, **(start.options or {}), "reset_mask": mask}
        observations, infos = worlds.reset(seed=of_worlds, options=options)  # type: ignore[arg-type]
    return observations, infos


def _latest(
    rewards: Any, over: Any, infos: dict[str, Any]
) -> tuple[NDArray[np.bool_], dict[str, NDArray[Any]]]:
    """Return which episodes are over, and rewards and infos; where one is over, its final info."""
    names = FINAL_KEYWORDS + SUMMED_KEYWORDS
    if isinstance(over, torch.Tensor):
        final = infos["final_info"]
        # All of it comes from the device at once: each copy would wait for it.
        rows = [rewards, over, *(torch.where(over, final[name], infos[name]) for name in names)]
        rewards, over, *told = torch.stack([row.to(torch.float64) for row in rows]).cpu().numpy()
        return over > 0, {"return": rewards, **dict(zip(names, told, strict=True))}
    latest = {"return": rewards, **{name: infos[name] for name in names}}
    if over.any():
        final = infos["final_info"]
        latest |= {name: np.where(over, final[name], infos[name]) for name in names}
    return over, latest
