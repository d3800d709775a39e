"""Level files: text, with one character per brick.

A file begins with headings:

    name: Ripple
    comment: Waves that run through each other.

    ...wocg....      eleven characters per row, at most eighteen rows, the top row first

``.`` is an empty cell; ``w o c g r b m y`` are coloured bricks of 50 to 120 points; ``S`` is silver
(it needs several hits) and ``X`` gold (it never breaks). Missing rows at the bottom are empty. The
heading ``boss: yes`` brings the boss. A level that nobody can clear is refused.
"""

import errno
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..reading import read_limited
from ..rules import BRICK_LETTERS, COLUMNS, EMPTY, GOLD, ROWS
from .clearability import unreachable_bricks

_PACKAGED = f"{__package__}.named"
_MOST_BYTES = 1 << 20  # of a file
_SHOWN = 200  # letters of a wrong name, in an error

# The named levels in the order in which the campaign plays them; the boss is in the last one.
CAMPAIGN: tuple[str, ...] = (
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
class Level:
    """Where the bricks of a level lie.

    Attributes:
        name: the name that players see.
        comment: the author's comment.
        kinds: uint8 [18, 11], the kind of brick in each cell, the top row first.
        boss: whether the boss is there and must be beaten.
    """

    name: str
    comment: str
    kinds: NDArray[np.uint8]
    boss: bool = False


def level_names() -> list[str]:
    """Return the names of the packaged levels."""
    files = resources.files(_PACKAGED).iterdir()
    return sorted(file.name[:-4] for file in files if file.name.endswith(".txt"))


def load_level(name_or_path: str) -> Level:
    """Read a packaged level by its name, or a level file by its path.

    Raises:
        ValueError: there is no such level, the file is malformed, or the level cannot be cleared;
            the message names the file, the line and the mistake.
    """
    if name_or_path in level_names():
        text = (resources.files(_PACKAGED) / f"{name_or_path}.txt").read_text("utf-8")
        return parse_level(text, f"{name_or_path}.txt")
    path = Path(name_or_path)
    if not _is_file(path):
        name = name_or_path if len(name_or_path) <= _SHOWN else f"{name_or_path[:_SHOWN]}..."
        near = get_close_matches(name, level_names(), 1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        raise ValueError(
            f"no level {name!r}: it is neither a file nor one of the packaged levels "
            f"({', '.join(level_names())}).{hint}"
        )
    try:
        # Some editors begin a file with a byte-order mark.
        text = read_limited(path, _MOST_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{name_or_path}: the file is not UTF-8 text: {error}") from None
    except ValueError as error:
        raise ValueError(f"{name_or_path}: not a level: {error}") from None
    return parse_level(text, name_or_path)


def _is_file(path: Path) -> bool:
    """Tell whether there is a file; none has a name that is too long for the system."""
    try:
        return path.is_file()
    except OSError as error:
        if error.errno != errno.ENAMETOOLONG:
            raise
        return False


def parse_level(text: str, source: str) -> Level:
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
            if not value.replace("\t", " ").isprintable():
                raise ValueError(f"{where}: {key} has characters that steer terminals: {value!r}")
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
    return Level(header["name"], header["comment"], kinds, boss)


def _check_clearable(kinds: NDArray[np.uint8], source: str, first_line: int) -> None:
    """Refuse bricks that no ball can reach; ``first_line`` is the line of the first row."""
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
