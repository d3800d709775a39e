"""`arkanoid record [MODEL] OUT`: a clip of an agent at play; no display is needed."""

import argparse
from pathlib import Path

from ..experiment.runs import ModelFile
from ..experiment.schema import SettingsError
from .arguments import add_level, add_model

SUMMARY = "write a clip of an agent at play"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.usage = (
        "%(prog)s [MODEL] OUT.mp4|OUT.gif [--level LEVEL] [--seconds S] [--key value ...]"
    )
    add_model(parser)
    parser.add_argument("out", metavar="OUT", help="the file, .mp4 or .gif")
    add_level(parser)
    parser.add_argument(
        "--seconds", type=float, help="of the game; default: evaluation.clip_seconds"
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Record; return the exit status."""
    model = ModelFile.find(arguments.model)
    experiment = model.run.experiment(overrides)
    out = Path(arguments.out)
    if arguments.seconds is not None and not arguments.seconds > 0:
        raise SettingsError(f"--seconds must be positive, not {arguments.seconds}")
    from ..measure.suites import find_starts
    from ..show.clips import record_clip

    start = find_starts(experiment, arguments.level)[0] if arguments.level else None
    from ..learn.model import load_policy

    try:
        record_clip(experiment, load_policy(model.path, experiment), out, start, arguments.seconds)
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {error}") from None
    print(out)
    return 0
