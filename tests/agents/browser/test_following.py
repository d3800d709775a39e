"""What is said of a run that is followed: in training, stopped, finished, damaged or gone."""

import json
import shutil
import threading
from pathlib import Path
from typing import Any

import pytest
from arkanoid.agents.browser import following
from arkanoid.agents.browser.following import FollowedRun
from arkanoid.agents.browser.levels import asked_levels
from arkanoid.agents.browser.server import PageServer
from arkanoid.agents.experiment import runs
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import Experiment
from arkanoid.agents.learn.portable import portable_network
from arkanoid.agents.learn.training import train
from arkanoid.envs.browser import shipped
from filelock import FileLock
from helpers.processes import PATIENCE
from helpers.runs import sentence, small

VALIDATED = {"validation.every": "1024", "validation.levels": '["seeds:0-1"]'}


@pytest.fixture(autouse=True)
def _looks_each_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(following, "_LEAST", 0.0)
    monkeypatch.setattr(following, "_SHARE", 0)


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> tuple[RunFolder, list[dict[str, Any]]]:
    """A run, and what was said whenever it wrote to its curves."""
    experiment = small(tmp_path_factory.mktemp("runs"), **VALIDATED)
    run = RunFolder.create(experiment)
    followed = FollowedRun(run, experiment)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(following, "_LEAST", 0.0)
        patch.setattr(following, "_SHARE", 0)
        said: list[dict[str, Any]] = []
        train(experiment, run, on_log=lambda *_: said.append(followed.news()))
    return run, said


@pytest.fixture
def run(trained: tuple[RunFolder, Any], tmp_path: Path) -> RunFolder:
    """A copy of it."""
    shutil.copytree(trained[0].path, tmp_path / "run")
    return RunFolder(tmp_path / "run")


def follow(run: RunFolder) -> FollowedRun:
    return FollowedRun(run, run.experiment())


def left_as(run: RunFolder, **notes: Any) -> None:
    """Let a run's notes be those that it had before its end."""
    kept = run.read_notes()
    kept.pop("timesteps")
    run.notes.write_text(json.dumps(kept | notes), encoding="utf-8")


def test_a_training_is_followed_to_its_end(
    trained: tuple[RunFolder, list[dict[str, Any]]],
) -> None:
    run, said = trained
    assert {news["state"] for news in said} == {"training"}
    done = [news["done"] for news in said]
    assert done == sorted(done)
    assert len(set(done)) > 4
    # As many agents as checkpoints: at 0, 512, 1024 and 1536 decisions.
    versions = [news["version"] for news in said]
    assert len(dict.fromkeys(versions)) == 4
    assert said[-1]["agent"] == "The agent after 1,536 decisions plays."
    news = follow(run).news()
    assert (news["state"], news["said"], news["done"]) == ("finished", "Finished.", 1.0)
    assert news["agent"] == "The best model by validation plays."


def test_the_curves_are_those_of_the_file(run: RunFolder) -> None:
    rows = [json.loads(line) for line in run.curve.read_text(encoding="utf-8").splitlines()]
    curves = {curve["title"]: curve for curve in follow(run).news()["curves"]}
    assert {"return, training", "brick hits, training", "cleared rate, validation"} <= set(curves)
    measured = [row for row in rows if "validation/return" in row]
    shown = curves["return, validation"]
    assert shown["steps"] == [row["timesteps"] for row in measured]
    assert shown["values"] == pytest.approx([row["validation/return"] for row in measured], 1e-4)


def test_long_curves_are_drawn_by_some_of_their_points(run: RunFolder) -> None:
    rows = [{"timesteps": step, "validation/score": float(step)} for step in range(5000)]
    run.curve.write_text("".join(f"{json.dumps(row)}\n" for row in rows), encoding="utf-8")
    [curve] = follow(run).news()["curves"]
    assert len(curve["steps"]) == len(curve["values"]) == 200
    assert (curve["steps"][0], curve["steps"][-1]) == (0, 4999)


