"""Which levels are played, and in which order: what the keyword `levels` stands for."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..rules import DIFFICULTY_AFTER_CAMPAIGN, EMPTY, GOLD
from ..state import LevelEntry
from .files import CAMPAIGN, load_level
from .generator import FIRST_TEST_SEED, MAX_SEED, TRAIN_SEEDS

if TYPE_CHECKING:
    from ..config import Config

TEST_SEEDS = range(FIRST_TEST_SEED, FIRST_TEST_SEED + 10_000)
_SEEDS = re.compile(r"seeds:(\d{1,19})-(\d{1,19})|seed:(\d{1,19})")


@dataclass(frozen=True)
class LevelPlan:
    """The levels of a batch.

    Attributes:
        names: the names of the levels that are played first, in order.
        table: those levels, `LevelEntry` records [n]. If there are no names, it has one entry that
            is never played.
        seeds: the seeds of the generated levels.
        endless: True: generated levels follow the table; False: the table is played again.
        first_difficulty: the difficulty of the first generated level, where difficulty rises.
    """

    names: tuple[str, ...]
    table: Any
    seeds: range
    endless: bool
    first_difficulty: float


def plan_levels(config: "Config") -> LevelPlan:
    """Return the levels of a validated configuration.

    Raises:
        ValueError: there is no such level, or it is malformed.
    """
    seeds = seed_range(config.levels)
    if seeds is not None:
        return LevelPlan((), np.zeros(1, LevelEntry), seeds, True, 0.0)
    if config.levels == "campaign":
        names = campaign_names(config)
        return LevelPlan(names, level_table(names), TRAIN_SEEDS, True, DIFFICULTY_AFTER_CAMPAIGN)
    names = (config.levels,) if isinstance(config.levels, str) else tuple(map(str, config.levels))
    table = level_table(names)
    for name in names:
        check_boss(config, name)
    return LevelPlan(names, table, TRAIN_SEEDS, False, 0.0)


def campaign_names(config: "Config") -> tuple[str, ...]:
    """Return the named levels of the campaign, in order; without enemies there is no boss."""
    return CAMPAIGN if config.enemies else CAMPAIGN[:-1]


def check_boss(config: "Config", name: str) -> None:
    """Raise a ValueError if a level has the boss but the game has no enemies."""
    if load_level(name).boss and not config.enemies:
        raise ValueError(
            f"level {name!r} has the boss, who can't come with enemies=False: choose another level"
        )


def check_layouts(kinds: NDArray[np.uint8], boss: NDArray[np.bool_], enemies: bool) -> None:
    """Raise a ValueError if a round could not be cleared, because it has nothing to hit.

    Args:
        kinds: of the bricks of rounds, [n, cells]; boss: [n], whether the boss is there.
        enemies: whether the game has enemies and the boss.
    """
    breakable = ((kinds > EMPTY) & (kinds < GOLD)).any(axis=1)
    if not (breakable | boss).all() or (boss.any() and not enemies):
        raise ValueError("no game has such levels: one of them has nothing to hit")


def seed_range(levels: str | range | Sequence[str]) -> range | None:
    """Return the seeds that `levels` asks for; None if it asks for levels by name.

    Raises:
        ValueError: the range is empty, has a step, or goes beyond the legal seeds.
    """
    given = levels
    if isinstance(levels, str):
        if levels in ("train", "test"):
            return TRAIN_SEEDS if levels == "train" else TEST_SEEDS
        if not levels.startswith(("seeds:", "seed:")):
            return None
        match = _SEEDS.fullmatch(levels)
        if match is None:
            raise ValueError(
                f"a generated level is asked for as seed:7, and several as seeds:100-200 (both "
                f"included); got {levels!r}"
            )
        first, last = (match[3], match[3]) if match[3] else (match[1], match[2])
        levels = range(int(first), int(last) + 1)
    if not isinstance(levels, range):
        return None
    if not levels or levels.step != 1 or levels.start < 0 or levels.stop - 1 > MAX_SEED:
        raise ValueError(
            f"levels must be a range of seeds from 0 to {MAX_SEED}, not empty and with step 1; "
            f"got {given!r}"
        )
    return levels


def level_table(names: Sequence[str]) -> Any:
    """Return levels, given by names or paths, as `LevelEntry` records [n]."""
    table = np.zeros(len(names), LevelEntry)
    for record, name in zip(table, names, strict=True):
        level = load_level(name)
        record["kind"] = level.kinds.ravel()
        record["boss"] = level.boss
    return table
