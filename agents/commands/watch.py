"""`arkanoid watch [MODEL]`: shows an agent at play in a window."""

import argparse
from pathlib import Path

from ..experiment.programs import arkanoid
from .arguments import add_level, add_model
from .screen import require_screen


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s [MODEL] [--level LEVEL] [--trust] [--key value ...]"
    add_model(parser)
    add_level(parser)
    parser.epilog = (
        "The evaluation's games follow each other, on the levels in turn, until you close the\n"
        "window."
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Show games until the window is closed; return the exit status."""
    from ..experiment.runs import ModelFile

    model = ModelFile.find(arguments.model, arguments.trust)
    experiment = model.experiment(overrides)
    named = [Path(arguments.model)] if arguments.model else []
    require_screen(f"a film needs none: {arkanoid('film', *named, 'game.gif')}")
    from ...envs.play.window import Window
    from ..measure.suites import WHOLE_GAMES, find_starts

    starts = find_starts(experiment, arguments.level) if arguments.level else (WHOLE_GAMES,)
    from ..learn.model import load_policy
    from ..show.frames import can_be_smooth, frame_rate, play_frames

    policy = load_policy(model, experiment)
    smooth = can_be_smooth(experiment)
    window = Window("Arkanoid", frame_rate(experiment, smooth))
    try:
        episode = 0
        while not window.closed:
            frame, start = None, starts[episode % len(starts)]
            for frame in play_frames(experiment, policy, start, smooth, episode):
                if not window.show(frame.picture):
                    break
            if frame is not None:
                print(f"game {episode + 1}: score {frame.score}, round {frame.round}")
            episode += 1
    finally:
        window.close()
    return 0
