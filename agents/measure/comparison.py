"""The agent against the baselines: what `evaluate` measures and shows."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from ...envs.config import Config
from ..experiment.seeds import Purpose, spread_seed, spread_seeds
from ..experiment.settings import BASELINES, Experiment
from ..experiment.worlds import make_worlds
from .baselines import make_baseline
from .episodes import play_episodes
from .intervals import (
    Interval,
    bootstrap_interval,
    interquartile_mean,
    mean,
    stratified_interval,
)
from .policy import Policy
from .suites import EpisodeStart, Suite, make_suites

# The tables' columns: each measure and its heading.
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
TITLES = {"mean": "mean", "iqm": "interquartile mean"}
AGENT = "agent"

# Measure -> array [models, episodes, levels].
Results = dict[str, NDArray[np.float64]]
# Suite -> policy -> results.
Comparison = dict[str, dict[str, Results]]


def compare(
    experiment: Experiment,
    agents: Mapping[str, Sequence[Policy]],
    tell: Callable[[str], None] = lambda message: None,
) -> Comparison:
    """Let agents and baselines play the episodes of the experiment's evaluation.

    An episode depends on nothing but its level, its seed and the policy: the same agent always gets
    the same numbers.

    Args:
        experiment: says what is played, and which baselines play it.
        agents: by their names; each is one model, or several that were trained with different
            seeds.
        tell: gets a message about who plays next.

    Raises:
        ValueError: an agent has the name of a baseline.
    """
    if not agents.keys().isdisjoint(BASELINES):
        raise ValueError("an agent has the name of a baseline")
    comparison: Comparison = {}
    for suite_name, suite in make_suites(experiment).items():
        results: dict[str, Results] = {}
        for name, models in agents.items():
            tell(f"{suite_name}: {name}")
            results[name] = _stacked([_play_agent(experiment, suite, model) for model in models])
        for name in experiment.evaluation.baselines:
            if name == "planner" and suite.whole_games:
                continue  # it loses hardly a ball, and a game would go on for hours
            tell(f"{suite_name}: {name}")
            results[name] = _stacked([_play_baseline(experiment, suite, name)])
        comparison[suite_name] = results
    return comparison


def _play_agent(
    experiment: Experiment, suite: Suite, policy: Policy
) -> dict[str, NDArray[np.float64]]:
    return _play(experiment, suite, suite.episodes, experiment.game, lambda worlds: policy)


def _play_baseline(
    experiment: Experiment, suite: Suite, name: str
) -> dict[str, NDArray[np.float64]]:
    """Play the same games with the observation that baselines understand."""
    settings = experiment.evaluation
    planned = name == "planner"
    episodes = min(suite.episodes, settings.planner_episodes) if planned else suite.episodes
    config = experiment.config.of_the_game()
    seed = spread_seed(settings.seed, Purpose.EVALUATION_POLICY)
    return _play(
        experiment,
        suite,
        episodes,
        config,
        lambda worlds: make_baseline(name, worlds, seed),
    )


def _play(
    experiment: Experiment,
    suite: Suite,
    episodes: int,
    config: Config,
    make_policy: Callable[[VectorEnv[Any, Any, Any]], Policy],
) -> dict[str, NDArray[np.float64]]:
    """Play a suite with the policy that is made for its worlds."""
    worlds = make_worlds(experiment, len(suite.starts) * episodes, config)
    try:
        return play_episodes(
            worlds,
            make_policy(worlds),
            spread_seeds(experiment.evaluation.seed, Purpose.EVALUATION, episodes),
            suite.starts,
            suite.whole_games,
        )
    finally:
        worlds.close()


def _stacked(played: Sequence[dict[str, NDArray[np.float64]]]) -> Results:
    return {name: np.stack([one[name] for one in played]) for name in played[0]}


def summarise(samples: NDArray[np.float64]) -> dict[str, Interval]:
    """Return mean and interquartile mean of samples [models, episodes, levels].

    Of one model the episodes of each level are resampled. Of several, the models' means on each
    level are: then the interval says what another training would bring.
    """
    rows = samples.mean(axis=1) if len(samples) > 1 else samples[0]
    return {name: stratified_interval(rows, statistic) for name, statistic in STATISTICS.items()}


def level_interval(samples: NDArray[np.float64], level: int) -> Interval:
    """Return the mean of samples [models, episodes, levels] on one level."""
    of_level = samples[:, :, level]
    return bootstrap_interval(of_level.mean(axis=1) if len(samples) > 1 else of_level[0])


def as_tables(experiment: Experiment, comparison: Comparison) -> str:
    """Return a comparison as text: of each suite all policies, then the cleared rate by level."""
    suites = make_suites(experiment)
    parts = []
    for name, results in comparison.items():
        starts, heading = suites[name].starts, describe_suite(name, suites[name])
        for statistic, title in TITLES.items():
            table = _aligned(summary_rows(results, statistic, ""))
            parts.append(f"{heading}; {title} ± 95 % bootstrap interval\n\n{table}")
        if len(starts) > 1:
            table = _aligned(_cleared_rows(starts, results))
            parts.append(f"{name}: cleared rate by level\n\n{table}")
    return "\n\n".join(parts)


def describe_suite(name: str, suite: Suite) -> str:
    """Return a heading for a suite's results."""
    if suite.whole_games:
        return f"{name}: {suite.episodes} whole games"
    return f"{name}: {len(suite.starts)} levels, {suite.episodes} episodes of each"


def summary_rows(results: Mapping[str, Results], statistic: str, title: str) -> list[list[str]]:
    """Return a heading, and one row of a statistic's intervals for each policy."""
    rows = [[title, *COLUMNS.values()]]
    for name, measured in results.items():
        rows.append([name, *(str(summarise(measured[key])[statistic]) for key in COLUMNS)])
    return rows


def _cleared_rows(
    starts: Sequence[EpisodeStart], results: Mapping[str, Results]
) -> list[list[str]]:
    rows = [["", *results]]
    for level, start in enumerate(starts):
        rows.append(
            [start.name, *(str(level_interval(r["cleared"], level)) for r in results.values())]
        )
    return rows


def _aligned(rows: Sequence[Sequence[str]]) -> str:
    """Return rows of text as a table; the first row is its heading."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in rows
    ]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def as_json(
    experiment: Experiment, comparison: Comparison, models: Mapping[str, Sequence[Any]]
) -> dict[str, Any]:
    """Return a comparison, with what is needed to repeat it, as `json.dump` takes it.

    ``models`` describes the models of each agent.
    """
    suites = make_suites(experiment)
    settings = experiment.evaluation
    return {
        "env_id": experiment.env_id,
        "env": experiment.config.plain(),
        "seed": settings.seed,
        "deterministic": settings.deterministic,
        "models": {name: list(of_agent) for name, of_agent in models.items()},
        "suites": {
            name: {
                "whole_games": suites[name].whole_games,
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


def _policy_json(starts: Sequence[EpisodeStart], measured: Results) -> dict[str, Any]:
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
