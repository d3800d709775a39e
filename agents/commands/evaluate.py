"""`arkanoid evaluate [MODEL ...]`: how good saved models are, compared with the baselines."""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING

from ..experiment.errors import SettingsError
from ..experiment.files import check_new_folder
from ..experiment.packaged import DEFAULT_AGENT, packaged_agents
from .arguments import MEASURED, add_trust, check_settings, output_width

if TYPE_CHECKING:
    from ..experiment.runs import ModelFile
    from ..experiment.settings import Experiment

_FILM = "evaluation.film_seconds"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s [MODEL ...] [--json] [--plots FOLDER] [--trust] [--key value ...]"
    parser.add_argument(
        "models",
        metavar="MODEL",
        nargs="*",
        help="folders of runs, model files, or names of agents in the package: "
        f"{', '.join(packaged_agents())}; runs that differ only in their seeds are measured as one "
        f"agent; default: {DEFAULT_AGENT}",
    )
    parser.add_argument("--json", action="store_true", help="print JSON instead of tables")
    parser.add_argument("--plots", metavar="FOLDER", help="draw the results into this folder")
    add_trust(parser)
    parser.epilog = (
        "The first run's own settings hold; --key value changes them, as in\n"
        """  --evaluation.suites '["test", "named"]' --evaluation.level_episodes 20"""
    )


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Evaluate, print and draw; return the exit status."""
    from ..experiment.runs import ModelFile

    check_settings(overrides, MEASURED, but=[_FILM])
    models = [ModelFile.find(name, arguments.trust) for name in arguments.models or [None]]
    experiment = models[0].experiment(overrides)
    agents = group_by_experiment(models, overrides)
    if arguments.plots:
        check_new_folder(Path(arguments.plots))
    from ..learn.model import load_policy
    from ..measure.comparison import as_json, as_tables, compare, count_games
    from ..measure.progress import GamesBar

    policies = {
        name: [load_policy(model, experiment) for model in group] for name, group in agents.items()
    }
    with GamesBar(count_games(experiment, len(models))) as bar:
        comparison = compare(experiment, policies, bar)
    described = {name: [model.describe() for model in group] for name, group in agents.items()}
    if arguments.json:
        print(json.dumps(as_json(experiment, comparison, described), indent=2))
    else:
        print(as_tables(experiment, comparison, output_width()))
    if arguments.plots:
        from ..show.plots import plot_comparison

        try:
            for path in plot_comparison(experiment, comparison, Path(arguments.plots)):
                print(path, file=sys.stderr)
        except OSError as error:
            raise SettingsError(f"{arguments.plots}: cannot be written: {error}") from None
    return 0


def group_by_experiment(
    models: Sequence["ModelFile"], overrides: list[tuple[str, str]]
) -> dict[str, list["ModelFile"]]:
    """Return the models by agents; models of one agent differ in nothing but their seeds.

    A single agent is called ``agent``, several get their experiments' names; what has that name
    already, an agent or a baseline, is told apart by a number. Raises `SettingsError` if the models
    were not trained to play the same game, or if one is given twice.
    """
    from ..experiment.settings import BASELINES

    for index, model in enumerate(models):
        if model.path in [other.path for other in models[:index]]:
            raise SettingsError(f"{model.path}: given twice; give each model once")
    groups: list[tuple[Experiment, list[ModelFile]]] = []
    for model in models:
        experiment = replace(model.experiment(overrides), seed=0, output=".")
        for known, group in groups:
            if experiment == known:
                group.append(model)
                break
        else:
            groups.append((experiment, [model]))
    first = groups[0][0]
    for experiment, group in groups[1:]:
        if experiment.config != first.config:
            raise SettingsError(
                f"{group[0].path}: trained with another 'env_id' or 'env' than {models[0].path}; "
                f"evaluate them one after the other, or let --env.KEY VALUE make them equal"
            )
    if len(groups) == 1:
        return {"agent": groups[0][1]}
    named: dict[str, list[ModelFile]] = {}
    for experiment, group in groups:
        name = experiment.name
        numbered = (f"{name}#{number}" for number in count(2))
        taken = {*BASELINES, *named}
        named[next(free for free in chain([name], numbered) if free not in taken)] = group
    return named
