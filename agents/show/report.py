"""What a report says about an agent: a model card, learning curves, results and a film."""

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ..browser import browser_agent, make_page
from ..experiment.errors import SettingsError
from ..experiment.lineage import describe_lineage
from ..experiment.reading import to_toml
from ..experiment.runs import ModelFile
from ..experiment.settings import Experiment
from ..learn.curves import read_curve
from ..learn.model import load_policy
from ..measure.comparison import (
    AGENT,
    COLUMNS,
    TITLES,
    Results,
    compare,
    describe_suite,
    level_interval,
    summary_rows,
)
from ..measure.policy import Policy
from ..measure.suites import Suite, make_suites
from .frames import film_policy
from .plots import as_png, plot_curves, plot_levels, plot_policies


def describe_agent(
    models: Sequence[ModelFile], overrides: list[tuple[str, str]]
) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Measure the models of one agent; return facts and pictures for `page.write_page`."""
    experiment = models[0].run.experiment(overrides)
    policies = [load_policy(model, experiment) for model in models]
    curves = [curve for curve in (read_curve(model.run.curve) for model in models) if curve]
    pictures = {"play.gif": _film(experiment, policies[0])}
    if curves:
        pictures["curves.png"] = _png(plot_curves(curves))
    suites = []
    for name, results in compare(experiment, {AGENT: policies}).items():
        suite = make_suites(experiment)[name]
        suites.append(_suite_facts(name, suite, results))
        pictures[f"{name}.png"] = _png(plot_policies(name, results))
        if suites[-1]["levels"]:
            pictures[f"{name}-levels.png"] = _png(plot_levels(name, suite.starts, results))
    facts = {
        "name": experiment.name,
        "env_id": experiment.env_id,
        "inputs": experiment.inputs,
        "training_levels": experiment.config.plain()["levels"],
        "timesteps": experiment.training.timesteps,
        "models": [_model_row(model) for model in models],
        "lineages": sorted(
            {
                sentence
                for model in models
                if (sentence := describe_lineage(model.run.read_notes().get("lineage")))
            }
        ),
        "origin": list(_origin_rows([model.run.read_notes() for model in models])),
        "curves": len(curves),
        "suites": suites,
        "settings": to_toml(models[0].run.experiment()),
    }
    return facts, pictures


def show_alive(model: ModelFile, overrides: list[tuple[str, str]]) -> str:
    """Return a page on which the agent plays, HTML; an empty text if no browser can show it.

    It is of agents whose network has a kernel, and where the game can be made for browsers.
    """
    from ...envs.browser.shipped import offers_module

    if not offers_module():
        return ""
    try:
        return make_page([browser_agent(model, model.run.experiment(overrides))], opens="watch")
    except (SettingsError, ImportError):
        return ""


def _model_row(model: ModelFile) -> list[object]:
    notes, described = model.run.read_notes(), model.describe()
    seconds = sum(session["seconds"] for session in notes.get("sessions", []))
    return [
        described["run"],
        described["seed"],
        described["file"],
        notes.get("timesteps", "?"),
        f"{seconds / 60:.1f} min",
        notes.get("outcome", "?"),
        described["sha256"][:16],
    ]


def _origin_rows(runs: Sequence[Mapping[str, Any]]) -> Iterator[list[object]]:
    """Yield one row for each version, and for each fact about the commit and the machine.

    Where the notes of the runs differ, the row has all their values.
    """
    for table in ("versions", "git", "hardware"):
        facts = [notes.get(table) or {} for notes in runs]
        for key in dict.fromkeys(chain.from_iterable(facts)):
            values = [known[key] for known in facts if key in known]
            different = list(dict.fromkeys(map(str, values)))
            yield [f"{table}: {key}", values[0] if len(different) == 1 else ", ".join(different)]


def _suite_facts(name: str, suite: Suite, results: Mapping[str, Results]) -> dict[str, Any]:
    """Return the tables of a suite: all policies, and, of several levels, the agent on each."""
    rows = [["level", *COLUMNS.values()]]
    for level, start in enumerate(suite.starts):
        cells = (str(level_interval(results[AGENT][key], level)) for key in COLUMNS)
        rows.append([start.name, *cells])
    return {
        "name": name,
        "heading": describe_suite(name, suite),
        "summaries": [summary_rows(results, key, title) for key, title in TITLES.items()],
        "levels": rows if len(suite.starts) > 1 else [],
    }


def _png(figure: Figure) -> bytes:
    return as_png(figure, dpi=100)


def _film(experiment: Experiment, policy: Policy) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "play.gif"
        film_policy(experiment, policy, path)
        return path.read_bytes()
