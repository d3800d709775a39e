"""Films, the window, plots and reports of trained agents."""

import json
import os
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.agents import cli
from arkanoid.agents.commands.evaluate import group_by_experiment
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.lineage import find_model
from arkanoid.agents.experiment.packaged import DEFAULT_AGENT, find_agent, packaged_agents
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.seeds import Purpose, spread_seeds
from arkanoid.agents.experiment.settings import BASELINES, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.curves import STEP
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.baselines import make_baseline
from arkanoid.agents.measure.comparison import COLUMNS, compare
from arkanoid.agents.measure.episodes import play_episodes
from arkanoid.agents.measure.suites import WHOLE_GAMES, EpisodeStart, find_starts
from arkanoid.agents.show.frames import can_be_smooth, frame_rate, play_frames
from arkanoid.agents.show.page import as_html, code, escape, table, write_page
from arkanoid.agents.show.plots import as_png, mean_curve, plot_levels, plot_policies
from helpers.repository import ROOT
from helpers.runs import facts_with, packaged_copy
from imageio_ffmpeg import count_frames_and_secs
from matplotlib.text import Text
from PIL import Image
from stable_baselines3 import PPO

SMALL = [("training.timesteps", "1024"), ("training.worlds", "8"), ("ppo.n_steps", "64")]
SMALL += [("ppo.batch_size", "256"), ("evaluation.episodes", "2"), ("env.max_decisions", "200")]
SMALL += [("evaluation.level_episodes", "1"), ("evaluation.planner_episodes", "1")]
SMALL += [("evaluation.suites", '["games", "named"]'), ("evaluation.film_seconds", "1")]


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Two runs that differ in nothing but their seeds."""
    output = ("output", str(tmp_path_factory.mktemp("runs")))
    paths = []
    for seed in ("0", "1"):
        experiment = load_experiment("quick", [*SMALL, output, ("seed", seed)])
        run = RunFolder.create(experiment)
        train(experiment, run)
        paths.append(str(run.path))
    return paths


def test_a_game_shown_tick_by_tick_is_the_game_that_is_evaluated() -> None:
    experiment = load_experiment("quick", [("env.max_decisions", "300"), ("evaluation.seed", "77")])
    worlds = make_worlds(experiment, 1)
    policy = make_baseline("ball-follower", worlds, 0)
    played = play_episodes(worlds, policy, spread_seeds(77, Purpose.EVALUATION, 1))
    frames = {
        smooth: list(play_frames(experiment, policy, smooth=smooth)) for smooth in (False, True)
    }
    decisions = int(played["steps"][0, 0])
    # The last picture shows the game before the step that ends it.
    assert len(frames[0]) == decisions
    assert 4 * decisions - 4 < len(frames[1]) <= 4 * decisions
    for decision, frame in enumerate(frames[0]):
        np.testing.assert_array_equal(frame.picture, frames[1][4 * decision].picture)
        assert frame[1:] == frames[1][4 * decision][1:]
    assert frames[0][-1].score <= played["score"][0, 0]
    assert (frame_rate(experiment, False), frame_rate(experiment, True)) == (15, 60)


def test_stacked_pictures_and_sticky_actions_are_not_shown_tick_by_tick() -> None:
    stacked = [("env.observation", "rgb"), ("env.stack", "2"), ("network.features", "auto")]
    stacked += [("env.landing", "false")]
    assert not can_be_smooth(load_experiment("quick", stacked))
    assert not can_be_smooth(load_experiment("quick", [("env.sticky_action", "0.1")]))
    assert can_be_smooth(load_experiment("quick"))


def test_a_film_begins_on_the_level_that_is_asked_for() -> None:
    experiment = load_experiment("quick")
    policy = make_baseline("no-op", make_worlds(experiment, 1), 0)
    (start,) = find_starts(experiment, "comb")
    first, other = (next(play_frames(experiment, policy, s)) for s in (WHOLE_GAMES, start))
    assert (first.round, other.round) == (1, 6)
    assert (first.picture != other.picture).any()


@pytest.mark.parametrize(("name", "rate"), [("x.gif", 15), ("x.mp4", 60)])
def test_a_film_has_the_length_that_is_asked_for(
    runs: list[str], tmp_path: Path, name: str, rate: int
) -> None:
    out = tmp_path / name
    assert cli.main(["film", runs[0], str(out), "--seconds", "2", "--level", "moat"]) == 0
    if name.endswith(".mp4"):
        assert count_frames_and_secs(str(out)) == (2 * rate, pytest.approx(2))
        return
    # A GIF joins equal pictures into one that lasts longer.
    with Image.open(out) as film:
        durations = []
        for index in range(film.n_frames):  # type: ignore[attr-defined]
            film.seek(index)
            durations.append(film.info["duration"])
    assert sum(durations) == pytest.approx(2000, abs=10)
    assert len(durations) > 3


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["x.avi"], "x.avi"),
        (["x.gif", "--seconds", "-1"], "--seconds"),
        (["x.gif", "--level", "no_such"], "no_such"),
        (["x.gif", "--level", "warden"], "'warden' has the boss"),
        (["no_such_folder/x.gif"], "no_such_folder"),
    ],
)
def test_a_film_that_cannot_be_made_is_a_mistake(
    runs: list[str], arguments: list[str], word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["film", runs[0], *arguments]) == 2
    assert word in capsys.readouterr().err


def test_watch_shows_games_until_the_window_is_closed(
    runs: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from arkanoid.envs.play import show, window

    shown: list[np.ndarray] = []

    class Show(window.Window):
        def show(self, frame: np.ndarray) -> bool:
            shown.append(frame)
            if len(shown) >= 1500:
                self.close()
            return super().show(frame) if len(shown) < 3 else not self.closed

    monkeypatch.setitem(os.environ, "SDL_VIDEODRIVER", "dummy")
    monkeypatch.setattr(show, "Window", Show)
    assert cli.main(["watch", runs[0]]) == 0
    out = capsys.readouterr().out
    assert re.search(r"^game 1: score \d+, round 1$", out, re.MULTILINE)
    assert "game 2" in out
    assert shown[0].dtype == np.uint8


def test_runs_that_differ_in_their_seeds_are_one_agent(runs: list[str], tmp_path: Path) -> None:
    models = [ModelFile.find(run) for run in runs]
    assert group_by_experiment(models, []) == {"agent": models}
    other = load_experiment("quick", [*SMALL, ("output", str(tmp_path)), ("network.hidden", "[8]")])
    run = RunFolder.create(other)
    third = ModelFile(run, run.model)
    assert group_by_experiment([*models, third], []) == {"quick": models, "quick#2": [third]}
    game = RunFolder.create(replace(other, env={"lives": 1}))
    with pytest.raises(SettingsError, match="another 'env_id' or 'env'"):
        group_by_experiment([*models, ModelFile(game, game.model)], [])


def test_each_agent_has_a_name_of_its_own(tmp_path: Path) -> None:
    """An agent called "random" lost its row to the baseline, and of x, x and x#2 two were left."""
    names = [*BASELINES, "x", "x", "x#2", "x"]
    models = []
    for index, name in enumerate(names, 1):
        size = ("network.hidden", f"[{index}]")
        other = load_experiment("quick", [*SMALL, ("output", str(tmp_path)), size])
        run = RunFolder.create(replace(other, name=name))
        models.append(ModelFile(run, run.model))
    agents = group_by_experiment(models, [])
    assert list(agents.values()) == [[model] for model in models]
    assert [name.partition("#")[0] for name in agents] == [name.partition("#")[0] for name in names]
    assert agents.keys().isdisjoint(BASELINES)
    with pytest.raises(ValueError, match="name of a baseline"):
        compare(models[0].run.experiment(), {"random": []})


