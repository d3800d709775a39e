"""`python -m arkanoid.agents.evaluate RUN`: how good a saved model is, against the baselines."""

import argparse
import json
import sys

from .runs import RunFolder

SUMMARY = "measure a trained model against the baselines"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.usage = "%(prog)s RUN [--json] [--key value ...]"
    parser.add_argument("run", metavar="RUN", help="the folder of a run, or the model.zip in it")
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    parser.epilog = (
        "The run's own settings hold; --key value changes them, as in --evaluation.episodes 500"
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Evaluate and print; return the exit status."""
    folder = RunFolder.of(arguments.run)
    experiment = folder.experiment(overrides)
    from .comparison import as_json, as_table, compare
    from .learning import load_policy

    comparison = compare(experiment, load_policy(folder.model, experiment))
    if arguments.json:
        print(json.dumps(as_json(experiment, comparison), indent=2))
    else:
        episodes = experiment.evaluation.episodes
        print(f"{episodes} episodes each, mean ± 95 % bootstrap interval:\n")
        print(as_table(comparison))
    return 0


if __name__ == "__main__":
    from .cli import main

    sys.exit(main(["evaluate", *sys.argv[1:]]))
