"""`arkanoid film [MODEL] OUT`: a film of an agent at play; no display is needed."""

import argparse
import math
from pathlib import Path

from ..experiment.errors import SettingsError
from .arguments import add_level, add_model


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = (
        "%(prog)s [MODEL] OUT.mp4|OUT.gif [--level LEVEL] [--seconds S] [--trust] [--key value ...]"
    )
    add_model(parser)
    parser.add_argument("out", metavar="OUT", help="the file, .mp4 or .gif")
    add_level(parser)
    parser.add_argument(
        "--seconds", type=float, help="of the game; default: evaluation.film_seconds"
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Write the film; return the exit status."""
    from ..experiment.runs import ModelFile

    model = ModelFile.find(arguments.model, arguments.trust)
    experiment = model.run.experiment(overrides)
    out = Path(arguments.out)
    if arguments.seconds is not None and not 0 < arguments.seconds < math.inf:
        raise SettingsError(f"--seconds must be a number above 0, not {arguments.seconds}")
    from ..measure.suites import WHOLE_GAMES, find_starts
    from ..show.frames import film_policy

    start = find_starts(experiment, arguments.level)[0] if arguments.level else WHOLE_GAMES
    from ..learn.model import load_policy

    try:
        film_policy(experiment, load_policy(model, experiment), out, start, arguments.seconds)
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {error}") from None
    print(out)
    return 0
