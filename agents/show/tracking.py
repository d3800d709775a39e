"""Experiment trackers: Weights & Biases and MLflow, both without a network unless the user says so.

A tracker gets the settings, the numbers of the learning curves, the evaluation at the end and the
model. Its package is imported when it starts.
"""

import logging
import os
import secrets
import sys
import time
import tomllib
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from ..experiment.errors import SettingsError
from ..experiment.files import quoted
from ..experiment.programs import command
from ..experiment.reading import to_toml
from ..experiment.runs import RunFolder
from ..experiment.settings import Experiment

# Names of projects and experiments, unless the user's environment variables say others.
_PROJECT = "arkanoid"
_LONGEST_PARAMETER = 6000  # letters, of MLflow


class Tracker(Protocol):
    """One tracker's run.

    Attributes:
        id: of the run there; a resumed training continues it.
        where: where its data lies, and how to look at it.
    """

    id: str
    where: str

    def log(self, step: int, numbers: Mapping[str, float]) -> None:
        """Keep numbers that were measured after ``step`` decisions."""
        ...

    def keep(self, results: Mapping[str, float], model: Path) -> None:
        """Keep the final evaluation and the model."""
        ...

    def end(self, complete: bool) -> None:
        """End the run; it is ``complete``, or the training was stopped or has failed."""
        ...


class WeightsAndBiases:
    """A run of Weights & Biases, in the run's folder; offline unless ``WANDB_MODE`` is set."""

    def __init__(self, experiment: Experiment, folder: RunFolder, known: str | None) -> None:
        mode = _wandb_mode()
        self._wandb = _import("wandb")
        name = folder.path.resolve().name
        self.id = known or f"{name}-{secrets.token_hex(4)}"
        self._run = self._wandb.init(
            project=os.environ.get("WANDB_PROJECT", _PROJECT),
            name=name,
            id=self.id,
            # Data of a run that is offline is joined when it is sent.
            resume=None if mode == "offline" else "allow",
            dir=str(folder.path),
            config=_plain(experiment),
            mode=mode,
            settings=self._wandb.Settings(silent=True, console="off"),
        )
        # Not W&B's own step, which may never fall: that of a resumed run does.
        self._run.define_metric("decisions")
        self._run.define_metric("*", step_metric="decisions")
        self.where = f"{folder.path / 'wandb'}"
        if mode == "offline":
            self.where += f"  ({command('wandb', 'sync', folder.path / 'wandb')}/offline-run-*)"

    def log(self, step: int, numbers: Mapping[str, float]) -> None:
        """Keep numbers that were measured after ``step`` decisions."""
        self._run.log({"decisions": step, **numbers})

    def keep(self, results: Mapping[str, float], model: Path) -> None:
        """Keep the results as the run's summary, and the model as an artifact."""
        self._run.summary.update(dict(results))
        artifact = self._wandb.Artifact(f"{self.id}-model", type="model")
        artifact.add_file(str(model))
        self._run.log_artifact(artifact)

    def end(self, complete: bool) -> None:
        """End the run."""
        self._run.finish(exit_code=0 if complete else 1)


class MLflow:
    """A run of MLflow, in a database in the run's folder unless ``MLFLOW_TRACKING_URI`` is set."""

    def __init__(self, experiment: Experiment, folder: RunFolder, known: str | None) -> None:
        uri, files = os.environ.get("MLFLOW_TRACKING_URI"), None
        if not uri:
            place = (folder.path / "mlflow").resolve()
            place.mkdir(exist_ok=True)
            uri, files = f"sqlite:///{(place / 'mlflow.db').as_posix()}", place / "artifacts"
        mlflow = _import("mlflow")
        logging.getLogger("mlflow").setLevel(logging.WARNING)
        self._entities: Any = import_module("mlflow.entities")
        self._step = 0
        self._client: Any = mlflow.MlflowClient(tracking_uri=uri)
        if known is not None:
            self.id = known
            self._client.update_run(known, status="RUNNING")
        else:
            self.id = self._begin(files, folder.path.resolve().name)
            for key, value in _flat(_plain(experiment)).items():
                self._client.log_param(self.id, key, str(value)[:_LONGEST_PARAMETER])
        self.where = f"{uri}  ({command('mlflow', 'ui --backend-store-uri', quoted(uri))})"

    def _begin(self, files: Path | None, name: str) -> str:
        """Begin a run; return its id."""
        title = os.environ.get("MLFLOW_EXPERIMENT_NAME", _PROJECT)
        found = self._client.get_experiment_by_name(title)
        if found is not None:
            number = found.experiment_id
        else:
            place = None if files is None else files.as_uri()
            number = self._client.create_experiment(title, artifact_location=place)
        return str(self._client.create_run(number, run_name=name).info.run_id)

    def log(self, step: int, numbers: Mapping[str, float]) -> None:
        """Keep numbers that were measured after ``step`` decisions."""
        self._step = step
        now = int(time.time() * 1000)
        metrics = [self._entities.Metric(key, value, now, step) for key, value in numbers.items()]
        self._client.log_batch(self.id, metrics=metrics)

    def keep(self, results: Mapping[str, float], model: Path) -> None:
        """Keep the results as metrics, and the model as an artifact."""
        self.log(self._step, results)
        self._client.log_artifact(self.id, str(model), "model")

    def end(self, complete: bool) -> None:
        """End the run."""
        self._client.set_terminated(self.id, "FINISHED" if complete else "KILLED")


