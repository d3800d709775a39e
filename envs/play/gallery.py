"""Levels to look at: as a list, as text for terminals and files, and as pictures."""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from ..config import Config
from ..draw.palette import BRICK, BRICK_FOOT, BRICK_SHADED, FIELD_LOWER, LUMA, PALETTE
from ..levels.files import CAMPAIGN, Round, generate_round, load_round
from ..levels.generator import MAX_SEED
from ..rules import BRICK_LETTERS, EMPTY, GOLD, SILVER

# How difficult a level is that is asked for by its seed alone.
DIFFICULTY = 0.5

# How many colours a terminal shows.
LETTERS = 0
COLOURS = 256
TRUE_COLOURS = 1 << 24

PICTURE_COLUMNS = 5  # pictures beside each other
_MARGIN = 8  # pixels between them

_SEED = re.compile(r"seed:(\d{1,19})")
_RESET = "\x1b[0m"
_BRIGHT = 110.0  # brightness of a brick from which on its letter is dark


def chosen_seed(level: str) -> int | None:
    """Return the seed of a level that is asked for as ``seed:7``; None if it is no such one.

    Raises:
        ValueError: it begins like one, and is none.
    """
    if not level.startswith("seed:"):
        return None
    match = _SEED.fullmatch(level)
    if match is None or int(match[1]) > MAX_SEED:
        raise ValueError(
            f"a generated level is asked for by a seed from 0 to {MAX_SEED}, as in seed:7; "
            f"got {level!r}"
        )
    return int(match[1])


def find_level(level: str, difficulty: float = DIFFICULTY) -> Round:
    """Return a level by its name, its file's path, or as ``seed:7``.

    Raises:
        OSError, ValueError: there is no such level, or its file can't be read or is malformed.
    """
    seed = chosen_seed(level)
    if seed is not None:
        return generate_round(seed, difficulty=difficulty)
    return load_round(level)


def count_bricks(level: Round) -> tuple[int, int, int]:
    """Return how many bricks there are to be broken, silver ones among them, and golden ones."""
    kinds = level.kinds
    breakable = int(((kinds != EMPTY) & (kinds != GOLD)).sum())
    return breakable, int((kinds == SILVER).sum()), int((kinds == GOLD).sum())


def list_levels() -> str:
    """Return a table of the named rounds."""
    width = max(map(len, CAMPAIGN))
    lines = [f"{'name':{width}}  bricks  silver  gold"]
    for name in CAMPAIGN:
        level = load_round(name)
        bricks, silver, gold = count_bricks(level)
        lines.append(f"{name:{width}}  {bricks:6}  {silver:6}  {gold:4}  {level.comment}")
    return "\n".join(lines)


def terminal_colours(stream: TextIO, environment: Mapping[str, str]) -> int:
    """Return how many colours a stream shows: `LETTERS`, `COLOURS` or `TRUE_COLOURS`."""
    plain = environment.get("NO_COLOR") or environment.get("TERM") == "dumb"
    if plain or not stream.isatty():
        return LETTERS
    if environment.get("COLORTERM") in ("truecolor", "24bit"):
        return TRUE_COLOURS
    return COLOURS


def level_text(level: Round) -> str:
    """Return a level as its file holds it, so that it can be kept and changed."""
    headings = [f"name: {level.name}", f"comment: {level.comment}"]
    if level.boss:
        headings.append("boss: yes")
    rows = ["".join(BRICK_LETTERS[kind] for kind in row) for row in level.kinds]
    while rows and not rows[-1].strip(BRICK_LETTERS[EMPTY]):
        rows.pop()
    return "\n".join([*headings, "", *rows])


def level_in_colours(level: Round, colours: int) -> str:
    """Return a level as a terminal of so many colours shows it, a brick as four characters."""
    bricks, silver, gold = count_bricks(level)
    parts = [f"{bricks} to break", f"{silver} of them silver" if silver else ""]
    parts += [f"{gold} of gold" if gold else "", "the boss" if level.boss else ""]
    rows = ["".join(_cell(int(kind), colours) for kind in row) + _RESET for row in level.kinds]
    head = f"{level.name}: {', '.join(part for part in parts if part)}"
    return "\n".join([head, level.comment, *rows])


def _cell(kind: int, colours: int) -> str:
    """Return one cell of the lattice; metal carries its letter, for eyes that confuse hues."""
    field = PALETTE[FIELD_LOWER]
    if kind == EMPTY:
        return _paint(field, field, colours) + "    "
    body, foot, edge = (PALETTE[row + kind] for row in (BRICK, BRICK_FOOT, BRICK_SHADED))
    face = _paint(body, foot, colours)
    letter = "▀"
    if kind >= SILVER:
        ink = edge * 0.6 if body @ LUMA > _BRIGHT else PALETTE[BRICK]
        letter = _paint(ink, (body + foot) / 2, colours) + BRICK_LETTERS[kind] + face
    # The right edge is shaded, and half a character of field parts it from the next brick.
    return face + "▀" + letter + "▀" + _paint(edge, field, colours) + "▌"


def _paint(ink: Any, paper: Any, colours: int) -> str:
    """Return the escape sequence of a foreground and a background, each [red, green, blue]."""
    return f"\x1b[38;{_code(ink, colours)};48;{_code(paper, colours)}m"


def _code(colour: Any, colours: int) -> str:
    if colours == TRUE_COLOURS:
        return "2;" + ";".join(str(round(channel)) for channel in colour)
    # The cube of 6 x 6 x 6 colours, whose steps are at 0, 95, 135, ... 255.
    red, green, blue = (0 if part < 48 else round((max(part, 95) - 55) / 40) for part in colour)
    return f"5;{16 + 36 * red + 6 * green + blue}"


def draw_levels(
    levels: Sequence[str], difficulty: float = DIFFICULTY, height: int = 512
) -> NDArray[np.uint8]:
    """Return a picture of levels as they begin, side by side in rows, uint8 [height, width, 3].

    Args:
        levels: at least one, as for `find_level`.
        difficulty: of generated ones.
        height: of one level's picture, in pixels.

    Raises:
        OSError, ValueError: see `find_level`.
    """
    # Imported on demand: to list levels needs none of the kernels that play and draw.
    from ..batch.batch import Batch
    from ..draw.picture import draw_world

    everywhere = np.ones(1, np.bool_)
    batch = Batch(1, Config())
    pictures = []
    for level in levels:
        seed = chosen_seed(level)
        options = {"level": level} if seed is None else {"seed": seed, "difficulty": difficulty}
        batch.reset(everywhere, {"level": None, "seed": None} | options)
        pictures.append(draw_world(batch.worlds, batch.rules, 0, height))
    return _arrange(pictures)


def _arrange(pictures: list[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Return pictures of one size as one, in rows, the last of which may be shorter."""
    columns = min(len(pictures), PICTURE_COLUMNS)
    rows = math.ceil(len(pictures) / columns)
    height, width, _ = pictures[0].shape
    down, across = height + _MARGIN, width + _MARGIN
    sheet = np.zeros((rows * down - _MARGIN, columns * across - _MARGIN, 3), np.uint8)
    for index, picture in enumerate(pictures):
        top, left = index // columns * down, index % columns * across
        sheet[top : top + height, left : left + width] = picture
    return sheet
