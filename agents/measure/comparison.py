"""The agent against the baselines: what `evaluate` measures and shows."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from ...envs.checks import counted
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
from .policy import Policy, device_of
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


class Progress(Protocol):
    """Something that shows how far a comparison has come."""

    def name(self, what: str) -> None:
        """Take who plays next."""

    def ended(self, games: int) -> None:
        """Take how many games have ended since the last call."""


class _Silence:
    def name(self, what: str) -> None:
        pass

    def ended(self, games: int) -> None:
        pass


def compare(
    experiment: Experiment,
    agents: Mapping[str, Sequence[Policy]],
    progress: Progress | None = None,
) -> Comparison:
    """Let agents and baselines play the episodes of the experiment's evaluation.

    An episode depends on nothing but its level, its seed and the policy: the same agent always gets
    the same numbers.

    Args:
        experiment: says what is played, and which baselines play it.
        agents: by their names; each is one model, or several that were trained with different
            seeds.
        progress: is told who plays, and how many games have ended, of `count_games`.

    Raises:
        ValueError: an agent has the name of a baseline.
    """
    if not agents.keys().isdisjoint(BASELINES):
        raise ValueError("an agent has the name of a baseline")
    told = progress or _Silence()
    comparison: Comparison = {}
    for suite_name, suite in make_suites(experiment).items():
        results: dict[str, Results] = {}
        for name, models in agents.items():
            told.name(f"{suite_name}: {name}")
            results[name] = _stacked(
                [_play_agent(experiment, suite, model, told.ended) for model in models]
            )
        for name in _baselines(experiment, suite):
            told.name(f"{suite_name}: {name}")
            results[name] = _stacked([_play_baseline(experiment, suite, name, told.ended)])
        comparison[suite_name] = results
    return comparison


def count_games(experiment: Experiment, models: int) -> int:
    """Return how many games `compare` plays for so many models."""
    return sum(
        len(suite.starts)
        * (
            models * suite.episodes
            + sum(_episodes(experiment, suite, name) for name in _baselines(experiment, suite))
        )
        for suite in make_suites(experiment).values()
    )


def _baselines(experiment: Experiment, suite: Suite) -> list[str]:
    """Return who else plays a suite."""
    # The planner loses hardly a ball, and a whole game would go on for hours.
    return [
        name
        for name in experiment.evaluation.baselines
        if not (name == "planner" and suite.whole_games)
    ]


def _episodes(experiment: Experiment, suite: Suite, baseline: str) -> int:
    """Return how many episodes of each level a baseline plays."""
    most = experiment.evaluation.planner_episodes if baseline == "planner" else suite.episodes
    return min(suite.episodes, most)


def _play_agent(
    experiment: Experiment, suite: Suite, policy: Policy, ended: Callable[[int], None]
) -> dict[str, NDArray[np.float64]]:
    config, device = experiment.game, device_of(policy)
    return _play(experiment, suite, suite.episodes, config, lambda worlds: policy, ended, device)


def _play_baseline(
    experiment: Experiment, suite: Suite, name: str, ended: Callable[[int], None]
) -> dict[str, NDArray[np.float64]]:
    """Play the same games with the observation that baselines understand."""
    episodes = _episodes(experiment, suite, name)
    config = experiment.config.of_the_game()
    seed = spread_seed(experiment.evaluation.seed, Purpose.EVALUATION_POLICY)
    return _play(
        experiment,
        suite,
        episodes,
        config,
        lambda worlds: make_baseline(name, worlds, seed),
        ended,
    )


def _play(
    experiment: Experiment,
    suite: Suite,
    episodes: int,
    config: Config,
    make_policy: Callable[[VectorEnv[Any, Any, Any]], Policy],
    ended: Callable[[int], None],
    device: str | None = None,
) -> dict[str, NDArray[np.float64]]:
    """Play a suite with the policy that is made for its worlds, on a device or here."""
    worlds = make_worlds(experiment, len(suite.starts) * episodes, config, device=device)
    try:
        return play_episodes(
            worlds,
            make_policy(worlds),
            spread_seeds(experiment.evaluation.seed, Purpose.EVALUATION, episodes),
            suite.starts,
            suite.whole_games,
            ended,
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


def as_tables(experiment: Experiment, comparison: Comparison, width: int) -> str:
    """Return a comparison as text: of each suite all policies, then the cleared rate by level.

    Lines have at most ``width`` letters: the columns of a wide table follow below each other.
    """
    suites = make_suites(experiment)
    parts = []
    for name, results in comparison.items():
        starts, heading = suites[name].starts, describe_suite(name, suites[name])
        # Of one number there is neither a mean nor an interval.
        numbers = max(measured["score"].size for measured in results.values())
        for statistic, title in TITLES.items() if numbers > 1 else [("mean", "")]:
            table = _aligned(summary_rows(results, statistic, ""), width)
            parts.append(f"{heading}{_told(title, table)}\n\n{table}")
        if len(starts) > 1:
            table = _aligned(_cleared_rows(starts, results), width)
            parts.append(f"{name}: cleared rate by level\n\n{table}")
    return "\n\n".join(parts)


def _told(title: str, table: str) -> str:
    """Return what a table shows, for the end of its heading."""
    return f"; {title}{' ± 95 % interval' if '±' in table else ''}" if title else ""


def describe_suite(name: str, suite: Suite) -> str:
    """Return a heading for a suite's results."""
    if suite.whole_games:
        return f"{name}: {counted(suite.episodes, 'whole game')}"
    levels = counted(len(suite.starts), "level")
    of_each = " of each" if len(suite.starts) > 1 else ""
    return f"{name}: {levels}, {counted(suite.episodes, 'episode')}{of_each}"


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


def _aligned(rows: Sequence[Sequence[str]], width: int) -> str:
    """Return rows of text as a table; the first row is its heading, the first column a name.

    What does not fit into the width follows in further tables with the same names.
    """
    names, *columns = (
        [*map(str.ljust if at == 0 else str.rjust, column, [max(map(len, column))] * len(column))]
        for at, column in enumerate(zip(*rows, strict=True))
    )
    tables: list[list[list[str]]] = []
    for column in columns:
        if not tables or sum(len(one[0]) + 2 for one in [*tables[-1], column]) - 2 > width:
            tables.append([names])
        tables[-1].append(column)
    return "\n\n".join(_ruled(table) for table in tables)


def _ruled(columns: Sequence[Sequence[str]]) -> str:
    """Return columns of texts of equal lengths, with a line below their headings."""
    head, *lines = ("  ".join(row) for row in zip(*columns, strict=True))
    return "\n".join([head, "-" * len(head), *lines])


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
            key: {name: interval.as_json() for name, interval in summarise(measured[key]).items()}
            for key in COLUMNS
        },
        "levels": {
            start.name: {key: level_interval(measured[key], level).as_json() for key in COLUMNS}
            for level, start in enumerate(starts)
        },
    }