TRACKERS: dict[str, Callable[[Experiment, RunFolder, str | None], Tracker]] = {
    "wandb": WeightsAndBiases,
    "mlflow": MLflow,
}


def check_installed(names: Sequence[str]) -> None:
    """Import the trackers' packages; ModuleNotFoundError, which the command line explains."""
    for name in names:
        _import(name)


def _import(name: str) -> Any:
    """Return a tracker's package, which sends nothing unless the user's variables say otherwise."""
    if _wandb_mode() == "offline":
        os.environ.setdefault("WANDB_ERROR_REPORTING", "false")
    if not os.environ.get("MLFLOW_TRACKING_URI"):
        os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")
    return import_module(name)


def _wandb_mode() -> str:
    return os.environ.get("WANDB_MODE") or "offline"


class Tracking:
    """The trackers of a training. A tracker that fails is left out, and the training goes on.

    Args:
        names: keys of `TRACKERS`.
        experiment: what is trained.
        folder: the run; its notes remember the trackers' ids.

    Raises:
        SettingsError: a tracker cannot start.
    """

    def __init__(self, names: Sequence[str], experiment: Experiment, folder: RunFolder) -> None:
        self._trackers: dict[str, Tracker] = {}
        ids = dict(folder.read_notes().get("trackers") or {})
        for name in dict.fromkeys(names):
            known = ids.get(name)
            try:
                tracker = TRACKERS[name](
                    experiment, folder, known if isinstance(known, str) else None
                )
            except Exception as error:  # whatever their servers and files do
                raise SettingsError(f"--track {name}: cannot start: {_first_line(error)}") from None
            self._trackers[name] = tracker
            ids[name] = tracker.id
        if self._trackers:
            folder.add_notes(trackers=ids)

    def log(self, step: int, numbers: Mapping[str, float]) -> None:
        """Keep numbers that were measured after ``step`` decisions."""
        self._each(lambda tracker: tracker.log(step, numbers))

    def keep(self, results: Mapping[str, Any], model: Path) -> None:
        """Keep the results of `comparison.as_json`, and the model."""
        numbers = agent_means(results)
        self._each(lambda tracker: tracker.keep(numbers, model))

    def end(self, complete: bool) -> None:
        """End the trackers' runs; say where their data lies."""
        self._each(lambda tracker: tracker.end(complete))
        for name, tracker in self._trackers.items():
            print(f"{name:<8} {tracker.where}")
        self._trackers = {}

    def _each(self, act: Callable[[Tracker], None]) -> None:
        for name, tracker in list(self._trackers.items()):
            try:
                act(tracker)
            except Exception as error:  # hours of training must not end because of a tracker
                del self._trackers[name]
                print(f"{name} fails and is left out: {_first_line(error)}", file=sys.stderr)


def agent_means(results: Mapping[str, Any]) -> dict[str, float]:
    """Return the agent's mean of each measure, ``evaluation/SUITE/MEASURE``."""
    return {
        f"evaluation/{suite}/{measure}": float(statistics["mean"]["estimate"])
        for suite, played in results["suites"].items()
        for measure, statistics in played["policies"]["agent"]["summary"].items()
    }


def _plain(experiment: Experiment) -> dict[str, Any]:
    """Return the settings as TOML has them: tables of numbers, texts and lists."""
    return tomllib.loads(to_toml(experiment))


def _flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return a table's values by their dotted keys."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[f"{prefix}{key}"] = value
    return flat


def _first_line(error: Exception) -> str:
    return str(error).strip().partition("\n")[0] or type(error).__name__
