"""Levels to look at: a list, text for terminals and files, and pictures."""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from ..config import Config
from ..draw.palette import BRICK_BODY, BRICK_FOOT, BRICK_SHADED, FIELD_LOWER, LUMA, PALETTE
from ..levels import CAMPAIGN, Level, generate_level, load_level
from ..levels.generator import MAX_SEED
from ..rules import BRICK_LETTERS, EMPTY, GOLD, SILVER

# The difficulty of a level when only its seed is given.
DIFFICULTY = 0.5

# How many colours a terminal shows.
NO_COLOURS = 0
COLOURS_256 = 256
TRUE_COLOURS = 1 << 24

PICTURE_COLUMNS = 5  # pictures side by side
_MARGIN = 8  # pixels between them

_SEED = re.compile(r"seed:(\d{1,19})")
_RESET = "\x1b[0m"
_BRIGHT = 110.0  # a brick that is brighter has a dark letter


def parse_seed(level: str) -> int | None:
    """Return the seed in a text like ``seed:7``; None if the text does not begin with ``seed:``.

    Raises:
        ValueError: what follows is no legal seed.
    """
    if not level.startswith("seed:"):
        return None
    match = _SEED.fullmatch(level)
    if match is None or int(match[1]) > MAX_SEED:
        raise ValueError(
            f"a generated level needs a seed from 0 to {MAX_SEED}, as in seed:7; got {level!r}"
        )
    return int(match[1])


def load_or_generate(level: str, difficulty: float = DIFFICULTY) -> Level:
    """Return the level with a name, the path of a file, or a seed like ``seed:7``.

    Raises:
        OSError, ValueError: there is no such level, or its file cannot be read or is malformed.
    """
    seed = parse_seed(level)
    if seed is not None:
        return generate_level(seed, difficulty=difficulty)
    return load_level(level)


def count_bricks(level: Level) -> tuple[int, int, int]:
    """Return the numbers of breakable bricks, of silver ones among them, and of golden bricks."""
    kinds = level.kinds
    breakable = int(((kinds != EMPTY) & (kinds != GOLD)).sum())
    return breakable, int((kinds == SILVER).sum()), int((kinds == GOLD).sum())


def list_levels() -> str:
    """Return a table of the named levels."""
    width = max(map(len, CAMPAIGN))
    lines = [f"{'name':{width}}  bricks  silver  gold"]
    for name in CAMPAIGN:
        level = load_level(name)
        bricks, silver, gold = count_bricks(level)
        lines.append(f"{name:{width}}  {bricks:6}  {silver:6}  {gold:4}  {level.comment}")
    return "\n".join(lines)


def terminal_colours(stream: TextIO, environment: Mapping[str, str]) -> int:
    """Return how many colours a stream can show, as one of the constants above."""
    plain = environment.get("NO_COLOR") or environment.get("TERM") == "dumb"
    if plain or not stream.isatty():
        return NO_COLOURS
    if environment.get("COLORTERM") in ("truecolor", "24bit"):
        return TRUE_COLOURS
    return COLOURS_256


def level_text(level: Level) -> str:
    """Return a level as the text of a level file."""
    headings = [f"name: {level.name}"]
    if level.comment:
        headings.append(f"comment: {level.comment}")
    if level.boss:
        headings.append("boss: yes")
    rows = ["".join(BRICK_LETTERS[kind] for kind in row) for row in level.kinds]
    while rows and not rows[-1].strip(BRICK_LETTERS[EMPTY]):
        rows.pop()
    return "\n".join([*headings, "", *rows])


def level_in_colours(level: Level, colours: int) -> str:
    """Return a level for a terminal with so many colours, each cell as four characters."""
    bricks, silver, gold = count_bricks(level)
    parts = [f"{bricks} to break", f"{silver} of them silver" if silver else ""]
    parts += [f"{gold} of gold" if gold else "", "the boss" if level.boss else ""]
    rows = ["".join(_cell(int(kind), colours) for kind in row) + _RESET for row in level.kinds]
    head = f"{level.name}: {', '.join(part for part in parts if part)}"
    return "\n".join([head, *([level.comment] if level.comment else []), *rows])


def _cell(kind: int, colours: int) -> str:
    """Return a cell; metal carries its letter, for players who confuse its colours."""
    field = PALETTE[FIELD_LOWER]
    if kind == EMPTY:
        return _paint(field, field, colours) + "    "
    body, foot, edge = (PALETTE[row + kind] for row in (BRICK_BODY, BRICK_FOOT, BRICK_SHADED))
    face = _paint(body, foot, colours)
    letter = "▀"
    if kind >= SILVER:
        ink = edge * 0.6 if body @ LUMA > _BRIGHT else PALETTE[BRICK_BODY]
        letter = _paint(ink, (body + foot) / 2, colours) + BRICK_LETTERS[kind] + face
    # The right edge is shaded, and half a character of field separates the next brick.
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
    """Return a picture of levels, side by side in rows, uint8 [height, width, 3].

    Args:
        levels: at least one, as for `load_or_generate`.
        difficulty: of generated levels.
        height: the height of one level's picture, in pixels.

    Raises:
        OSError, ValueError: see `load_or_generate`.
    """
    # Imported on demand: a list of levels needs none of the kernels that play and draw.
    from ..batch.batch import Batch
    from ..draw.picture import draw_world

    all_worlds = np.ones(1, np.bool_)
    batch = Batch(1, Config())
    pictures = []
    for level in levels:
        seed = parse_seed(level)
        options = {"level": level} if seed is None else {"seed": seed, "difficulty": difficulty}
        batch.reset(all_worlds, {"level": None, "seed": None} | options)
        pictures.append(draw_world(batch.worlds, batch.rules, 0, height))
    return _arrange(pictures)


def _arrange(pictures: list[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Join pictures of one size into one, in rows; the last row may be shorter."""
    columns = min(len(pictures), PICTURE_COLUMNS)
    rows = math.ceil(len(pictures) / columns)
    height, width, _ = pictures[0].shape
    down, across = height + _MARGIN, width + _MARGIN
    sheet = np.zeros((rows * down - _MARGIN, columns * across - _MARGIN, 3), np.uint8)
    for index, picture in enumerate(pictures):
        top, left = index // columns * down, index % columns * across
        sheet[top : top + height, left : left + width] = picture
    return sheet
