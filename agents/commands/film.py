"""`arkanoid film [MODEL] OUT`: a film of an agent at play; no display is needed."""

import argparse
from pathlib import Path

from ..experiment.errors import SettingsError
from .arguments import add_level, add_model, positive


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = (
        "%(prog)s [MODEL] OUT.mp4|OUT.gif [--level LEVEL] [--seconds S] [--trust] [--key value ...]"
    )
    add_model(parser)
    parser.add_argument("out", metavar="OUT", help="the file, .mp4 or .gif")
    add_level(parser)
    parser.add_argument(
        "--seconds", type=positive, help="of the game; default: evaluation.film_seconds"
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Write the film; return the exit status."""
    from ..experiment.runs import ModelFile
    from ..show.film import check_film

    out = Path(arguments.out)
    check_film(out)
    model = ModelFile.find(arguments.model, arguments.trust)
    experiment = model.experiment(overrides)
    from ..measure.suites import WHOLE_GAMES, find_starts

    start = find_starts(experiment, arguments.level)[0] if arguments.level else WHOLE_GAMES
    from ..learn.model import load_policy
    from ..show.frames import film_policy

    try:
        film_policy(experiment, load_policy(model, experiment), out, start, arguments.seconds)
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {error}") from None
    print(out)
    return 0
