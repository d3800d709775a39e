"""`arkanoid train CONFIG [--key value ...]`: trains PPO and says how good it is."""

import argparse
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...envs.atomic import write_atomically
from ..experiment.errors import SettingsError
from ..experiment.files import quoted
from ..experiment.packaged import packaged_configs
from .arguments import add_trust

if TYPE_CHECKING:
    from ..experiment.runs import RunFolder
    from ..experiment.settings import Experiment
    from ..show.tracking import Tracking

TRACKERS = ("mlflow", "wandb")
DEFAULT_CONFIG = "quick"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = (
        "%(prog)s [CONFIG] [--from MODEL] [--track TRACKER] [--trust] [--key value ...] | "
        "--resume RUN [--track TRACKER] [--trust]"
    )
    parser.add_argument(
        "config",
        metavar="CONFIG",
        nargs="?",
        help=f"TOML file or packaged config ({', '.join(packaged_configs())}); "
        f"default: {DEFAULT_CONFIG}, or with --from RUN the run's own settings",
    )
    parser.add_argument(
        "--from",
        dest="source",
        metavar="MODEL",
        help="begin a new run with the weights of a model file, or of a run's best or last model",
    )
    parser.add_argument(
        "--resume", metavar="RUN", help="resume the run in this folder from its checkpoint"
    )
    parser.add_argument(
        "--track",
        action="append",
        choices=TRACKERS,
        default=[],
        help="also write curves, settings, results and model for this tracker, offline unless its "
        "own environment variables say otherwise; may be given twice",
    )
    add_trust(parser)
    parser.epilog = "\n".join(["settings:", *_settings_help()])


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Train, save, evaluate and film; return the exit status (130 after Ctrl-C)."""
    from ..experiment.datasets import open_dataset
    from ..experiment.runs import RunFolder
    from ..experiment.worlds import make_worlds
    from ..show.tracking import Tracking, check_installed

    folder, source = None, None
    if arguments.resume is not None:
        if arguments.config is not None or arguments.source is not None or overrides:
            raise SettingsError(
                "--resume uses the run's own settings: give no others; to train on with others, or "
                "longer: arkanoid train --from RUN --key value"
            )
        folder = RunFolder.of(arguments.resume, arguments.trust)
        experiment = folder.experiment()
    else:
        experiment, source = _new_experiment(arguments, overrides)
    resumed = folder is not None
    # The environment reads its level files: the last of what can be wrong with the settings.
    worlds = make_worlds(experiment, 1)
    worlds.close()
    if experiment.imitation.dataset and not resumed:
        spaces = (worlds.single_observation_space, worlds.single_action_space)
        open_dataset(experiment.imitation.dataset, *spaces)
    check_installed(arguments.track)
    # Only now, with all settings known to be right, come the slow imports.
    from ..learn.starting import check_source, inherit
    from ..learn.training import check_resumable

    if folder is None:
        if source is not None:
            check_source(source, experiment)
        folder = RunFolder.create(experiment)
        if source is not None:
            inherit(folder, source, experiment)
    print(f"{experiment.name}: PPO on {experiment.env_id}, seed {experiment.seed}; {folder.path}")
    with folder.locked():
        if resumed:
            check_resumable(folder)
        tracking = Tracking(arguments.track, experiment, folder)
    status = 1
    try:
        status = _train(experiment, folder, resumed, tracking)
    finally:
        tracking.end(complete=status == 0)
    return status


def _train(
    experiment: "Experiment", folder: "RunFolder", resumed: bool, tracking: "Tracking"
) -> int:
    """Train and measure; return the exit status."""
    from ..learn.training import INTERRUPTED, train

    outcome = train(experiment, folder, resumed, on_log=tracking.log)
    if outcome == INTERRUPTED:
        print(f"stopped; the model is {folder.model}")
        print(f"resume   arkanoid train --resume {quoted(folder.path)}")
        return 130
    print(f"training: {outcome}")
    _show(experiment, folder, tracking)
    return 0


def _new_experiment(
    arguments: argparse.Namespace, overrides: list[tuple[str, str]]
) -> "tuple[Experiment, Path | None]":
    """Return the experiment of a new run, and the model that it begins with, if it does."""
    from ..experiment.lineage import find_model
    from ..experiment.runs import RunFolder
    from ..experiment.settings import Imitation, load_experiment

    if arguments.source is None:
        experiment, source = load_experiment(arguments.config or DEFAULT_CONFIG, overrides), None
    else:
        source = find_model(arguments.source)
        if arguments.config is not None:
            experiment = load_experiment(arguments.config, overrides)
        else:
            experiment = RunFolder.of(str(source.parent), arguments.trust).experiment(overrides)
            # The model has learned from the data set already.
            experiment = replace(experiment, imitation=Imitation())
    if experiment.imitation.dataset and source is not None:
        raise SettingsError(
            "a run begins either with a model (--from) or with the clone of a data set "
            "('imitation.dataset'): give one of them"
        )
    return experiment, source


def _show(experiment: "Experiment", folder: "RunFolder", tracking: "Tracking") -> None:
    """Measure the saved model, film it, and print the results and where everything is."""
    from ..experiment.runs import ModelFile
    from ..learn.model import load_policy
    from ..measure.comparison import AGENT, as_json, as_tables, compare
    from ..show.frames import film_policy

    model = ModelFile.find(str(folder.path), folder.trusted)
    policy = load_policy(model, experiment)
    comparison = compare(experiment, {AGENT: [policy]})
    results = as_json(experiment, comparison, {AGENT: [model.describe()]})
    try:
        write_atomically(folder.evaluation, (json.dumps(results, indent=2) + "\n").encode())
        film_policy(experiment, policy, folder.film)
    except OSError as error:
        raise SettingsError(f"{folder.path}: the results cannot be written: {error}") from None
    tracking.keep(results, model.path)
    print(f"\n{as_tables(experiment, comparison)}\n")
    log = quoted(folder.log)
    print(f"model    {model.path}\nlogs     {folder.log}  (tensorboard --logdir {log})")
    print(f"film     {folder.film}\nagain    arkanoid evaluate {quoted(folder.path)}")


def _settings_help() -> Iterator[str]:
    try:
        from ..experiment.reading import describe_settings
        from ..experiment.settings import Experiment
    except ModuleNotFoundError as error:
        yield f"  they are shown here once the extra `train` is installed ({error.name} is missing)"
        return
    for key, setting in describe_settings(Experiment).items():
        if setting.is_free:
            yield f"  --{key}.KEY  {setting.meaning}"
        else:
            yield f"  --{key}  {setting.meaning} ({setting.expected}; default {setting.default!r})"
