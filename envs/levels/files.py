"""Rounds: from text files, one character a brick, or from the generator.

A file begins with a name and its author's comment:

    name: Ripple
    comment: Waves that run through each other.

    ...wocg....      eleven characters a row, at most eighteen rows, the top one first

``.`` is no brick; ``w o c g r b m y`` are coloured ones of 50 to 120 points; ``S`` is silver (it
needs several hits) and ``X`` gold (it never breaks). Missing rows at the bottom are empty. A level
that cannot be cleared is refused. ``boss: yes`` among the headings brings the boss.
"""

from dataclasses import dataclass
from difflib import get_close_matches
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import check_choice, check_integer, check_number
from ..rules import BRICK_LETTERS, CELLS, COLUMNS, EMPTY, GOLD, ROWS
from . import named as packaged
from .clearability import unreachable_bricks
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
    lay_level,
    plan_level,
)
from .motifs import MOTIFS

# The named rounds in the order of the campaign, the boss's last.
CAMPAIGN = (
    "ripple",
    "archway",
    "honeycomb",
    "hourglass",
    "nested_rings",
    "comb",
    "islands",
    "moat",
    "snowflake",
    "spiral",
    "vault",
    "switchback",
    "warden",
)


@dataclass(frozen=True)
class Round:
    """A level.

    Attributes:
        name: what players call it.
        comment: its author's.
        kinds: uint8 [18, 11], its bricks by their kinds, the top row first.
        boss: whether the boss is in it, who must be beaten.
    """

    name: str
    comment: str
    kinds: NDArray[np.uint8]
    boss: bool = False


def named_rounds() -> list[str]:
    """Return the names by which the packaged levels can be asked for."""
    files = resources.files(packaged).iterdir()
    return sorted(file.name[:-4] for file in files if file.name.endswith(".txt"))


def campaign_rounds() -> list[Round]:
    """Return the twelve named rounds in their order, and after them the boss's."""
    return [load_round(name) for name in CAMPAIGN]


