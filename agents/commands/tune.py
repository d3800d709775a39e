"""`arkanoid tune CONFIG [--space SPACE] [--trials N]`: searches for hyper-parameters."""

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...envs.atomic import write_atomically
from ...envs.checks import counted
from ..experiment.errors import SettingsError
from ..experiment.files import cause, check_folder, check_new_folder
from ..experiment.programs import arkanoid
from .arguments import positive, whole

if TYPE_CHECKING:
    from ..experiment.settings import Experiment

DEFAULT_SPACE = "ppo"
DEFAULT_TRIALS = 30


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = (
        "%(prog)s CONFIG [--space SPACE] [--trials N] [--budget SECONDS] [--jobs N] "
        "[--study FOLDER] [--out FILE.toml] [--key value ...]"
    )
    parser.add_argument("config", metavar="CONFIG", help="TOML file or packaged config")
    parser.add_argument(
        "--space",
        default=DEFAULT_SPACE,
        help=f"TOML file or packaged search space; default: {DEFAULT_SPACE}",
    )
    parser.add_argument(
        "--trials", type=whole(1), default=DEFAULT_TRIALS, help=f"default: {DEFAULT_TRIALS}"
    )
    parser.add_argument(
        "--budget",
        type=positive,
        help="processor seconds of each trial's training; default: the space's",
    )
    parser.add_argument(
        "--jobs", type=whole(1), help="trials that run at the same time; default: one for each core"
    )
    parser.add_argument(
        "--out", metavar="FILE.toml", help="write CONFIG with the best settings into this file, too"
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

    out = None if arguments.out is None else Path(arguments.out)
    experiment = load_experiment(arguments.config, overrides)
    space = load_space(arguments.space)
    if arguments.budget is not None:
        space = replace(space, budget=check_budget(arguments.budget, "--budget"))
    _check(overrides)
    folder = Path(arguments.study or Path(experiment.output) / f"{experiment.name}-tune")
    check_new_folder(folder)
    if out is not None:
        check_folder(out)
    # Only now, with all settings known to be right, come the slow imports.
    from ..learn.search.study import best_as_toml, open_study
    from ..learn.search.trials import Search
    from ..learn.search.workers import run_search, usable_cores

    jobs = usable_cores() if arguments.jobs is None else arguments.jobs
    study = open_study(folder, space, experiment.seed)
    print(f"study    {folder}, {counted(len(study.trials), 'trial')} so far", flush=True)
    search = Search(arguments.config, tuple(overrides), space, folder, experiment.seed)
    try:
        run_search(search, arguments.trials, jobs)
    except KeyboardInterrupt:
        print("stopped; the same command resumes the search", file=sys.stderr)
        return 130
    best = best_as_toml(study, space)
    print(best, end="")
    if out is not None:
        _write(out, experiment, best)
        print(f"train    {arkanoid('train', out)}")
    return 0


def _write(out: Path, experiment: "Experiment", best: str) -> None:
    """Write an experiment with the best settings instead of its own."""
    from ..experiment.reading import parse_toml, read_settings, to_toml
    from ..experiment.settings import Experiment

    table = parse_toml(to_toml(experiment))
    for key, value in parse_toml(best).items():
        table[key] = table[key] | value if isinstance(value, dict) else value
    head = best.partition("\n")[0]
    text = to_toml(read_settings(Experiment, table, str(out)))
    try:
        write_atomically(out, f"{head}\n{text}".encode())
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {cause(error)}") from None


def _check(overrides: list[tuple[str, str]]) -> None:
    """Refuse what a search decides by itself."""
    for key, _ in overrides:
        if key in ("training.timesteps", "validation.every"):
            raise SettingsError(
                f"{key!r} follows from the time that a trial has: give --budget (processor "
                f"seconds), or 'budget' and 'measurements' of the search space"
            )
