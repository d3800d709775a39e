"""What a report says about an agent: a model card, with curves, tables and a clip."""

import io
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ..experiment.runs import ModelFile
from ..experiment.schema import to_toml
from ..experiment.settings import Experiment
from ..learn.curves import read_curve
from ..learn.model import load_policy
from ..measure.comparison import (
    AGENT,
    COLUMNS,
    Comparison,
    Results,
    compare,
    level_interval,
    summarise,
)
from ..measure.suites import Suite, make_suites
from .clips import record_clip
from .page import Code, Heading, Part, Picture, Table, Text
from .plots import plot_curves, plot_levels, plot_policies

_STATISTICS = {"mean": "mean", "iqm": "interquartile mean"}


def describe_agent(models: Sequence[ModelFile], overrides: list[tuple[str, str]]) -> list[Part]:
    """Measure the models of one agent, and return the parts of a page about it."""
    experiment = models[0].run.experiment(overrides)
    policies = [load_policy(model.path, experiment) for model in models]
    comparison = compare(experiment, {AGENT: policies})
    parts: list[Part] = [Heading(f"Arkanoid: {experiment.name}", 1), *_card(experiment, models)]
    curves = [curve for curve in (read_curve(model.run.curve) for model in models) if curve]
    if curves:
        parts += [Heading("Learning curves"), Text(_curves_text(len(curves)))]
        parts.append(_drawn("curves.png", plot_curves(curves), "learning curves"))
    parts += _results(experiment, comparison, len(models))
    parts += [Heading("A game"), _clip(experiment, policies[0])]
    parts += [Heading("Settings"), Code(to_toml(models[0].run.experiment()))]
    return parts


def _card(experiment: Experiment, models: Sequence[ModelFile]) -> list[Part]:
    """Return what the model is, how it was made, and what it is good for."""
    levels = experiment.env.get("levels", "campaign")
    observation = experiment.env.get("observation", "vector")
    rows = [("run", "seed", "model", "decisions", "training", "ended", "SHA-256")]
    for model in models:
        about, described = model.run.about(), model.describe()
        seconds = sum(session["seconds"] for session in about.get("sessions", []))
        rows.append(
            (
                model.run.path.name,
                str(described["seed"]),
                model.path.name,
                f"{about.get('timesteps', '?')}",
                f"{seconds / 60:.1f} min",
                str(about.get("outcome", "?")),
                described["sha256"][:16],
            )
        )
    return [
        Heading("The model"),
        Text(
            f"Proximal policy optimisation (stable-baselines3) on {experiment.env_id}, which it "
            f"sees as {observation!r}; trained on the levels {levels!r}, "
            f"{experiment.training.timesteps} decisions with each of {len(models)} seeds. It is "
            "made to play this game and to be compared with; the tables say how well it does, "
            "level by level. Its weights are a network for this game's observation only."
        ),
        Table(tuple(rows)),
        Heading("Where it comes from", 3),
        Table((("", "value"), *_origin(models[0].run.about()))),
    ]


def _origin(about: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return versions, commit and hardware of a run, a row each."""
    tables = ("versions", "git", "hardware")
    return [
        (f"{table}: {key}", str(value))
        for table in tables
        for key, value in (about.get(table) or {}).items()
    ]


def _curves_text(runs: int) -> str:
    if runs == 1:
        return "One run: there is no interval."
    return f"Means over {runs} runs with their 95 % bootstrap intervals."


def _results(experiment: Experiment, comparison: Comparison, models: int) -> list[Part]:
    suites = make_suites(experiment)
    over = f"the {models} training seeds" if models > 1 else "the episodes"
    parts: list[Part] = [
        Heading("Results"),
        Text(
            f"Means with 95 % bootstrap intervals over {over}, stratified by level (10 000 "
            "resamples of a level, 2 000 of a suite). The planner is no agent: it looks ahead with "
            "the game itself, and is an upper bound."
        ),
    ]
    for name, results in comparison.items():
        suite = suites[name]
        parts += [Heading(f"{name}: {_size(suite)}", 3)]
        parts.append(_drawn(f"{name}.png", plot_policies(name, results), f"{name}: all policies"))
        for statistic, title in _STATISTICS.items():
            parts.append(_policies_table(results, statistic, title))
        if len(suite.starts) > 1:
            figure = plot_levels(name, suite.starts, results)
            parts.append(_drawn(f"{name}-levels.png", figure, f"{name}: cleared rate by level"))
            parts.append(_levels_table(suite, results[AGENT]))
    return parts


def _size(suite: Suite) -> str:
    if suite.whole:
        return f"{suite.episodes} whole games"
    return f"{len(suite.starts)} levels, {suite.episodes} episodes of each"


def _policies_table(results: Mapping[str, Results], statistic: str, title: str) -> Table:
    rows = [(title, *COLUMNS.values())]
    for name, measured in results.items():
        cells = (str(summarise(measured[key])[statistic]) for key in COLUMNS)
        rows.append((name, *cells))
    return Table(tuple(rows))


def _levels_table(suite: Suite, measured: Results) -> Table:
    """Return the agent's means on each level."""
    rows = [("level", *COLUMNS.values())]
    for level, start in enumerate(suite.starts):
        cells = (str(level_interval(measured[key], level)) for key in COLUMNS)
        rows.append((start.name, *cells))
    return Table(tuple(rows))


def _drawn(name: str, figure: Figure, text: str) -> Picture:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    return Picture(name, buffer.getvalue(), text)


def _clip(experiment: Experiment, policy: Any) -> Picture:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "play.gif"
        record_clip(experiment, policy, path)
        return Picture(path.name, path.read_bytes(), "the agent at play")
