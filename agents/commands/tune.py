"""`arkanoid tune CONFIG [--space SPACE] [--trials N]`: searches for hyper-parameters."""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from ..experiment.errors import SettingsError

DEFAULT_SPACE = "ppo"
DEFAULT_TRIALS = 30


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = (
        "%(prog)s CONFIG [--space SPACE] [--trials N] [--budget SECONDS] [--jobs N] "
        "[--study FOLDER] [--key value ...]"
    )
    parser.add_argument("config", metavar="CONFIG", help="TOML file or packaged config")
    parser.add_argument(
        "--space",
        default=DEFAULT_SPACE,
        help=f"TOML file or packaged search space; default: {DEFAULT_SPACE}",
    )
    parser.add_argument(
        "--trials", type=int, default=DEFAULT_TRIALS, help=f"default: {DEFAULT_TRIALS}"
    )
    parser.add_argument(
        "--budget",
        type=float,
        help="processor seconds of each trial's training; default: the space's",
    )
    parser.add_argument(
        "--jobs", type=int, help="trials that run at the same time; default: one for each core"
    )
    parser.add_argument("--study", help="the study's folder; default: OUTPUT/NAME-tune")
    parser.epilog = (
        "The same command resumes a study that was stopped; several processes may share a study.\n"
        "CONFIG says how trials are trained, and its [validation] on what they are measured. Each\n"
        "trains for the same processor time, on one core. The best settings are printed as TOML."
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Search and print the best; return the exit status."""
    from ..experiment.settings import load_experiment
    from ..learn.search.space import check_budget, load_space
    from ..learn.search.study import best_as_toml, open_study
    from ..learn.search.trials import Search
    from ..learn.search.workers import run_search, usable_cores

    experiment = load_experiment(arguments.config, overrides)
    space = load_space(arguments.space)
    if arguments.budget is not None:
        space = replace(space, budget=check_budget(arguments.budget, "--budget"))
    _check(overrides, arguments)
    jobs = usable_cores() if arguments.jobs is None else arguments.jobs
    folder = Path(arguments.study or Path(experiment.output) / f"{experiment.name}-tune")
    study = open_study(folder, space, experiment.seed)
    print(f"study    {folder}, {len(study.trials)} trials so far", flush=True)
    search = Search(arguments.config, tuple(overrides), space, folder, experiment.seed)
    try:
        run_search(search, arguments.trials, jobs)
    except KeyboardInterrupt:
        print("stopped; the same command resumes the search", file=sys.stderr)
        return 130
    print(best_as_toml(study, space), end="")
    return 0


def _check(overrides: list[tuple[str, str]], arguments: argparse.Namespace) -> None:
    """Refuse what a search decides by itself, and counts that are none."""
    for key, _ in overrides:
        if key in ("training.timesteps", "validation.every"):
            raise SettingsError(
                f"{key!r} follows from the time that a trial has: give --budget (processor "
                f"seconds), or 'budget' and 'measurements' of the search space"
            )
    for name in ("trials", "jobs"):
        count = getattr(arguments, name)
        if count is not None and count < 1:
            raise SettingsError(f"--{name} must be at least 1, not {count}")
