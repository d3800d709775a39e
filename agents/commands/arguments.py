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
    add_trust(parser)


def add_level(parser: argparse.ArgumentParser) -> None:
    """Add the option that names a level."""
    parser.add_argument(
        "--level",
        help="where the game begins: a level's name, a level file or seeds:N-N; "
        "default: as in the training",
    )


def add_trust(parser: argparse.ArgumentParser) -> None:
    """Add the option that trusts a run's author."""
    parser.add_argument(
        "--trust",
        action="store_true",
        help="trust the author of the run: import the module that its env_id names, and let "
        "stable-baselines3 unpickle its model, with any network; both can run any command on this "
        "computer. Without --trust no code in a run is run",
    )
