"""Arguments that several commands take; this module is not a command."""

import argparse


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add the argument that names a model."""
    parser.add_argument(
        "model",
        metavar="MODEL",
        nargs="?",
        help="the folder of a run or a model file in one; default: the agent that comes with the "
        "package",
    )


def add_level(parser: argparse.ArgumentParser) -> None:
    """Add the option that names a level."""
    parser.add_argument(
        "--level",
        help="where the game begins: a level's name, a level file or seeds:N-N; "
        "default: as in the training",
    )
