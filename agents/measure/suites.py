"""Suites: the levels that a policy is measured on, and how an episode begins on each."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...envs.levels.plan import TEST_SEEDS, campaign_names, check_boss, seed_range
from ..experiment.errors import SettingsError
from ..experiment.files import level_mistake
from ..experiment.settings import Experiment

# Stands for all named levels of the experiment's game.
NAMED = "named"
_MOST_LEVELS = 100_000


@dataclass(frozen=True)
class EpisodeStart:
    """How an episode begins.

    Attributes:
        name: the level's, for tables.
        options: for the environment's `reset`; None begins a game as it is configured.
    """

    name: str
    options: dict[str, Any] | None = None


WHOLE_GAMES = EpisodeStart("whole games")


@dataclass(frozen=True)
class Suite:
    """Levels that are measured together.

    Attributes:
        starts: one for each level.
        episodes: on each level.
        whole_games: whether an episode lasts until the game is over, or until its level is cleared.
    """

    starts: tuple[EpisodeStart, ...]
    episodes: int
    whole_games: bool = False


def make_suites(experiment: Experiment) -> dict[str, Suite]:
    """Return the suites of an experiment's evaluation by their names.

    An agent that trains on the campaign trains on the named levels: its suite ``training`` would
    repeat ``named``, and is left out. Raises `SettingsError` if a level of the experiment does not
    exist.
    """
    settings = experiment.evaluation
    levels = experiment.config.levels
    suites: dict[str, Suite] = {}
    for name in settings.suites:
        if name == "games":
            suites[name] = Suite((WHOLE_GAMES,), settings.episodes, whole_games=True)
        elif name == "named":
            suites[name] = Suite(find_starts(experiment, NAMED), settings.level_episodes)
        elif name == "test":
            starts = find_starts(experiment, TEST_SEEDS[: settings.generated])
            suites[name] = Suite(starts, settings.level_episodes)
        elif levels != "campaign":
            starts = find_starts(experiment, levels, settings.generated)
            suites[name] = Suite(starts, settings.level_episodes)
    return suites


def find_starts(
    experiment: Experiment, levels: str | range | Sequence[str], at_most: int | None = None
) -> tuple[EpisodeStart, ...]:
    """Return how an episode begins on each of some levels.

    Args:
        experiment: says which named levels its game has, and how difficult generated levels are.
        levels: as the environment's keyword ``levels``, or `NAMED`.
        at_most: how many seeds of each range are taken, evenly spread; None: all.

    Raises:
        SettingsError: there is no such level, or the experiment's game cannot play it.
    """
    names = [levels] if isinstance(levels, str | range) else list(levels)
    starts: list[EpisodeStart] = []
    for name in names:
        try:
            starts += _starts_of(experiment, name, at_most)
        except (OSError, ValueError) as error:
            raise SettingsError(level_mistake(str(name), error)) from None
    return tuple(starts)


def _starts_of(
    experiment: Experiment, name: str | range, at_most: int | None
) -> list[EpisodeStart]:
    if name == NAMED:
        return [EpisodeStart(each, {"level": each}) for each in campaign_names(experiment.config)]
    seeds = seed_range(name)
    if seeds is None:
        level = str(name)
        check_boss(experiment.config, level)
        return [EpisodeStart(level, {"level": level})]
    total = seeds.stop - seeds.start  # can be more than `len` counts
    count = min(total, at_most or total)
    if count > _MOST_LEVELS:
        raise ValueError(f"at most {_MOST_LEVELS:,} levels can be played")
    places = np.linspace(0, total - 1, count).round().astype(int)
    return _generated(experiment, [seeds[place] for place in places.tolist()])


def _generated(experiment: Experiment, seeds: Sequence[int]) -> list[EpisodeStart]:
    """Return generated levels, as difficult as configured, or from the easiest to the hardest."""
    difficulty = experiment.config.difficulty
    if difficulty is not None:
        difficulties = [float(difficulty)] * len(seeds)
    elif len(seeds) > 1:
        difficulties = np.linspace(0, 1, len(seeds)).round(4).tolist()
    else:
        difficulties = [0.5]
    return [
        EpisodeStart(f"{seed} at {hard:.2f}", {"seed": int(seed), "difficulty": hard})
        for seed, hard in zip(seeds, difficulties, strict=True)
    ]
