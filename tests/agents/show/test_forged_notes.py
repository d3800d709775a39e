"""Run notes and learning curves that somebody forged: every value in turn is another one."""

import json
import math
import shutil
from pathlib import Path
from typing import Any
from unicodedata import category

import numpy as np
import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.lineage import describe_lineage
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.learn import training
from arkanoid.agents.learn.curves import read_curve
from arkanoid.agents.show.page import as_html, as_markdown, table
from arkanoid.agents.show.plots import as_png, plot_curves
from arkanoid.agents.show.report import _model_row, _origin_rows
from helpers.runs import packaged_copy

OTHERS: list[Any] = [
    *(None, True, -1, 0, 1.5, 10**400, 1e308, -1e308, math.nan, "", "\x1b[31m", [], {}),
    json.loads("[" * 300 + "]" * 300),
]
DEEP = "[" * 10_000 + "]" * 10_000
NOTES: dict[str, Any] = {
    "versions": {"arkanoid": "0.1.0", "torch": "2.13.0"},
    "git": {"commit": "0123", "changed": False},
    "hardware": {"processor": "some", "cores": 2, "memory_gib": 23.5},
    "seed": 0,
    "outcome": "finished",
    "sessions": [{"started": "2026-01-01T00:00:00.000", "seconds": 27.4, "from": 0, "to": 2048}],
    "timesteps": 2048,
    "weights": "5a95",
    "lineage": {"kind": "model", "name": "run/best.zip", "decisions": 4096, "weights": "a07f"},
    "trackers": {"mlflow": "0123"},
}


def ways(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths to all values in tables and lists."""
    if not isinstance(value, dict | list):
        return []
    items = value.items() if isinstance(value, dict) else enumerate(value)
    return [way for key, one in items for way in ((*path, key), *ways(one, (*path, key)))]


def forged_notes(way: tuple[Any, ...], text: str) -> str:
    """Return the notes as JSON with another text at one place."""
    notes = json.loads(json.dumps(NOTES))
    table: Any = notes
    for key in way[:-1]:
        table = table[key]
    table[way[-1]] = "HERE"
    return json.dumps(notes).replace('"HERE"', text)


@pytest.fixture
def run(tmp_path: Path) -> RunFolder:
    """A copy of the packaged run."""
    return packaged_copy(tmp_path / "run")


def show(run: RunFolder) -> str:
    """Return what a report shows of a run's notes."""
    rows = [[""] * 7, _model_row(ModelFile.find(str(run.path)))]
    notes = run.read_notes()
    rows += [[*row, "", "", "", "", ""] for row in _origin_rows([notes])]
    rows.append([describe_lineage(notes.get("lineage")), *[""] * 6])
    return str(table(rows))


@pytest.mark.parametrize("way", ways(NOTES), ids=str)
def test_notes_of_other_values_are_named_or_shown(way: tuple[Any, ...], run: RunFolder) -> None:
    """10**400 seconds had a traceback."""
    for text in (*map(json.dumps, OTHERS), DEEP):
        run.notes.write_text(forged_notes(way, text))
        try:
            shown = show(run)
        except SettingsError as error:
            assert str(run.notes) in str(error)  # noqa: PT017
        else:
            assert all(line.isprintable() for line in shown.splitlines())
            run.add_notes(outcome="finished")


def test_what_notes_say_beyond_that_is_left_out(run: RunFolder) -> None:
    """Lists in lists, which can be read, were too deep to be written again."""
    for text in map(json.dumps, OTHERS):
        run.notes.write_text(json.dumps(NOTES)[:-1] + f', "more": {text}}}')
        run.add_notes(outcome="finished")
        assert run.read_notes() == NOTES


def test_notes_may_lack_anything(run: RunFolder) -> None:
    for key in NOTES:
        run.notes.write_text(json.dumps({name: NOTES[name] for name in NOTES if name != key}))
        assert "finished" in show(run) or key == "outcome"
    for key in NOTES["sessions"][0]:
        session = {name: one for name, one in NOTES["sessions"][0].items() if name != key}
        run.notes.write_text(json.dumps({**NOTES, "sessions": [session]}))
        with pytest.raises(SettingsError, match="damaged"):
            run.read_notes()


def test_reproduce_prints_nothing_that_a_terminal_obeys(
    run: RunFolder, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It printed the hash and the origin of somebody else's run as they were."""
    notes = {**NOTES, "weights": "\x1b[31mred", "versions": {"\x1b[2J": "\x1b[31m"}}
    notes["lineage"] = {**NOTES["lineage"], "name": "\x1b[32mgreen"}
    run.notes.write_text(json.dumps(notes))
    shutil.copy(run.model, run.start)

    def train(experiment: Any, again: RunFolder, **options: Any) -> str:
        again.add_notes(weights="5a95")
        return "finished"

    monkeypatch.setattr(training, "train", train)
    assert cli.main(["reproduce", str(run.path)]) == 1
    out = capsys.readouterr().out
    assert r"\x1b[31mred" in out
    assert r"\x1b[2J" in out
    assert r"\x1b[32mgreen" in out
    assert all(line.isprintable() for line in out.splitlines())


@pytest.mark.parametrize("text", [*map(json.dumps, OTHERS), DEEP, "Infinity"])
@pytest.mark.parametrize("key", ["timesteps", "rollout/ep_rew_mean"])
def test_curves_of_other_values_are_named_or_drawn(key: str, text: str, run: RunFolder) -> None:
    """1e308 had a traceback, and NaN a warning for each point."""
    rows = [{"timesteps": 256 * row, "rollout/ep_rew_mean": 0.5} for row in range(1, 5)]
    lines = [json.dumps(row) for row in rows]
    lines[1] = json.dumps({**rows[1], key: "HERE"}).replace('"HERE"', text)
    run.curve.write_text("\n".join(lines) + "\n")
    try:
        curve = read_curve(run.curve)
    except SettingsError as error:
        assert f"{run.curve}: line 2 " in str(error)  # noqa: PT017
    else:
        assert as_png(plot_curves([curve, curve]), 50)


def test_a_curve_without_a_finite_value_is_not_drawn() -> None:
    curve = [{"timesteps": step, "rollout/ep_rew_mean": np.nan} for step in (1, 2)]
    assert as_png(plot_curves([curve]), 50)


def test_a_page_shows_what_a_terminal_would_obey() -> None:
    facts: dict[str, Any] = {
        **{"name": "\x1b[31m", "env_id": "a", "inputs": "b", "training_levels": "\x07"},
        **{"timesteps": 1, "models": [], "origin": [["\x1b[2J", "\x00"]], "curves": 0},
        **{"lineages": ["\x1b[32m"], "suites": [], "settings": ""},
    }
    pictures = {"play.gif": b""}
    for page in (as_markdown(facts, {"play.gif": "play.gif"}), as_html(facts, pictures)):
        assert r"\x1b[31m" in page.replace("\\[", "[").replace("\\\\", "\\")
        assert {letter for letter in page if category(letter) == "Cc"} == {"\n"}


def test_a_report_names_the_commits_of_all_its_runs() -> None:
    """Once it named that of the first run, whatever the others were trained with."""
    runs = [{"git": {"commit": commit, "changed": False}} for commit in ("a1", "b2", "a1")]
    rows = list(_origin_rows([*runs, {"git": None}]))
    assert rows == [["git: commit", "a1, b2"], ["git: changed", False]]
