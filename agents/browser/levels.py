"""The levels that the page shows at first."""

from typing import Any

from ...envs.levels.files import level_names, load_level
from ...envs.rules import BRICK_LETTERS
from ..experiment.settings import Experiment
from ..measure.suites import EpisodeStart, find_starts


def asked_levels(experiment: Experiment, levels: str) -> dict[str, Any]:
    """Return levels for the page: their ``title``, and ``starts``, for `Game.reset` of each.

    Raises `SettingsError` if there is no such level, or the experiment's game cannot play it.
    """
    starts = find_starts(experiment, levels)
    return {"title": levels, "starts": [_start(start) for start in starts]}


def _start(start: EpisodeStart) -> dict[str, Any]:
    options = start.options or {}
    if "seed" in options:
        return {"levelSeed": options["seed"], "difficulty": options["difficulty"]}
    name = options["level"]
    level = load_level(name)
    if name in level_names() and not level.boss:
        return {"level": name}
    letters = "".join(BRICK_LETTERS[kind] for kind in level.kinds.ravel())
    return {"bricks": letters, "boss": level.boss}
