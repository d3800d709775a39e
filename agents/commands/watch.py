"""`arkanoid watch [MODEL]`: an agent at play in a window."""

import argparse
import sys

from ..experiment.runs import ModelFile
from .arguments import add_level, add_model

SUMMARY = "watch an agent play in a window"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.usage = "%(prog)s [MODEL] [--level LEVEL] [--key value ...]"
    add_model(parser)
    add_level(parser)
    parser.epilog = (
        "Games follow each other, with the evaluation's seeds, until the window is closed."
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Show games until the window is closed; return the exit status."""
    model = ModelFile.find(arguments.model)
    experiment = model.run.experiment(overrides)
    from gymnasium.error import DependencyNotInstalled

    from ...envs.play.window import Window
    from ..measure.suites import find_starts

    start = find_starts(experiment, arguments.level)[0] if arguments.level else None
    from ..experiment.settings import seeded
    from ..learn.model import load_policy
    from ..show.clips import can_be_smooth, frame_rate, play_frames

    policy = load_policy(model.path, experiment)
    smooth = can_be_smooth(experiment)
    try:
        window = Window("Arkanoid", frame_rate(experiment, smooth))
    except DependencyNotInstalled as error:
        print(f"arkanoid: error: {error}", file=sys.stderr)
        return 1
    try:
        seed = experiment.evaluation.seed
        while not window.closed:
            frame = None
            for frame in play_frames(seeded(experiment, seed), policy, start, smooth):
                if not window.show(frame.picture):
                    break
            if frame is not None:
                print(f"seed {seed}: score {frame.score}, round {frame.round}")
            seed += 1
    finally:
        window.close()
    return 0
