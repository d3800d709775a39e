"""Levels from text files: one character a brick, with a name and its author's comment.

    name: Ripple
    comment: Waves that run through each other.

    ...wocg....      eleven characters a row, at most eighteen rows, the top one first

``.`` is no brick; ``w o c g r b m y`` are coloured ones of 50 to 120 points; ``S`` is silver (it
needs several hits) and ``X`` gold (it never breaks). Missing rows at the bottom are empty.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import levels as packaged
from .rules import BRICK_LETTERS, COLUMNS, GOLD, ROWS
from .state import Level


@dataclass(frozen=True)
class Round:
    """A level's name, its author's comment, and its bricks' kinds (uint8 [18, 11], top first)."""

    name: str
    comment: str
    kinds: NDArray[np.uint8]


def named_rounds() -> list[str]:
    """Return the names by which the packaged levels can be asked for."""
    files = resources.files(packaged).iterdir()
    return sorted(file.name[:-4] for file in files if file.name.endswith(".txt"))


def load_round(name_or_path: str) -> Round:
    """Read a packaged level by its name, or a level file by its path.

    Raises:
        ValueError: there is no such level, or the file is malformed; the message names the file,
            the line and what is expected there.
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
    return parse_round(path.read_text("utf-8"), name_or_path)


def parse_round(text: str, source: str) -> Round:
    """Parse a level file's text; ``source`` names it in errors (ValueError)."""
    header = {"name": Path(source).stem, "comment": ""}
    rows: list[list[int]] = []
    for number, line in enumerate(text.splitlines(), 1):
        where = f"{source}, line {number}"
        key, colon, value = line.partition(":")
        if colon and not rows:
            if key.strip() not in header:
                raise ValueError(f"{where}: unknown heading {key.strip()!r}; known: name, comment")
            header[key.strip()] = value.strip()
        elif line.strip() or rows:
            rows.append(_parse_row(line.rstrip(), where))
    if len(rows) > ROWS:
        raise ValueError(f"{source}: {len(rows)} rows of bricks; at most {ROWS} fit the field")
    kinds = np.zeros((ROWS, COLUMNS), np.uint8)
    if rows:
        kinds[: len(rows)] = rows
    if not ((kinds > 0) & (kinds != GOLD)).any():
        raise ValueError(f"{source}: there is no breakable brick, so the level can't be cleared")
    return Round(header["name"], header["comment"], kinds)


def _parse_row(line: str, where: str) -> list[int]:
    if len(line) != COLUMNS:
        raise ValueError(f"{where}: {len(line)} characters; a row of bricks has {COLUMNS}")
    for column, letter in enumerate(line, 1):
        if letter not in BRICK_LETTERS:
            raise ValueError(
                f"{where}, column {column}: {letter!r} is no brick; known are {BRICK_LETTERS!r}"
            )
    return [BRICK_LETTERS.index(letter) for letter in line]


def level_table(names: Sequence[str]) -> Any:
    """Return the levels of a batch, in order, as an array of `Level` records."""
    table = np.zeros(len(names), Level)
    for record, name in zip(table, names, strict=True):
        record["kind"] = load_round(name).kinds.ravel()
    return table
