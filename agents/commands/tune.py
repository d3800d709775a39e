"""`arkanoid tune CONFIG [--space SPACE] [--trials N]`: searches for hyper-parameters."""

import argparse
import sys
from pathlib import Path

from ..experiment.errors import SettingsError

DEFAULT_SPACE = "ppo"
DEFAULT_TRIALS = 30


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s CONFIG [--space SPACE] [--trials N] [--study FOLDER] [--key value ...]"
    parser.add_argument("config", metavar="CONFIG", help="TOML file or packaged config")
    parser.add_argument(
        "--space",
        default=DEFAULT_SPACE,
        help=f"TOML file or packaged search space; default: {DEFAULT_SPACE}",
    )
    parser.add_argument(
        "--trials", type=int, default=DEFAULT_TRIALS, help=f"default: {DEFAULT_TRIALS}"
    )
    parser.add_argument("--study", help="the study's folder; default: OUTPUT/NAME-tune")
    parser.epilog = (
        "The same command resumes a study that was stopped; several processes may share a study.\n"
        "CONFIG says how trials are trained, its [validation] judges them; the best settings are\n"
        "printed as TOML."
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Search and print the best; return the exit status."""
    from ..experiment.settings import load_experiment
    from ..learn.tuning import best_as_toml, load_space, open_study, search

    experiment = load_experiment(arguments.config, overrides)
    space = load_space(arguments.space)
    if not experiment.validation.every:
        raise SettingsError(
            f"{arguments.config}: validation judges the trials, and it is off: set "
            f"'validation.every' (decisions between two measurements)"
        )
    if arguments.trials < 1:
        raise SettingsError(f"--trials must be at least 1, not {arguments.trials}")
    folder = Path(arguments.study or Path(experiment.output) / f"{experiment.name}-tune")
    study = open_study(folder, space, experiment.seed)
    print(f"study    {folder}, {len(study.trials)} trials so far")
    try:
        search(study, space, arguments.config, overrides, folder, arguments.trials)
    except KeyboardInterrupt:
        print("stopped; the same command resumes the search", file=sys.stderr)
        return 130
    print(best_as_toml(study, space), end="")
    return 0
