"""`arkanoid train CONFIG [--key value ...]`: train PPO and say how good it is."""

import argparse
import json
from collections.abc import Iterator

from ..experiment.runs import RunFolder
from ..experiment.schema import Settings, SettingsError, leaves
from ..experiment.settings import Experiment, load_experiment, packaged_configs

DEFAULT_CONFIG = "quick"
SUMMARY = "train PPO on the game, then compare it with the baselines"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.usage = "%(prog)s [CONFIG] [--key value ...] | --resume RUN"
    parser.add_argument(
        "config",
        metavar="CONFIG",
        nargs="?",
        help=f"TOML file or packaged config ({', '.join(packaged_configs())}); "
        f"default: {DEFAULT_CONFIG}",
    )
    parser.add_argument(
        "--resume", metavar="RUN", help="go on with the run in this folder, from its checkpoint"
    )
    parser.epilog = "\n".join(["settings:", *_settings_help(Experiment)])


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Train, save, evaluate and record; return the exit status (130 after Ctrl-C)."""
    folder = None
    if arguments.resume is not None:
        if arguments.config is not None or overrides:
            raise SettingsError("--resume goes on with the run's own settings: give no others")
        folder = RunFolder.of(arguments.resume)
        experiment = folder.experiment()
    else:
        experiment = load_experiment(arguments.config or DEFAULT_CONFIG, overrides)
    # The environment checks its part of the settings ...
    from ..experiment.worlds import make_worlds

    make_worlds(experiment, 1).close()
    # ... and only now, with all of them known to be right, come the slow imports.
    from ..learn.training import INTERRUPTED, check_resumable, train

    resume = folder is not None
    if folder is None:
        folder = RunFolder.create(experiment)
    else:
        check_resumable(folder)
    print(f"{experiment.name}: PPO on {experiment.env_id}, seed {experiment.seed}; {folder.path}")
    outcome = train(experiment, folder, resume)
    if outcome == INTERRUPTED:
        print(f"stopped; the model is {folder.model}")
        print(f"go on    arkanoid train --resume {folder.path}")
        return 130
    print(f"training: {outcome}")
    _show(experiment, folder)
    return 0


def _show(experiment: Experiment, folder: RunFolder) -> None:
    """Measure the saved model, record it, and print the results and where everything is."""
    from ..experiment.runs import ModelFile
    from ..learn.model import load_policy
    from ..measure.comparison import AGENT, as_json, as_tables, compare
    from ..show.clips import record_clip

    model = ModelFile.find(str(folder.path))
    policy = load_policy(model.path, experiment)
    comparison = compare(experiment, {AGENT: [policy]})
    results = as_json(experiment, comparison, {AGENT: [model.describe()]})
    folder.evaluation.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")
    record_clip(experiment, policy, folder.picture)
    print(f"\n{as_tables(experiment, comparison)}\n")
    print(f"model    {model.path}\nlogs     {folder.log}  (tensorboard --logdir {folder.log})")
    print(f"picture  {folder.picture}\nagain    arkanoid evaluate {folder.path}")


def _settings_help(schema: type[Settings]) -> Iterator[str]:
    for leaf in leaves(schema):
        if not leaf.is_table:
            key = f"{leaf.key}.KEY" if leaf.is_free else leaf.key
            yield f"  --{key}  {leaf.meaning} ({leaf.expected()}; default {leaf.default!r})"
