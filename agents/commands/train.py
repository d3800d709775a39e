"""`arkanoid train CONFIG [--key value ...]`: trains PPO and says how good it is."""

import argparse
import json
import shlex
import sys
import textwrap
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...envs.atomic import write_atomically
from ..experiment.errors import SettingsError
from ..experiment.files import cause, check_new_folder
from ..experiment.packaged import packaged_configs
from ..experiment.programs import arkanoid, command
from .arguments import add_trust, help_width, output_width

if TYPE_CHECKING:
    from ..experiment.reading import Setting
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
    parser.epilog = "\n".join(
        ["settings, with their defaults, as a shell takes them:", *_settings_help()]
    )


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
                f"longer: {arkanoid('train --from RUN --key value')}"
            )
        folder = RunFolder.of(arguments.resume, arguments.trust)
        experiment = folder.experiment()
        folder.check_resumable()
    else:
        experiment, source = _new_experiment(arguments, overrides)
        check_new_folder(Path(experiment.output))
    resumed = folder is not None
    # The environment reads its level files: the last of what can be wrong with the settings.
    worlds = make_worlds(experiment, 1)
    worlds.close()
    if experiment.imitation.dataset and not resumed:
        spaces = (worlds.single_observation_space, worlds.single_action_space)
        open_dataset(experiment.imitation.dataset, *spaces)
    check_installed(arguments.track)
    # Only now, with all settings known to be right, come the slow imports.
    from ...envs.browser.shipped import offers_module
    from ..learn.playing import find_device
    from ..learn.starting import check_source, inherit

    try:
        find_device(experiment.training.device)
    except SettingsError as error:
        raise error if folder is None else SettingsError(f"{folder.config}: {error}") from None
    if folder is None:
        if source is not None:
            check_source(source, experiment)
        folder = RunFolder.create(experiment)
        if source is not None:
            inherit(folder, source, experiment)
    print(f"{experiment.name}: PPO on {experiment.env_id}, seed {experiment.seed}; {folder.path}")
    if offers_module():
        print(f"follow   {arkanoid('watch', folder.path, '--web')}")
    sys.stdout.flush()
    with folder.locked():
        if resumed:
            folder.check_resumable()
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
    from ..experiment.runs import INTERRUPTED
    from ..learn.training import train

    outcome = train(experiment, folder, resumed, on_log=tracking.log)
    if outcome == INTERRUPTED:
        print(f"stopped; the model is {folder.model}")
        print(f"resume   {arkanoid('train', '--resume', folder.path)}")
        return 130
    print(f"training: {outcome}")
    _show(experiment, folder, tracking)
    return 0


def _new_experiment(
    arguments: argparse.Namespace, overrides: list[tuple[str, str]]
) -> "tuple[Experiment, Path | None]":
    """Return the experiment of a new run, and the model that it begins with, if it does."""
    from ..experiment.lineage import find_model
    from ..experiment.runs import ModelFile
    from ..experiment.settings import Imitation, load_experiment

    if arguments.source is None:
        experiment, source = load_experiment(arguments.config or DEFAULT_CONFIG, overrides), None
    else:
        source = find_model(arguments.source)
        if arguments.config is not None:
            experiment = load_experiment(arguments.config, overrides)
        else:
            experiment = ModelFile.find(str(source), arguments.trust).run.experiment(overrides)
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
    from ..measure.comparison import AGENT, as_json, as_tables, compare, count_games
    from ..measure.progress import GamesBar
    from ..show.frames import film_policy

    model = ModelFile.find(str(folder.path), folder.trusted)
    policy = load_policy(model, experiment)
    _note("measuring: the agent and the baselines play the same games")
    with GamesBar(count_games(experiment, 1)) as bar:
        comparison = compare(experiment, {AGENT: [policy]}, bar)
    results = as_json(experiment, comparison, {AGENT: [model.describe()]})
    try:
        write_atomically(folder.evaluation, (json.dumps(results, indent=2) + "\n").encode())
        _note("filming a game")
        film_policy(experiment, policy, folder.film)
    except OSError as error:
        raise SettingsError(
            f"{folder.path}: the results cannot be written: {cause(error)}"
        ) from None
    tracking.keep(results, model.path)
    print(f"\n{as_tables(experiment, comparison, output_width())}\n")
    print(f"model    {model.path}\nfilm     {folder.film}")
    print(f"again    {arkanoid('evaluate', folder.path)}")
    print(f"watch    {arkanoid('watch', folder.path)}")
    print(f"curves   {command('tensorboard', '--logdir', folder.log)}")


def _note(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _settings_help() -> Iterator[str]:
    try:
        from ..experiment.reading import describe_settings
        from ..experiment.settings import Experiment
    except ModuleNotFoundError as error:
        yield f"  they are shown here once the extra `train` is installed ({error.name} is missing)"
        return
    width = help_width()
    for key, setting in describe_settings(Experiment).items():
        if setting.is_free:
            yield f"  --{key}.KEY VALUE"
            text = setting.meaning
        else:
            yield from _folded(f"--{key} {_typed(setting)}", width, 2)
            text = f"{setting.meaning} ({setting.expected})"
        yield from _folded(text, width, 6)


def _typed(setting: "Setting") -> str:
    """Return a setting's default as one types it: TOML, and a text without its quotes."""
    from ..experiment.reading import to_toml_value

    return shlex.quote(setting.default if setting.is_text else to_toml_value(setting.default))


def _folded(text: str, width: int, indent: int) -> list[str]:
    space = " " * indent
    return textwrap.wrap(
        text,
        width,
        initial_indent=space,
        subsequent_indent=" " * 6,
        break_long_words=False,
        break_on_hyphens=False,
    )