def test_values_that_json_has_no_word_for_are_left_out(run: RunFolder) -> None:
    """A training that diverges writes NaN; the page could not have read its curves."""
    run.curve.write_text(
        '{"timesteps": 1, "validation/score": NaN}\n{"timesteps": 2, "validation/score": 5}\n',
        encoding="utf-8",
    )
    news = follow(run).news()
    json.dumps(news, allow_nan=False)
    assert news["curves"][0]["steps"] == [2]


def test_a_checkpoint_plays_as_the_model_of_the_same_weights(run: RunFolder) -> None:
    """The last checkpoint and the last model hold the same weights, in two formats."""
    last = portable_network(ModelFile(run, run.model), run.experiment())
    run.best.unlink()
    assert follow(run).network() == last
    left_as(run, outcome="unfinished")
    followed = follow(run)
    assert followed.network() == last
    assert followed.news()["version"].startswith("checkpoint.pt")


@pytest.mark.parametrize("outcome", ["unfinished", "interrupted"])
def test_a_run_that_nobody_trains_any_more_has_stopped(run: RunFolder, outcome: str) -> None:
    sessions = run.read_notes()["sessions"]
    left_as(run, outcome=outcome, sessions=[{**sessions[0], "to": 512}])
    news = follow(run).news()
    assert (news["state"], news["said"]) == ("stopped", "Stopped at 25 %.")
    with run.locked():  # somebody resumes it
        assert follow(run).news()["state"] == "training"


@pytest.mark.parametrize(
    ("pace", "left"), [(10.0, "2 min left"), (0.1, "2 h 51 min left"), (100.0, "10 s left")]
)
def test_how_long_it_will_take(run: RunFolder, pace: float, left: str) -> None:
    row = {"timesteps": 1024, "time/fps": pace}
    run.curve.write_text(f"{json.dumps(row)}\n", encoding="utf-8")
    with run.locked():
        assert follow(run).news()["said"] == f"Training: 50 %, {left}."


def test_why_validation_has_ended_it(run: RunFolder) -> None:
    left_as(run, outcome="cleared rate 0.990 reached at 99 decisions")
    said = follow(run).news()["said"]
    assert said == "Finished: cleared rate 0.990 reached at 99 decisions."


def test_a_run_before_its_first_checkpoint(tmp_path: Path) -> None:
    run = RunFolder.create(small(tmp_path))
    followed = follow(run)
    with run.locked():
        news = followed.news()
    assert (news["state"], news["version"], news["curves"]) == ("training", None, [])
    assert "has not written its first checkpoint" in news["agent"]
    assert followed.network() is None
    assert "stopped before its first checkpoint" in followed.news()["agent"]


def test_a_last_line_that_is_half_written(run: RunFolder) -> None:
    before = follow(run).news()["curves"]
    with run.curve.open("a", encoding="utf-8") as file:
        file.write('{"timesteps": 99999, "validation/sc')
    assert follow(run).news()["curves"] == before


@pytest.mark.parametrize("name", ["curve.jsonl", "run.json"])
def test_files_that_are_damaged_are_told_in_a_sentence(run: RunFolder, name: str) -> None:
    followed = follow(run)
    before = followed.news()
    (run.path / name).write_text("{{{\n{{{\n", encoding="utf-8")
    news = followed.news()
    assert news["state"] == "lost"
    assert name in news["said"]
    assert news["curves"] == before["curves"]
    assert followed.network() is not None


def test_an_agent_that_is_damaged_is_told_in_a_sentence(run: RunFolder) -> None:
    run.best.write_bytes(b"no model")
    news = follow(run).news()
    assert news["version"] is None
    assert "best.zip" in news["agent"]
    assert news["curves"]