def load_round(name_or_path: str) -> Round:
    """Read a packaged level by its name, or a level file by its path.

    Raises:
        ValueError: there is no such level, or the file is malformed, or the level cannot be
            cleared; the message names the file, the line and what is wrong there.
    """
    if name_or_path in named_rounds():
        text = (resources.files(packaged) / f"{name_or_path}.txt").read_text("utf-8")
        return parse_round(text, f"{name_or_path}.txt")
    path = Path(name_or_path)
    if not path.is_file():
        near = get_close_matches(name_or_path, named_rounds(), 1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        raise ValueError(
            f"no level {name_or_path!r}: it is neither a file nor one of the packaged rounds "
            f"({', '.join(named_rounds())}).{hint}"
        )
    try:
        return parse_round(path.read_text("utf-8"), name_or_path)
    except UnicodeDecodeError as error:
        raise ValueError(f"{name_or_path}: no text in UTF-8: {error}") from None


def parse_round(text: str, source: str) -> Round:
    """Parse a level file's text; ``source`` names it in errors (ValueError)."""
    header = {"name": Path(source).stem, "comment": "", "boss": "no"}
    rows: list[list[int]] = []
    first_line = 0
    for number, line in enumerate(text.rstrip().splitlines(), 1):
        where = f"{source}, line {number}"
        key, colon, value = (part.strip() for part in line.partition(":"))
        if colon and not rows:
            if key not in header:
                raise ValueError(f"{where}: unknown heading {key!r}; known: {', '.join(header)}")
            if key == "boss" and value not in ("yes", "no"):
                raise ValueError(f"{where}: boss must be 'yes' or 'no'; got {value!r}")
            header[key] = value
        elif line.strip() or rows:
            first_line = first_line or number
            rows.append(_parse_row(line.rstrip(), where))
    if len(rows) > ROWS:
        raise ValueError(f"{source}: {len(rows)} rows of bricks; at most {ROWS} fit the field")
    kinds = np.zeros((ROWS, COLUMNS), np.uint8)
    if rows:
        kinds[: len(rows)] = rows
    boss = header["boss"] == "yes"
    if not boss and not ((kinds != EMPTY) & (kinds != GOLD)).any():
        raise ValueError(f"{source}: there is no breakable brick, so the level can't be cleared")
    _check_clearable(kinds, source, first_line)
    return Round(header["name"], header["comment"], kinds, boss)


def _check_clearable(kinds: NDArray[np.uint8], source: str, first_line: int) -> None:
    """Refuse bricks that no ball can reach; ``first_line`` is that of the first row."""
    barred = unreachable_bricks(kinds)
    if not barred:
        return
    places = []
    for row in sorted({row for row, _ in barred}):
        columns = [str(column + 1) for at, column in barred if at == row]
        word = "columns" if len(columns) > 1 else "column"
        places.append(f"line {first_line + row} {word} {', '.join(columns)}")
    raise ValueError(
        f"{source}: gold (X) keeps the ball from bricks, so the level can't be cleared: "
        f"{'; '.join(places)}. Leave a gap of one cell at a side, not only at a corner"
    )


def _parse_row(line: str, where: str) -> list[int]:
    if len(line) != COLUMNS:
        raise ValueError(f"{where}: {len(line)} characters; a row of bricks has {COLUMNS}")
    for column, letter in enumerate(line, 1):
        if letter not in BRICK_LETTERS:
            raise ValueError(
                f"{where}, column {column}: {letter!r} is no brick; known are {BRICK_LETTERS!r}"
            )
    return [BRICK_LETTERS.index(letter) for letter in line]


def generate_round(
    seed: int,
    motif: str | None = None,
    rows: int | None = None,
    density: float | None = None,
    symmetry: str | None = None,
    silver: float | None = None,
    gold: float | None = None,
    difficulty: float = 0.5,
) -> Round:
    """Return the generated level of a seed; what is None is as seed and difficulty decide.

    With a seed and a difficulty only, it is the level that games play.

    Args:
        seed: from 0 to 2^63 - 1. Agents train on `TRAIN_SEEDS`; the seeds that they are tested on
            begin at `FIRST_TEST_SEED`.
        motif: ``"wave"``, ``"rings"``, ``"islands"``, ``"stripes"`` or ``"noise"``.
        rows: of the lattice that the bricks lie in, 4 to 12.
        density: the part of those rows' cells that hold bricks, 0.35 to 0.9.
        symmetry: ``"none"``, ``"mirror"`` (left and right), ``"turn"`` (by half a turn) or
            ``"both"`` (left and right, up and down).
        silver: the part of the bricks that are silver at the most, 0 to 0.3.
        gold: the part of the bricks that are gold at the most, 0 to 0.15; there is less where it
            would bar the way to a brick.
        difficulty: from 0 to 1.

    Raises:
        ValueError: a value is out of range or unknown; the message says which and what is legal.
        TypeError: a value is of the wrong type.
    """
    check_integer("seed", seed, 0, MAX_SEED)
    check_number("difficulty", difficulty, 0.0, 1.0)
    changes: dict[str, Any] = {}
    if motif is not None:
        check_choice("motif", motif, tuple(MOTIFS))
        changes["motif"] = MOTIFS[motif]
    if rows is not None:
        check_integer("rows", rows, MIN_ROWS, MAX_ROWS)
        changes["rows"] = int(rows)
    if density is not None:
        check_number("density", density, MIN_DENSITY, MAX_DENSITY)
        changes["density"] = float(density)
    if symmetry is not None:
        check_choice("symmetry", symmetry, tuple(SYMMETRIES))
        changes["symmetry"] = SYMMETRIES[symmetry]
    if silver is not None:
        check_number("silver", silver, 0.0, MAX_SILVER)
        changes["silver"] = float(silver)
    if gold is not None:
        check_number("gold", gold, 0.0, MAX_GOLD)
        changes["gold"] = float(gold)
    recipe = plan_level(int(seed), float(difficulty))._replace(**changes)
    kinds = np.zeros(CELLS, np.uint8)
    lay_level(kinds, int(seed), recipe)
    return Round(
        f"{list(MOTIFS)[recipe.motif].capitalize()} {seed}",
        _describe(recipe),
        kinds.reshape(ROWS, COLUMNS),
    )


def _describe(recipe: Recipe) -> str:
    """Return the comment of a generated level: what it was made to."""
    symmetry = list(SYMMETRIES)[recipe.symmetry]
    return (
        f"Generated: {recipe.rows} rows, density {recipe.density:.2f}, symmetry {symmetry}, "
        f"silver {recipe.silver:.2f}, gold {recipe.gold:.2f}."
    )
