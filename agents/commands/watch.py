"""`arkanoid watch [MODEL]`: shows an agent at play in a window, or in a browser."""

import argparse
from pathlib import Path

from ..experiment.errors import SettingsError
from ..experiment.files import quoted
from ..experiment.programs import arkanoid
from .arguments import PLAYED, add_level, add_model, check_settings
from .screen import require_screen
from .web import Wanted, add_serving, serve

# The settings that a page knows: its games have seeds of their own, and it takes likeliest actions.
_IN_A_PAGE = ("env_id", "env")
_EPILOG = """\
The evaluation's games follow each other, on the levels in turn, until you close the window.

keys in the window: space or P pause, + faster, - slower, N next game, R from the start,
F fill the screen, Esc quit

With --web a page shows the agent in a browser, also in that of another computer. It follows a run
while that is trained: its curves, and its latest agent.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = (
        "%(prog)s [MODEL] [--level LEVEL] [--web [--port N] [--no-open]] [--trust] "
        "[--key value ...]"
    )
    add_model(parser)
    add_level(parser)
    parser.add_argument("--web", action="store_true", help="show it in a browser, not in a window")
    add_serving(parser)
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Show games until the window is closed; return the exit status (130 after Ctrl-C)."""
    if arguments.web:
        check_settings(overrides, _IN_A_PAGE)
        wanted = Wanted(arguments.model, arguments.trust, overrides, arguments.level)
        return serve(arguments, wanted)
    if arguments.port is not None or arguments.no_open:
        raise SettingsError("--port and --no-open are of a page: add --web")
    from ..experiment.runs import ModelFile

    check_settings(overrides, PLAYED)
    model = ModelFile.find(arguments.model, arguments.trust)
    experiment = model.experiment(overrides)
    named = [Path(arguments.model)] if arguments.model else []
    level = ["--level", quoted(arguments.level)] if arguments.level else []
    from ..measure.suites import WHOLE_GAMES, find_starts

    # A level that is wrong must not be part of the command that works without a screen.
    starts = find_starts(experiment, arguments.level) if arguments.level else (WHOLE_GAMES,)
    require_screen(_without_screen(named, level))
    from ...envs.play.show import run_show
    from ..learn.model import load_policy
    from ..show.frames import Frame
    from ..show.watching import WATCH_KEYS, Watching

    def report(game: int, frame: Frame) -> None:
        print(f"game {game}: score {frame.score}, round {frame.round}")

    show = Watching(experiment, load_policy(model, experiment), starts, report)
    return 130 if run_show(show, f"Arkanoid - {WATCH_KEYS}") else 0


def _without_screen(named: list[Path], level: list[str]) -> str:
    """Return which commands show the same without a screen."""
    from ...envs.browser.shipped import offers_module

    film = f"a film needs none: {arkanoid('film', *named, 'game.gif', *level)}"
    if not offers_module():
        return film
    page = arkanoid("watch", *named, "--web", "--no-open", *level)
    return f"{film}; nor does a browser: {page}"
