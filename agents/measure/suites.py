"""On which levels a policy is measured, and how an episode is begun on each."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...envs.levels.files import CAMPAIGN, load_round
from ...envs.levels.plan import TEST_SEEDS, seed_range
from ..experiment.schema import SettingsError
from ..experiment.settings import Experiment


@dataclass(frozen=True)
class Start:
    """How an episode begins.

    Attributes:
        name: of the level, for tables.
        options: for the environment's `reset`; None begins a game as it is configured.
    """

    name: str
    options: dict[str, Any] | None = None


@dataclass(frozen=True)
class Suite:
    """Levels that are measured together.

    Attributes:
        starts: one a level.
        episodes: of each.
        whole: whether an episode lasts as long as the game, or until the level is cleared.
    """

    starts: tuple[Start, ...]
    episodes: int
    whole: bool = False


def make_suites(experiment: Experiment) -> dict[str, Suite]:
    """Return the suites of an experiment's evaluation by their names.

    Training on the campaign is training on the named rounds: then there is no suite ``training``
    beside ``named``. Raises `SettingsError` if the experiment's levels are none.
    """
    settings = experiment.evaluation
    levels = experiment.env.get("levels", "campaign")
    suites: dict[str, Suite] = {}
    for name in settings.suites:
        if name == "games":
            suites[name] = Suite((Start("whole games"),), settings.episodes, whole=True)
        elif name == "named":
            suites[name] = Suite(_named(experiment), settings.level_episodes)
        elif name == "test":
            seeds = range(TEST_SEEDS.start, TEST_SEEDS.start + settings.generated)
            suites[name] = Suite(_generated(experiment, seeds), settings.level_episodes)
        elif levels != "campaign":
            starts = find_starts(experiment, levels, settings.generated)
            suites[name] = Suite(starts, settings.level_episodes)
    return suites


def find_starts(
    experiment: Experiment, levels: str | Sequence[str], at_most: int | None = None
) -> tuple[Start, ...]:
    """Return a start for each level that is named as in the environment's keyword ``levels``.

    Of more seeds than ``at_most``, as many are taken, evenly spread. Raises `SettingsError`.
    """
    names = [levels] if isinstance(levels, str) else list(levels)
    starts: list[Start] = []
    for name in names:
        try:
            seeds = seed_range(name)
            if seeds is None:
                load_round(name)
        except (OSError, ValueError) as error:
            raise SettingsError(f"level {name!r}: {error}") from None
        if seeds is None:
            starts.append(Start(name, {"level": name}))
            continue
        count = min(len(seeds), at_most or len(seeds))
        places = np.linspace(0, len(seeds) - 1, count).round().astype(int)
        starts += _generated(experiment, [seeds[int(place)] for place in places])
    return tuple(starts)


def _named(experiment: Experiment) -> tuple[Start, ...]:
    # The last one is the boss's, and he is an enemy.
    lite = experiment.env_id == "ArkanoidLite-v0"
    enemies = experiment.env.get("enemies", not lite)
    names = CAMPAIGN if enemies else CAMPAIGN[:-1]
    return tuple(Start(name, {"level": name}) for name in names)


def _generated(experiment: Experiment, seeds: Sequence[int]) -> tuple[Start, ...]:
    """Return starts of generated levels: as difficult as configured, or from easiest to hardest."""
    difficulty = experiment.env.get("difficulty")
    if difficulty is None:
        rising = np.linspace(0, 1, len(seeds)).round(4).tolist() if len(seeds) > 1 else [0.5]
    else:
        rising = [float(difficulty)] * len(seeds)
    return tuple(
        Start(f"{seed} at {hard:.2f}", {"seed": int(seed), "difficulty": hard})
        for seed, hard in zip(seeds, rising, strict=True)
    )