def test_a_folder_that_is_deleted(run: RunFolder) -> None:
    followed = follow(run)
    version, network = followed.news()["version"], followed.network()
    shutil.rmtree(run.path)
    news = followed.news()
    assert (news["state"], news["version"]) == ("lost", version)
    assert news["said"] == f"The folder {run.path} is gone."
    assert followed.network() == network


def test_looking_does_not_keep_a_training_from_its_run(
    run: RunFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Who looks holds the lock for a moment; a training that began then was refused."""
    assert not run.is_trained()
    monkeypatch.setattr(runs, "_A_LOOK", PATIENCE)
    look = FileLock(run.path / "lock", thread_local=False)
    look.acquire()
    end = threading.Timer(0.2, look.release)
    end.start()
    with run.locked():
        assert run.is_trained()
    end.join()
    assert not run.is_trained()


def test_one_file_of_a_run_without_an_agent_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = RunFolder.create(small(tmp_path))
    page = tmp_path / "page.html"
    error = sentence(["web", "--model", str(run.path), "--out", str(page)], capsys)
    assert "stopped before its first checkpoint" in error
    assert not page.exists()


def test_a_page_is_offered_only_where_there_can_be_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """For a run without a model, a command was named that failed: it followed a missing model.

    Without a linker there is no page, and so no such command.
    """
    run = RunFolder.create(small(tmp_path))
    for offers in (True, False):
        monkeypatch.setattr(shipped, "offers_module", lambda offers=offers: offers)
        for command in ("evaluate", "watch"):
            error = sentence([command, str(run.path)], capsys)
            assert "the training has not ended" in error
            assert (f"watch {run.path} --web" in error) == ("--web" in error) == offers


def test_an_ended_run_whose_model_is_missing(
    run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    """The sentence named a page to follow it, whose command ended with the same sentence."""
    for model in (run.best, run.model):
        model.unlink(missing_ok=True)
    for command in (["evaluate", str(run.path)], ["watch", str(run.path), "--web", "--no-open"]):
        error = sentence(command, capsys)
        assert "model.zip is missing" in error
        assert "--web" not in error


def test_a_run_that_no_browser_can_play_is_refused(
    run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    run.best.write_bytes(b"no model")
    assert "damaged" in sentence(["watch", str(run.path), "--web", "--no-open"], capsys)


def test_what_is_served(run: RunFolder) -> None:
    with PageServer("<!doctype html>", 0, follow(run)) as server:
        assert server.find("/") == ("text/html; charset=utf-8", b"<!doctype html>")
        kind, news = server.find("/run.json") or ("", b"")
        assert (kind, json.loads(news)["state"]) == ("application/json", "finished")
        assert server.find("/agent") == ("application/octet-stream", follow(run).network())
        assert server.find("/config.toml") is None
    with PageServer("<!doctype html>", 0) as server:
        assert server.find("/run.json") is None
        assert server.find("/agent") is None


def test_levels_for_the_page(run: RunFolder, tmp_path: Path) -> None:
    experiment: Experiment = run.experiment()
    assert asked_levels(experiment, "spiral")["starts"] == [{"level": "spiral"}]
    seeds = asked_levels(experiment, "seeds:3-4")
    assert seeds["title"] == "seeds:3-4"
    assert [start["levelSeed"] for start in seeds["starts"]] == [3, 4]
    file = tmp_path / "mine.txt"
    file.write_text("r.........r\n", encoding="utf-8")
    [start] = asked_levels(experiment, str(file))["starts"]
    assert start["bricks"][:11] == "r.........r"
    assert not start["boss"]
    with pytest.raises(SettingsError, match="no level 'nowhere'"):
        asked_levels(experiment, "nowhere")


def test_a_slow_look_does_not_stop_the_news(
    run: RunFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first one loads libraries: no news came for a minute then."""
    monkeypatch.setattr(following, "_SHARE", 10**9)
    followed = follow(run)
    followed.news()
    assert followed._due - following.time.monotonic() < 60
