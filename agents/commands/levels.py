"""`arkanoid levels`: lists the named levels; draws any level in the terminal or as a PNG."""

import argparse
import os
import sys
import textwrap
from pathlib import Path

from ...envs.atomic import write_atomically
from ..experiment.errors import SettingsError
from ..experiment.files import check_picture, level_mistake
from ..experiment.programs import arkanoid
from .arguments import LEVELS, NAMED, check_difficulty, number, output_width

_MOST = 100  # levels that are shown at once
_WIDTH = 44  # of a level in colours
_LEAST = 30  # letters in a line that make a column of comments readable

_EPILOG = """\
  arkanoid levels                           lists the named levels
  arkanoid levels spiral                    draws one
  arkanoid levels seed:7 --difficulty 0.8   draws a generated one
  arkanoid levels spiral > mine.txt         writes its file: change it
  arkanoid levels mine.txt --png mine.png   draws your own as a picture
  arkanoid play --level mine.txt            and plays it

A terminal with colours, and with 44 columns, shows a level in them; elsewhere the level's file is
printed."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument("levels", metavar="LEVEL", nargs="*", help=LEVELS)
    parser.add_argument(
        "--difficulty",
        type=number(0.0, 1.0),
        metavar="D",
        help="of generated levels, from 0 to 1 (default: 0.5)",
    )
    parser.add_argument(
        "--png",
        metavar="OUT",
        help="write a picture of the levels instead; without LEVEL, of all named levels",
    )
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Print or draw; return the exit status."""
    if arguments.png is not None:
        check_picture(Path(arguments.png))
    # The game imports Numba, which is slow.
    from ...envs.play.gallery import DIFFICULTY, list_levels

    difficulty = DIFFICULTY if arguments.difficulty is None else arguments.difficulty
    try:
        each = _each(arguments.levels or [NAMED])
        if arguments.difficulty is not None:
            check_difficulty(each)
        if arguments.png is not None:
            _draw(each, difficulty, Path(arguments.png))
        elif arguments.levels:
            _print(each, difficulty)
        else:
            print(_folded(list_levels()) if sys.stdout.isatty() else list_levels())
            print(f"\nto draw one: {arkanoid('levels spiral')}")
            print(f"a generated one: {arkanoid('levels seed:7')}")
    except OSError as error:
        raise SettingsError(f"{error.filename}: {error.strerror}") from None
    except ValueError as error:
        raise SettingsError(level_mistake("", error)) from None
    return 0


def _folded(table: str) -> str:
    """Return a table whose last column, which has no heading, fits the terminal."""
    width = output_width()
    heading, *rows = table.splitlines()
    place = len(heading) + 2
    lines = [heading]
    for row in rows:
        if width - place >= _LEAST:
            folded = textwrap.wrap(row[place:], width - place) or [""]
            lines.append(row[:place] + f"\n{' ' * place}".join(folded))
        else:
            lines += [
                row[:place].rstrip(),
                textwrap.indent(textwrap.fill(row[place:], width - 2), "  "),
            ]
    return "\n".join(lines)


def _each(names: list[str]) -> list[str]:
    """Return levels one by one: ``seed:N`` for each generated one, and the named ones."""
    from ...envs.levels.files import CAMPAIGN
    from ...envs.levels.plan import seed_range

    each: list[str] = []
    for name in names:
        seeds = None if name == NAMED else seed_range(name)
        if seeds is not None and seeds.stop - seeds.start > _MOST:
            raise SettingsError(
                f"{name} are {seeds.stop - seeds.start:,} levels; at most {_MOST} are shown at "
                f"once, as in seeds:{seeds.start}-{seeds.start + _MOST - 1}"
            )
        if name == NAMED:
            each += CAMPAIGN
        else:
            each += [name] if seeds is None else [f"seed:{seed}" for seed in seeds]
    return each


def _print(names: list[str], difficulty: float) -> None:
    """Draw levels in the terminal, or print their files."""
    from ...envs.play.gallery import (
        NO_COLOURS,
        level_in_colours,
        level_text,
        load_or_generate,
        terminal_colours,
    )

    levels = [load_or_generate(name, difficulty) for name in names]
    colours = terminal_colours(sys.stdout, os.environ)
    if colours == NO_COLOURS or output_width() < _WIDTH:
        print("\n\n".join(map(level_text, levels)))
    else:
        print("\n\n".join(level_in_colours(level, colours) for level in levels))


def _draw(names: list[str], difficulty: float, path: Path) -> None:
    """Write a picture of levels into a file."""
    from ...envs.draw.png import png_bytes
    from ...envs.play.gallery import draw_levels

    write_atomically(path, png_bytes(draw_levels(names, difficulty)))
    print(path)
