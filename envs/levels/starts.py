"""How episodes begin: the options of `reset`, on which curricula are built."""

from os import PathLike, fspath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import check_boolean, check_integer, check_number
from ..config import Config
from ..rules import EMPTY
from ..state import AS_CONFIGURED, GIVEN_LAYOUT, GIVEN_SEED, REPEATED_SEED
from .generator import MAX_SEED
from .plan import LevelPlan, check_boss, level_table

# The options of `reset`, and what each means.
START_OPTIONS = {
    "level": "the first level: its name, the path of its file, or the number of a round",
    "seed": "the first level: the one that the generator makes of this seed, from 0 to 2^63 - 1",
    "repeat": "with a seed: whether all further rounds are this level, too",
    "difficulty": "the difficulty of all generated levels, in [0, 1]",
}
MAX_ROUND = 10**9


# The fields of `World` that say how episodes begin, where they begin as the configuration says.
AS_THE_CONFIGURATION_SAYS: dict[str, Any] = {
    "start": AS_CONFIGURED,
    "start_round": 1,
    "start_seed": 0,
    "start_difficulty": -1.0,
    "start_boss": 0,
    "start_kind": EMPTY,
}


def set_starts(worlds: Any, mask: NDArray[np.bool_], fields: dict[str, Any]) -> None:
    """Set how the episodes of the worlds in a mask (bool [n]) begin from now on."""
    for name, value in fields.items():
        worlds[name][mask] = value


def read_start(options: dict[str, Any], config: Config, plan: LevelPlan) -> dict[str, Any]:
    """Return the fields of `World` that options set, and their values.

    Raises:
        TypeError, ValueError: an option has an illegal value.
    """
    level, seed = options.get("level"), options.get("seed")
    if isinstance(level, PathLike):
        level = fspath(level)
    if level is not None and seed is not None:
        raise ValueError(f"give reset either a level or a seed; got both, {level!r} and {seed!r}")
    repeat = options.get("repeat", False)
    check_boolean("options['repeat']", repeat)
    if repeat and seed is None:
        raise ValueError("options['repeat'] repeats the level of a seed: give reset 'seed', too")
    fields: dict[str, Any] = {}
    if "level" in options or "seed" in options:
        fields |= _first_round(level, seed, repeat, config, plan)
    if "difficulty" in options:
        difficulty = options["difficulty"]
        if difficulty is not None:
            check_number("options['difficulty']", difficulty, 0.0, 1.0)
        fields["start_difficulty"] = -1.0 if difficulty is None else difficulty
    return fields


def _first_round(
    level: Any, seed: Any, repeat: bool, config: Config, plan: LevelPlan
) -> dict[str, Any]:
    if seed is not None:
        check_integer("options['seed']", seed, 0, MAX_SEED)
        start = REPEATED_SEED if repeat else GIVEN_SEED
        return {"start": start, "start_round": 1, "start_seed": seed, "start_boss": 0}
    number = 1
    if isinstance(level, str):
        check_boss(config, level)
        if level not in plan.names:
            record = level_table([level])[0]
            return {
                "start": GIVEN_LAYOUT,
                "start_round": 1,
                "start_kind": record["kind"],
                "start_boss": record["boss"],
            }
        number = plan.names.index(level) + 1
    elif level is not None:
        check_integer("options['level'], if it is no name,", level, 1, MAX_ROUND)
        number = level
    return {"start": AS_CONFIGURED, "start_round": number}
