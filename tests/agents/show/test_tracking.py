"""Trackers get what a training measures, and cannot end it.

The packages are large, so these tests use stand-ins; `make compat` trains with the real ones.
"""

import json
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.learn.curves import STEP, read_curve
from arkanoid.agents.show.tracking import Tracking
from helpers.processes import run_program
from helpers.runs import SMALL, sentence, small


class FakeWandb:
    """Stands in for the package `wandb`: it notes what it is told."""

    def __init__(self) -> None:
        self.started: list[dict[str, Any]] = []
        self.rows: list[dict[str, float]] = []
        self.summary: dict[str, float] = {}
        self.files: list[str] = []
        self.ended: list[int] = []
        self.breaks_at = -1

    def init(self, **keywords: Any) -> "FakeWandb":
        self.started.append(keywords)
        return self

    def define_metric(self, *names: str, **keywords: Any) -> None:
        pass

    def log(self, row: dict[str, float]) -> None:
        if len(self.rows) == self.breaks_at:
            raise RuntimeError("the server is gone\nand more")
        self.rows.append(row)

    def log_artifact(self, artifact: Any) -> None:
        pass

    def finish(self, exit_code: int) -> None:
        self.ended.append(exit_code)

    def Settings(self, **keywords: Any) -> Mapping[str, Any]:  # noqa: N802 (the package's name)
        return keywords

    def Artifact(self, name: str, type: str) -> Any:  # noqa: A002, N802
        assert type == "model"
        return SimpleNamespace(add_file=self.files.append)


class FakeMlflow:
    """Stands in for the package `mlflow`, its client and its entities."""

    def __init__(self) -> None:
        self.uri = ""
        self.parameters: dict[str, str] = {}
        self.metrics: list[tuple[str, float, int]] = []
        self.files: list[str] = []
        self.states: list[str] = []
        self.runs = 0

    def MlflowClient(self, tracking_uri: str) -> "FakeMlflow":  # noqa: N802
        self.uri = tracking_uri
        return self

    def Metric(self, key: str, value: float, timestamp: int, step: int) -> Any:  # noqa: N802
        return key, value, step

    def get_experiment_by_name(self, name: str) -> Any:
        return SimpleNamespace(experiment_id="7") if self.runs else None

    def create_experiment(self, name: str, artifact_location: str | None) -> str:
        assert artifact_location is not None
        return "7"

    def create_run(self, experiment: str, run_name: str) -> Any:
        self.runs += 1
        return SimpleNamespace(info=SimpleNamespace(run_id=f"run{self.runs}"))

    def update_run(self, run: str, status: str) -> None:
        self.states.append(status)

    def log_param(self, run: str, key: str, value: str) -> None:
        self.parameters[key] = value

    def log_batch(self, run: str, metrics: list[tuple[str, float, int]]) -> None:
        self.metrics += metrics

    def log_artifact(self, run: str, path: str, folder: str) -> None:
        self.files.append(path)

    def set_terminated(self, run: str, status: str) -> None:
        self.states.append(status)


@pytest.fixture
def wandb(monkeypatch: pytest.MonkeyPatch) -> FakeWandb:
    fake = FakeWandb()
    monkeypatch.setitem(sys.modules, "wandb", fake)
    for name in ("WANDB_MODE", "WANDB_PROJECT"):
        monkeypatch.delenv(name, raising=False)
    return fake


@pytest.fixture
def mlflow(monkeypatch: pytest.MonkeyPatch) -> FakeMlflow:
    fake = FakeMlflow()
    monkeypatch.setitem(sys.modules, "mlflow", fake)
    monkeypatch.setitem(sys.modules, "mlflow.entities", fake)
    monkeypatch.delenv("MLFLOW_TRACKING_URI", raising=False)
    return fake


def train(output: Path, *trackers: str) -> RunFolder:
    words = [f"--{key}={text}" for key, text in {**SMALL, "output": str(output)}.items()]
    options = [word for tracker in trackers for word in ("--track", tracker)]
    assert cli.main(["train", "quick", *words, *options]) == 0
    (path,) = output.iterdir()
    return RunFolder(path)


