"""`arkanoid train CONFIG [--key value ...]`: trains PPO and says how good it is."""

import argparse
import json
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...envs.atomic import write_atomically
from ..experiment.errors import SettingsError
from ..experiment.files import quoted
from ..experiment.packaged import packaged_configs
from .arguments import add_trust

if TYPE_CHECKING:
    from ..experiment.runs import RunFolder
    from ..experiment.settings import Experiment

DEFAULT_CONFIG = "quick"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s [CONFIG] [--key value ...] | --resume RUN [--trust]"
    parser.add_argument(
        "config",
        metavar="CONFIG",
        nargs="?",
        help=f"TOML file or packaged config ({', '.join(packaged_configs())}); "
        f"default: {DEFAULT_CONFIG}",
    )
    parser.add_argument(
        "--resume", metavar="RUN", help="resume the run in this folder from its checkpoint"
    )
    add_trust(parser)
    parser.epilog = "\n".join(["settings:", *_settings_help()])


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Train, save, evaluate and film; return the exit status (130 after Ctrl-C)."""
    from ..experiment.runs import RunFolder
    from ..experiment.settings import load_experiment
    from ..experiment.worlds import make_worlds

    folder = None
    if arguments.resume is not None:
        if arguments.config is not None or overrides:
            raise SettingsError("--resume uses the run's own settings: give no others")
        folder = RunFolder.of(arguments.resume, arguments.trust)
        experiment = folder.experiment()
    else:
        experiment = load_experiment(arguments.config or DEFAULT_CONFIG, overrides)
    # The environment reads its level files: the last of what can be wrong with the settings.
    make_worlds(experiment, 1).close()
    # Only now, with all settings known to be right, come the slow imports.
    from ..learn.training import INTERRUPTED, train

    resumed = folder is not None
    if folder is None:
        folder = RunFolder.create(experiment)
    print(f"{experiment.name}: PPO on {experiment.env_id}, seed {experiment.seed}; {folder.path}")
    outcome = train(experiment, folder, resumed)
    if outcome == INTERRUPTED:
        print(f"stopped; the model is {folder.model}")
        print(f"resume   arkanoid train --resume {quoted(folder.path)}")
        return 130
    print(f"training: {outcome}")
    _show(experiment, folder)
    return 0


def _show(experiment: "Experiment", folder: "RunFolder") -> None:
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
