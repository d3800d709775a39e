"""`python -m arkanoid.agents.train CONFIG [--key value ...]`: train PPO and say how good it is."""

import argparse
import json
import sys
from collections.abc import Iterator

from .runs import RunFolder
from .schema import Settings, leaves
from .settings import Experiment, load_experiment, packaged_configs

DEFAULT_CONFIG = "quick"
SUMMARY = "train PPO on the game, then compare it with the baselines"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.usage = "%(prog)s [CONFIG] [--key value ...]"
    parser.add_argument(
        "config",
        metavar="CONFIG",
        nargs="?",
        default=DEFAULT_CONFIG,
        help=f"TOML file or packaged config ({', '.join(packaged_configs())}); "
        f"default: {DEFAULT_CONFIG}",
    )
    parser.epilog = "\n".join(["settings:", *_settings_help(Experiment)])


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Train, save, evaluate and record; return the exit status (130 after Ctrl-C)."""
    experiment = load_experiment(arguments.config, overrides)
    # Only now, with the settings known to be right, the slow imports.
    from . import learning
    from .episodes import adapt
    from .worlds import make_worlds

    venv = adapt(make_worlds(experiment, experiment.training.worlds))
    model = learning.make_model(experiment, venv)
    folder = RunFolder.create(experiment)
    print(f"{experiment.name}: PPO on {experiment.env_id}, seed {experiment.seed}; {folder.path}")
    finished = learning.train(model, experiment, folder.log)
    learning.save_model(model, folder.model)
    venv.close()
    if not finished:
        print(f"stopped after {model.num_timesteps} decisions; the model is {folder.model}")
        return 130
    _show(experiment, folder)
    return 0


def _show(experiment: Experiment, folder: RunFolder) -> None:
    """Measure the saved model, record it, and print the results and where everything is."""
    from . import learning
    from .comparison import as_json, as_table, compare
    from .recording import record_clip

    policy = learning.load_policy(folder.model, experiment)
    comparison = compare(experiment, policy)
    results = json.dumps(as_json(experiment, comparison), indent=2)
    folder.evaluation.write_text(results + "\n", encoding="utf-8")
    record_clip(experiment, policy, folder.picture)
    print(f"\n{experiment.evaluation.episodes} episodes each, mean ± 95 % bootstrap interval:\n")
    print(as_table(comparison))
    print(f"\nmodel    {folder.model}\nlogs     {folder.log}  (tensorboard --logdir {folder.log})")
    print(f"picture  {folder.picture}\nagain    arkanoid evaluate {folder.path}")


def _settings_help(schema: type[Settings]) -> Iterator[str]:
    for leaf in leaves(schema):
        if not leaf.is_table:
            key = f"{leaf.key}.KEY" if leaf.is_free else leaf.key
            yield f"  --{key}  {leaf.meaning} ({leaf.expected()}; default {leaf.default!r})"


if __name__ == "__main__":
    from .cli import main

    sys.exit(main(["train", *sys.argv[1:]]))
