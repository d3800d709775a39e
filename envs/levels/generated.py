"""Generated levels as a user asks for them: any part of a recipe can be fixed."""

from typing import Any

import numpy as np

from ..checks import check_choice, check_integer, check_number
from ..rules import CELLS, COLUMNS, ROWS
from .files import Level
from .generator import (
    MAX_DENSITY,
    MAX_GOLD,
    MAX_ROWS,
    MAX_SEED,
    MAX_SILVER,
    MIN_DENSITY,
    MIN_ROWS,
    SYMMETRIES,
    Recipe,
    lay_recipe,
    make_recipe,
)
from .motifs import MOTIFS


def generate_level(
    seed: int,
    motif: str | None = None,
    rows: int | None = None,
    density: float | None = None,
    symmetry: str | None = None,
    silver: float | None = None,
    gold: float | None = None,
    difficulty: float = 0.5,
) -> Level:
    """Return the generated level of a seed; seed and difficulty decide whatever is None.

    With a seed and a difficulty only, it is the level that games play.

    Args:
        seed: from 0 to 2^63 - 1. Agents train on `TRAIN_SEEDS`; the seeds of their test levels
            begin at `FIRST_TEST_SEED`.
        motif: ``"wave"``, ``"rings"``, ``"islands"``, ``"stripes"`` or ``"noise"``.
        rows: rows of cells in which the bricks lie, 4 to 12.
        density: the fraction of those cells that hold bricks, 0.35 to 0.9.
        symmetry: ``"none"``, ``"mirror"`` (left and right), ``"turn"`` (by half a turn) or
            ``"both"`` (left and right, up and down).
        silver: the largest fraction of the bricks that may be silver, 0 to 0.3.
        gold: the largest fraction of the bricks that may be gold, 0 to 0.15; there is less gold
            where it would bar the way to a brick.
        difficulty: from 0 to 1.

    Raises:
        ValueError: a value is out of range or unknown; the message says which, and what is legal.
        TypeError: a value has the wrong type.
    """
    check_integer("seed", seed, 0, MAX_SEED)
    check_number("difficulty", difficulty, 0.0, 1.0)
    fixed: dict[str, Any] = {}
    if motif is not None:
        check_choice("motif", motif, tuple(MOTIFS))
        fixed["motif"] = MOTIFS[motif]
    if rows is not None:
        check_integer("rows", rows, MIN_ROWS, MAX_ROWS)
        fixed["rows"] = int(rows)
    if symmetry is not None:
        check_choice("symmetry", symmetry, tuple(SYMMETRIES))
        fixed["symmetry"] = SYMMETRIES[symmetry]
    for name, value, low, high in (
        ("density", density, MIN_DENSITY, MAX_DENSITY),
        ("silver", silver, 0.0, MAX_SILVER),
        ("gold", gold, 0.0, MAX_GOLD),
    ):
        if value is not None:
            check_number(name, value, low, high)
            fixed[name] = float(value)
    recipe = make_recipe(int(seed), float(difficulty))._replace(**fixed)
    kinds = np.zeros(CELLS, np.uint8)
    lay_recipe(kinds, int(seed), recipe)
    name = f"{list(MOTIFS)[recipe.motif].capitalize()} {seed}"
    return Level(name, _describe(recipe), kinds.reshape(ROWS, COLUMNS))


def _describe(recipe: Recipe) -> str:
    """Return a generated level's comment: its recipe."""
    symmetry = list(SYMMETRIES)[recipe.symmetry]
    return (
        f"Generated: {recipe.rows} rows, density {recipe.density:.2f}, symmetry {symmetry}, "
        f"silver {recipe.silver:.2f}, gold {recipe.gold:.2f}."
    )
