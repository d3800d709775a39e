"""The agent against the baselines: what `evaluate` measures and shows."""

from collections.abc import Mapping
from typing import Any

from .baselines import Policy, make_baselines
from .episodes import play_episodes
from .intervals import Interval, bootstrap_interval
from .settings import Experiment
from .worlds import make_worlds

# The table's columns: what is measured, and its heading.
COLUMNS = {
    "score": "score",
    "hits": "brick hits",
    "round": "round reached",
    "lives": "lives left",
    "return": "return",
    "steps": "decisions",
}

# Policy's name -> measure -> interval over the episodes.
Comparison = dict[str, dict[str, Interval]]


def compare(experiment: Experiment, agent: Policy) -> Comparison:
    """Let the agent and the baselines play the experiment's evaluation episodes.

    All play the same seeds, and each episode depends on nothing but its seed and the policy, so
    that the same agent always gets the same numbers.
    """
    settings = experiment.evaluation
    worlds = make_worlds(experiment, settings.episodes)
    try:
        policies = {"agent": agent, **make_baselines(worlds, settings.seed)}
        results = {
            name: play_episodes(worlds, policy, settings.seed) for name, policy in policies.items()
        }
    finally:
        worlds.close()
    return {
        name: {measure: bootstrap_interval(result[measure]) for measure in COLUMNS}
        for name, result in results.items()
    }


def as_table(comparison: Comparison) -> str:
    """Return a comparison as text: a row a policy, a column a measure, mean ± 95 % interval."""
    rows = [["", *COLUMNS.values()]]
    rows += [
        [name, *(str(measured[measure]) for measure in COLUMNS)]
        for name, measured in comparison.items()
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in rows
    ]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def as_json(experiment: Experiment, comparison: Comparison) -> dict[str, Any]:
    """Return a comparison as what `json.dump` takes, with what is needed to repeat it."""
    policies: Mapping[str, Any] = {
        name: {measure: interval._asdict() for measure, interval in measured.items()}
        for name, measured in comparison.items()
    }
    settings = experiment.evaluation
    return {
        "env_id": experiment.env_id,
        "env": experiment.env,
        "episodes": settings.episodes,
        "first_seed": settings.seed,
        "deterministic": settings.deterministic,
        "policies": policies,
    }
