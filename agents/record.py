"""`arkanoid record [MODEL] OUT`: a clip of an agent at play; no display is needed."""

import argparse
import sys
from pathlib import Path

from .runs import ModelFile
from .schema import SettingsError

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


def add_model(parser: argparse.ArgumentParser) -> None:
    """Describe the argument that names a model to ``parser``."""
    parser.add_argument(
        "model",
        metavar="MODEL",
        nargs="?",
        help="the folder of a run or a model file in one; default: the agent that comes with the "
        "package",
    )


def add_level(parser: argparse.ArgumentParser) -> None:
    """Describe the option that names a level to ``parser``."""
    parser.add_argument(
        "--level",
        help="where the game begins: a round's name, a level file or seeds:N-N; "
        "default: as in the training",
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Record; return the exit status."""
    model = ModelFile.find(arguments.model)
    experiment = model.run.experiment(overrides)
    out = Path(arguments.out)
    if arguments.seconds is not None and not arguments.seconds > 0:
        raise SettingsError(f"--seconds must be positive, not {arguments.seconds}")
    from .levels import find_starts
    from .recording import record_clip

    start = find_starts(experiment, arguments.level)[0] if arguments.level else None
    from .learning import load_policy

    try:
        record_clip(experiment, load_policy(model.path, experiment), out, start, arguments.seconds)
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {error}") from None
    print(out)
    return 0


if __name__ == "__main__":
    from .cli import main

    sys.exit(main(["record", *sys.argv[1:]]))
