"""`arkanoid watch [MODEL]`: shows an agent at play in a window."""

import argparse
from pathlib import Path

from ..experiment.files import quoted
from ..experiment.programs import arkanoid
from .arguments import PLAYED, add_level, add_model, check_settings
from .screen import require_screen

_EPILOG = """\
The evaluation's games follow each other, on the levels in turn, until you close the window.

keys in the window: space or P pause, + faster, - slower, N next game, R from the start,
F fill the screen, Esc quit
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s [MODEL] [--level LEVEL] [--trust] [--key value ...]"
    add_model(parser)
    add_level(parser)
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Show games until the window is closed; return the exit status (130 after Ctrl-C)."""
    from ..experiment.runs import ModelFile

    check_settings(overrides, PLAYED)
    model = ModelFile.find(arguments.model, arguments.trust)
    experiment = model.experiment(overrides)
    named = [Path(arguments.model)] if arguments.model else []
    level = ["--level", quoted(arguments.level)] if arguments.level else []
    require_screen(f"a film needs none: {arkanoid('film', *named, 'game.gif', *level)}")
    from ...envs.play.show import run_show
    from ..measure.suites import WHOLE_GAMES, find_starts

    starts = find_starts(experiment, arguments.level) if arguments.level else (WHOLE_GAMES,)
    from ..learn.model import load_policy
    from ..show.frames import Frame
    from ..show.watching import WATCH_KEYS, Watching

    def report(game: int, frame: Frame) -> None:
        print(f"game {game}: score {frame.score}, round {frame.round}")

    show = Watching(experiment, load_policy(model, experiment), starts, report)
    return 130 if run_show(show, f"Arkanoid - {WATCH_KEYS}") else 0
