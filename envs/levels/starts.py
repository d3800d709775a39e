"""How episodes begin: the options of `reset`, on which curricula are built."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import check_integer, check_number
from ..config import Config
from ..state import AS_CONFIGURED, GIVEN_LAYOUT, GIVEN_SEED
from .generator import MAX_SEED
from .plan import LevelPlan, check_boss, level_table

# The options of `reset`, and what each means.
START_OPTIONS = {
    "level": "the first level: its name, the path of its file, or the number of a round",
    "seed": "the first level: the one that the generator makes of this seed",
    "difficulty": "the difficulty of all generated levels, in [0, 1]",
}
MAX_ROUND = 10**9


def forget_starts(worlds: Any) -> None:
    """Let the episodes of all worlds begin as the configuration says."""
    worlds["start"] = AS_CONFIGURED
    worlds["start_round"] = 1
    worlds["start_difficulty"] = -1.0


def choose_starts(
    worlds: Any,
    mask: NDArray[np.bool_],
    options: dict[str, Any],
    config: Config,
    plan: LevelPlan,
) -> None:
    """Set how the episodes of the worlds in a mask (bool [n]) begin from now on.

    Raises:
        TypeError, ValueError: an option has an illegal value; then nothing changes.
    """
    level, seed = options.get("level"), options.get("seed")
    if level is not None and seed is not None:
        raise ValueError(f"give reset either a level or a seed; got both, {level!r} and {seed!r}")
    difficulty = options.get("difficulty")
    if difficulty is not None:
        check_number("options['difficulty']", difficulty, 0.0, 1.0)
    if "level" in options or "seed" in options:
        _choose_first_round(worlds, mask, level, seed, config, plan)
    if "difficulty" in options:
        worlds["start_difficulty"][mask] = -1.0 if difficulty is None else difficulty


def _choose_first_round(
    worlds: Any,
    mask: NDArray[np.bool_],
    level: Any,
    seed: Any,
    config: Config,
    plan: LevelPlan,
) -> None:
    start, number = AS_CONFIGURED, 1
    if seed is not None:
        check_integer("options['seed']", seed, 0, MAX_SEED)
        start = GIVEN_SEED
        worlds["start_seed"][mask] = seed
        worlds["start_boss"][mask] = 0
    elif isinstance(level, str):
        check_boss(config, level)
        if level in plan.names:
            number = plan.names.index(level) + 1
        else:
            start = GIVEN_LAYOUT
            record = level_table([level])[0]
            worlds["start_kind"][mask] = record["kind"]
            worlds["start_boss"][mask] = record["boss"]
    elif level is not None:
        check_integer("options['level'], if it is no name,", level, 1, MAX_ROUND)
        number = level
    worlds["start"][mask] = start
    worlds["start_round"][mask] = number
