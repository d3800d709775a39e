"""`arkanoid film [MODEL] OUT`: writes a film of an agent at play; no display is needed."""

import argparse
from pathlib import Path

from ..experiment.errors import SettingsError
from ..experiment.files import cause
from .arguments import LEVEL, PLAYED, add_model, check_settings, positive


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = (
        "%(prog)s [MODEL] OUT.mp4|OUT.gif [--level LEVEL] [--seconds S] [--trust] [--key value ...]"
    )
    add_model(parser)
    parser.add_argument("out", metavar="OUT", nargs="?", help="the file, .mp4 or .gif")
    parser.add_argument(
        "--out", dest="option", metavar="OUT", help="the same, as other commands name their file"
    )
    parser.add_argument("--level", help=f"{LEVEL}; default: as in the training")
    parser.add_argument(
        "--seconds", type=positive, help="of the game; default: evaluation.film_seconds"
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Write the film; return the exit status."""
    from ..experiment.runs import ModelFile
    from ..show.film import check_film

    name, out = _model_and_out(arguments)
    check_film(out)
    check_settings(overrides, (*PLAYED, "evaluation.film_seconds"))
    model = ModelFile.find(name, arguments.trust)
    experiment = model.experiment(overrides)
    from ..measure.suites import WHOLE_GAMES, find_starts

    starts = find_starts(experiment, arguments.level) if arguments.level else (WHOLE_GAMES,)
    start, *others = starts
    if others:
        raise SettingsError(
            f"{arguments.level} are {len(starts)} levels, and a film shows one of them: name it"
        )
    from ..learn.model import load_policy
    from ..show.frames import film_policy

    try:
        film_policy(experiment, load_policy(model, experiment), out, start, arguments.seconds)
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {cause(error)}") from None
    print(out)
    return 0


def _model_and_out(arguments: argparse.Namespace) -> tuple[str | None, Path]:
    """Return the model's name, None if there is none, and the film's path."""
    *models, out = [
        word for word in (arguments.model, arguments.out, arguments.option) if word is not None
    ] or [None]
    if out is None:
        raise SettingsError("OUT is missing: name the film, .mp4 or .gif")
    if len(models) > 1:
        raise SettingsError(f"two films are named, {models[1]} and {out}: give one")
    return next(iter(models), None), Path(out)