def test_both_trackers_get_what_the_run_keeps(
    wandb: FakeWandb, mlflow: FakeMlflow, tmp_path: Path
) -> None:
    run = train(tmp_path, "wandb", "mlflow")
    curve = read_curve(run.curve)
    expected = [{("decisions" if k == STEP else k): v for k, v in row.items()} for row in curve]
    assert wandb.rows == expected
    told = {(key, value, row[STEP]) for row in curve for key, value in row.items() if key != STEP}
    results = json.loads(run.evaluation.read_text())["suites"]["games"]["policies"]["agent"]
    means = {
        f"evaluation/games/{measure}": statistics["mean"]["estimate"]
        for measure, statistics in results["summary"].items()
    }
    assert wandb.summary == means
    assert set(mlflow.metrics) == told | {(k, v, curve[-1][STEP]) for k, v in means.items()}
    (start,) = wandb.started
    assert (start["mode"], start["project"], start["dir"]) == ("offline", "arkanoid", str(run.path))
    assert start["config"]["ppo"]["n_steps"] == 32
    assert mlflow.parameters["ppo.n_steps"] == "32"
    assert mlflow.uri.startswith("sqlite:///")
    assert str(run.path.resolve().as_posix()) in mlflow.uri
    assert wandb.files == mlflow.files == [str(run.model)]
    assert (wandb.ended, mlflow.states) == ([0], ["FINISHED"])
    assert run.read_notes()["trackers"] == {"wandb": start["id"], "mlflow": "run1"}


def test_environment_variables_of_the_user_count(
    wandb: FakeWandb, mlflow: FakeMlflow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WANDB_MODE", "disabled")
    monkeypatch.setenv("WANDB_PROJECT", "mine")
    monkeypatch.setenv("MLFLOW_TRACKING_URI", "http://localhost:5000")
    mlflow.runs = 1  # the experiment is there
    experiment = small(tmp_path)
    Tracking(["wandb", "mlflow"], experiment, RunFolder.create(experiment))
    (start,) = wandb.started
    assert (start["mode"], start["project"]) == ("disabled", "mine")
    assert mlflow.uri == "http://localhost:5000"


def test_a_resumed_training_continues_its_runs(
    wandb: FakeWandb, mlflow: FakeMlflow, tmp_path: Path
) -> None:
    experiment = small(tmp_path)
    folder = RunFolder.create(experiment)
    Tracking(["wandb", "mlflow"], experiment, folder).end(complete=False)
    Tracking(["wandb", "mlflow"], experiment, folder).end(complete=True)
    first, second = wandb.started
    assert first["id"] == second["id"]
    assert mlflow.runs == 1
    assert (wandb.ended, mlflow.states) == ([1, 0], ["KILLED", "RUNNING", "FINISHED"])


def test_a_tracker_that_fails_does_not_end_the_training(
    wandb: FakeWandb, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wandb.breaks_at = 2
    run = train(tmp_path, "wandb")
    assert run.read_notes()["outcome"] == "finished"
    assert "wandb fails and is left out: the server is gone\n" in capsys.readouterr().err
    assert len(wandb.rows) == 2


def test_a_tracker_that_cannot_start_gets_a_sentence(
    wandb: FakeWandb, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(**keywords: Any) -> None:
        raise RuntimeError("no API key")

    wandb.init = refuse  # type: ignore[method-assign, assignment]
    words = ["train", "quick", "--output", str(tmp_path), "--track", "wandb"]
    assert "cannot start: no API key" in sentence(words, capsys)


def test_a_missing_package_is_named_before_torch_is_loaded(tmp_path: Path) -> None:
    program = f"""
import sys
sys.modules["wandb"] = None
from arkanoid.agents import cli
status = cli.main(["train", "quick", "--track", "wandb", "--output", {str(tmp_path / "runs")!r}])
print(status, "torch" in sys.modules)
"""
    done = run_program(program)
    assert done.stdout.split() == ["1", "False"]
    assert re.search(r'wandb is missing: run `\S*pip install -e "\.\[wandb\]"`', done.stderr)
    assert not (tmp_path / "runs").exists()
