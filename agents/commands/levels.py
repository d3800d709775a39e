"""`arkanoid levels`: the named rounds as a list; any level in the terminal or as a PNG."""

import argparse
import os
import sys

from ..experiment.schema import SettingsError

SUMMARY = "list the named levels, or draw any level"

_EPILOG = """\
LEVEL is the name of a named round, the path of a level file, or seed:N for a generated level.

  arkanoid levels                                   the named rounds
  arkanoid levels spiral                            draws one
  arkanoid levels seed:7 --difficulty 0.8           draws a generated one
  arkanoid levels spiral > mine.txt                 writes its file, to be changed
  arkanoid levels mine.txt --png mine.png           draws your own into a picture
  arkanoid play --level mine.txt                    and plays it

In a terminal that has colours a level is drawn in them; elsewhere it is written as its file."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.add_argument("levels", metavar="LEVEL", nargs="*", help="name, file or seed:N")
    parser.add_argument(
        "--difficulty",
        type=float,
        metavar="D",
        help="of generated levels, from 0 to 1 (default: 0.5)",
    )
    parser.add_argument(
        "--png",
        metavar="OUT",
        help="write a picture of the levels instead; without LEVEL, of all named rounds",
    )
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Print or draw; return the exit status."""
    # With the game come the kernels, and Numba, which is slow to import.
    from ...envs.play.gallery import DIFFICULTY, list_levels

    difficulty = DIFFICULTY if arguments.difficulty is None else arguments.difficulty
    try:
        if arguments.png is not None:
            _draw(arguments.levels, difficulty, arguments.png)
        elif arguments.levels:
            _print(arguments.levels, difficulty)
        else:
            print(list_levels())
            print("\nto draw one: arkanoid levels NAME; a generated one: arkanoid levels seed:7")
    except OSError as error:
        raise SettingsError(f"{error.filename}: {error.strerror}") from None
    except ValueError as error:
        raise SettingsError(str(error)) from None
    return 0


def _print(names: list[str], difficulty: float) -> None:
    """Draw levels in the terminal, or write them as their files."""
    from ...envs.play.gallery import (
        LETTERS,
        find_level,
        level_in_colours,
        level_text,
        terminal_colours,
    )

    levels = [find_level(name, difficulty) for name in names]
    colours = terminal_colours(sys.stdout, os.environ)
    if colours == LETTERS:
        print("\n\n".join(map(level_text, levels)))
    else:
        print("\n\n".join(level_in_colours(level, colours) for level in levels))


def _draw(names: list[str], difficulty: float, path: str) -> None:
    """Write a picture of levels into a file."""
    from ...envs.draw.png import write_png
    from ...envs.levels.files import CAMPAIGN
    from ...envs.play.gallery import draw_levels

    write_png(path, draw_levels(names or CAMPAIGN, difficulty))
    print(path)