def test_names_in_plots_are_no_formulas(runs: list[str]) -> None:
    """The name "$^$" was an error of matplotlib's, and "_x" was missing in the legend."""
    names = ["$^$", "_x", r"$\alpha$"]
    measured = {key: np.ones((1, 2, 2)) for key in COLUMNS}
    results = dict.fromkeys(names, measured)
    starts = [EpisodeStart("$_$", {}), EpisodeStart("_", {})]
    for figure in (plot_policies("$}$", results), plot_levels("$}$", starts, results)):
        assert as_png(figure, 50)
        shown = {text.get_text() for text in figure.findobj(Text)}
        assert {*names, "$}$"} <= shown
        assert not any(text.get_parse_math() for text in figure.findobj(Text) if text.get_text())


def test_a_model_given_twice_is_refused(
    runs: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    """Two equal models would make an interval of no width."""
    assert cli.main(["evaluate", runs[0], runs[1], runs[0]]) == 2
    assert "twice" in capsys.readouterr().err


def test_evaluate_draws_plots(runs: list[str], tmp_path: Path) -> None:
    folder = tmp_path / "plots"
    assert cli.main(["evaluate", *runs, "--plots", str(folder)]) == 0
    assert {path.name for path in folder.iterdir()} == {
        "games.png",
        "named.png",
        "named-levels.png",
    }
    for path in folder.iterdir():
        picture = np.asarray(Image.open(path))
        assert picture.ndim == 3
        assert picture.std() > 1


class Elements(HTMLParser):
    """Notes elements, their sources and the text, and checks that each element is closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.sources: list[str] = []
        self.open: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.sources += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_a_report_is_one_page_that_needs_no_other_file(runs: list[str], tmp_path: Path) -> None:
    out = tmp_path / "report.html"
    assert cli.main(["report", *runs, "--out", str(out)]) == 0
    text = out.read_text(encoding="utf-8")
    page = Elements(text)
    assert page.open == []
    # Curves, policies of both suites, levels of the named one, and the film.
    assert page.tags.count("img") == 5
    assert all(source.startswith("data:image/") for source in page.sources)
    assert "http:" not in text
    assert "https:" not in text
    # The agent at play.
    assert page.tags.count("iframe") == 1
    assert page.tags.count("table") == 7
    for word in ("switchback", "planner", "interquartile", "learning_rate = 0.002", "2 training"):
        assert word in text
    for run in runs:
        assert Path(run).name in page.text


def test_a_report_as_markdown_has_its_pictures_in_a_folder_beside_it(
    runs: list[str], tmp_path: Path
) -> None:
    out = tmp_path / "report.md"
    arguments = ["--evaluation.suites", '["games"]', "--evaluation.baselines", '["no-op"]']
    assert cli.main(["report", runs[0], "--out", str(out), *arguments]) == 0
    names = re.findall(r"!\[[^]]*\]\(([^)]*)\)", out.read_text(encoding="utf-8"))
    assert names == ["report/curves.png", "report/games.png", "report/play.gif"]
    for name in names:
        assert (tmp_path / name).stat().st_size > 1000


# Each means something in HTML, in Markdown, or in both.
HOSTILE = [
    "<script>alert(1)</script>",
    "a | b",
    "[link](javascript:alert(1))",
    "![picture](http://example.org/x.png)",
    "**bold** _slanted_ ~~gone~~ `code`",
    "ends with #",
    "&amp; \\| \\",
    "two\n\n# lines",
]


@pytest.mark.parametrize("name", HOSTILE)
def test_a_page_shows_names_as_they_are(name: str) -> None:
    """Names of runs, levels and settings are other people's data; none may change the page."""
    pictures = {"x.png": b"png", "play.gif": b"gif"}
    page, plain = (Elements(as_html(facts_with(each), pictures)) for each in (name, "plain"))
    assert page.open == []
    # The same elements as with a harmless name, and no sources but the pictures.
    assert page.tags == plain.tags
    assert page.sources == ["data:image/png;base64,cG5n", "data:image/gif;base64,Z2lm"]
    shown = " ".join(name.split())
    assert page.text.count(shown) >= 8


def test_a_page_as_markdown_refers_to_its_pictures(tmp_path: Path) -> None:
    write_page(tmp_path / "my page.md", facts_with("x"), {"x.png": b"png", "play.gif": b"gif"})
    assert (tmp_path / "my page" / "x.png").read_bytes() == b"png"
    assert "](my%20page/x.png)" in (tmp_path / "my page.md").read_text(encoding="utf-8")


def test_tables_and_code_are_markdown() -> None:
    assert (
        table([["head", "1"], ["nested_rings", 2]])
        == "| head | 1 |\n| --- | ---: |\n| nested_rings | 2 |"
    )
    assert code("x = '```'") == "````toml\nx = '```'\n````"
    assert escape(table([["a"]])) == table([["a"]])


def test_the_mean_curve_is_read_at_the_same_decisions() -> None:
    """Of straight lines the mean is a straight line, however often each was measured."""
    curves = [
        [{STEP: step, "y": slope * step, "x": 0} for step in range(first, 1000, every)]
        for slope, first, every in ((1.0, 10, 10), (3.0, 0, 37))
    ]
    steps, means, lows, highs = mean_curve(curves, "y")
    assert (steps[0], steps[-1]) == (10, 990)
    np.testing.assert_allclose(means, 2 * steps)
    # Of two runs a resample is of one, of the other, or of both.
    np.testing.assert_allclose(lows, steps)
    np.testing.assert_allclose(highs, 3 * steps)


def evaluated(words: list[str], capsys: pytest.CaptureFixture[str]) -> Any:
    """Return what `arkanoid evaluate --json` says of whole games."""
    assert cli.main(["evaluate", *words, "--json", "--evaluation.suites", '["games"]']) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("name", packaged_agents())
def test_packaged_agents_play_by_their_names(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """All are far above the ball-follower."""
    arguments = ["--evaluation.episodes", "20", "--evaluation.baselines", '["ball-follower"]']
    results = evaluated([name, *arguments], capsys)["suites"]["games"]["policies"]
    agent, follower = (results[name]["summary"] for name in ("agent", "ball-follower"))
    assert agent["cleared"]["mean"]["estimate"] >= 0.9
    assert agent["hits"]["mean"]["low"] > 3 * follower["hits"]["mean"]["high"]
    assert cli.main(["film", name, str(tmp_path / "x.gif"), "--seconds", "0.2"]) == 0


def test_without_a_name_the_default_agent_plays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["--evaluation.episodes", "1", "--evaluation.baselines", "[]"]
    arguments += ["--env.max_decisions", "300"]
    first, second = (evaluated([*named, *arguments], capsys) for named in ([], [DEFAULT_AGENT]))
    assert first == second
    assert cli.main(["film", str(tmp_path / "x.gif"), "--seconds", "0.2"]) == 0


@pytest.mark.parametrize("name", packaged_agents())
def test_packaged_agents_are_those_of_their_reports(name: str) -> None:
    """Each is the best model, by validation, of one of the published runs of its config."""
    model = ModelFile.find(name)
    notes, described = model.run.read_notes(), model.describe()
    assert (notes["outcome"], notes["git"]["changed"]) == ("finished", False)
    published = load_experiment(name, [])
    assert replace(model.experiment(), seed=published.seed) == published
    report = (ROOT / "docs" / "results" / f"{name}.md").read_text(encoding="utf-8")
    cells = [described["seed"], "best.zip", notes["timesteps"], "[^|]*", "finished"]
    row = " \\| ".join(map(str, [*cells, described["sha256"][:16]]))
    assert re.search(row, report), row
    assert notes["git"]["commit"] in report
    # stable-baselines3 reads them, too.
    PPO.load(model.path, device="cpu")


def test_a_folder_goes_before_a_packaged_agent_of_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    own = packaged_copy(Path(DEFAULT_AGENT))
    assert ModelFile.find(DEFAULT_AGENT).path == own.model
    assert find_model(DEFAULT_AGENT) == own.model
    assert ModelFile.find(None).path == find_agent(None) / "best.zip"
    with pytest.raises(SettingsError, match=", ".join(packaged_agents())):
        ModelFile.find("lit")
