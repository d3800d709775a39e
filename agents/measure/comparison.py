"""The agent against the baselines: what `evaluate` measures and shows."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from .baselines import Policy, make_baseline
from .episodes import play_episodes
from .intervals import (
    Interval,
    bootstrap_interval,
    interquartile_mean,
    mean,
    stratified_interval,
)
from .suites import Start, Suite, make_suites

# The table's columns: what is measured, and its heading.
COLUMNS = {
    "cleared": "cleared",
    "score": "score",
    "hits": "brick hits",
    "lives": "lives left",
    "round": "round reached",
    "return": "return",
    "steps": "decisions",
}
STATISTICS = {"mean": mean, "iqm": interquartile_mean}
AGENT = "agent"

# How it is seen, of the environment's keywords: baselines have an observation of their own.
_SEEN = ("observation", "size", "grey", "stack")

# Measure -> array [models, episodes, levels].
Results = dict[str, NDArray[np.float64]]
# Suite -> policy -> results.
Comparison = dict[str, dict[str, Results]]
Report = Callable[[str], None]


def compare(
    experiment: Experiment, agents: Mapping[str, Sequence[Policy]], report: Report | None = None
) -> Comparison:
    """Let agents and baselines play the episodes of the experiment's evaluation.

    Each episode depends on nothing but its level, its seed and the policy, so that the same agent
    always gets the same numbers.

    Args:
        experiment: says what is played, and which baselines play it.
        agents: by names, each of one model or of several that were trained with different seeds.
        report: told who plays next.
    """
    tell = report or (lambda message: None)
    comparison: Comparison = {}
    for suite_name, suite in make_suites(experiment).items():
        results: dict[str, Results] = {}
        for name, models in agents.items():
            tell(f"{suite_name}: {name}")
            results[name] = _stacked([_play(experiment, suite, model) for model in models])
        for name in experiment.evaluation.baselines:
            if name == "planner" and suite.whole:
                continue  # whole games of a player who loses no ball have hardly an end
            tell(f"{suite_name}: {name}")
            results[name] = _stacked([_play_baseline(experiment, suite, name)])
        comparison[suite_name] = results
    return comparison


def _play(experiment: Experiment, suite: Suite, policy: Policy) -> dict[str, NDArray[np.float64]]:
    worlds = make_worlds(experiment, len(suite.starts) * suite.episodes)
    try:
        return play_episodes(
            worlds, policy, experiment.evaluation.seed, suite.starts, whole=suite.whole
        )
    finally:
        worlds.close()


def _play_baseline(
    experiment: Experiment, suite: Suite, name: str
) -> dict[str, NDArray[np.float64]]:
    """Play the same games, seen as the baselines understand them."""
    settings = experiment.evaluation
    planned = name == "planner"
    episodes = min(suite.episodes, settings.planner_episodes) if planned else suite.episodes
    worlds = make_worlds(experiment, len(suite.starts) * episodes, without=_SEEN)
    try:
        policy = make_baseline(name, worlds, settings.seed)
        return play_episodes(worlds, policy, settings.seed, suite.starts, whole=suite.whole)
    finally:
        worlds.close()


def _stacked(played: Sequence[dict[str, NDArray[np.float64]]]) -> Results:
    return {name: np.stack([one[name] for one in played]) for name in played[0]}


def summarise(samples: NDArray[np.float64]) -> dict[str, Interval]:
    """Return mean and interquartile mean of samples [models, episodes, levels].

    Of one model the episodes of each level are resampled. Of several, each one's mean on a level is
    a sample, and these are: then the interval says what another training would bring.
    """
    rows = samples.mean(axis=1) if len(samples) > 1 else samples[0]
    return {name: stratified_interval(rows, statistic) for name, statistic in STATISTICS.items()}


def level_interval(samples: NDArray[np.float64], level: int) -> Interval:
    """Return the mean on one level of samples [models, episodes, levels]."""
    of_level = samples[:, :, level]
    return bootstrap_interval(of_level.mean(axis=1) if len(samples) > 1 else of_level[0])


def as_tables(experiment: Experiment, comparison: Comparison) -> str:
    """Return a comparison as text: for each suite all policies, then the cleared rate by level."""
    suites = make_suites(experiment)
    parts = []
    for name, results in comparison.items():
        starts = suites[name].starts
        if suites[name].whole:
            heading = f"{name}: {suites[name].episodes} whole games"
        else:
            heading = f"{name}: {len(starts)} levels, {suites[name].episodes} episodes of each"
        for statistic, title in (("mean", "mean"), ("iqm", "interquartile mean")):
            table = _summary_table(results, statistic)
            parts.append(f"{heading}; {title} ± 95 % bootstrap interval\n\n{table}")
        if len(starts) > 1:
            parts.append(f"{name}: cleared rate by level\n\n{_level_table(starts, results)}")
    return "\n\n".join(parts)


def _summary_table(results: Mapping[str, Results], statistic: str) -> str:
    rows = [["", *COLUMNS.values()]]
    for name, measured in results.items():
        rows.append([name, *(str(summarise(measured[key])[statistic]) for key in COLUMNS)])
    return _aligned(rows)


def _level_table(starts: Sequence[Start], results: Mapping[str, Results]) -> str:
    rows = [["", *results]]
    for level, start in enumerate(starts):
        rows.append(
            [start.name, *(str(level_interval(r["cleared"], level)) for r in results.values())]
        )
    return _aligned(rows)


def _aligned(rows: Sequence[Sequence[str]]) -> str:
    """Return rows of text as a table, the first row being its heading."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in rows
    ]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def as_json(
    experiment: Experiment, comparison: Comparison, models: Mapping[str, Sequence[Any]]
) -> dict[str, Any]:
    """Return a comparison as what `json.dump` takes, with what is needed to repeat it.

    ``models`` says of each agent what its models are.
    """
    suites = make_suites(experiment)
    settings = experiment.evaluation
    return {
        "env_id": experiment.env_id,
        "env": experiment.env,
        "first_seed": settings.seed,
        "deterministic": settings.deterministic,
        "models": {name: list(of_agent) for name, of_agent in models.items()},
        "suites": {
            name: {
                "whole_games": suites[name].whole,
                "episodes": suites[name].episodes,
                "levels": [start.name for start in suites[name].starts],
                "policies": {
                    policy: _policy_json(suites[name].starts, measured)
                    for policy, measured in results.items()
                },
            }
            for name, results in comparison.items()
        },
    }


def _policy_json(starts: Sequence[Start], measured: Results) -> dict[str, Any]:
    return {
        "episodes": measured["cleared"].shape[1],
        "summary": {
            key: {name: interval._asdict() for name, interval in summarise(measured[key]).items()}
            for key in COLUMNS
        },
        "levels": {
            start.name: {key: level_interval(measured[key], level)._asdict() for key in COLUMNS}
            for level, start in enumerate(starts)
        },
    }
