"""The folder of a training run."""

import hashlib
import json
import time
from dataclasses import dataclass
from datetime import datetime
from importlib import resources
from itertools import count
from pathlib import Path
from typing import Any

from .files import write_whole
from .provenance import describe_origin
from .schema import SettingsError, to_toml
from .settings import Experiment, load_experiment

# The agent that comes with the package.
PRETRAINED = "pretrained"


@dataclass(frozen=True)
class RunFolder:
    """Where a run keeps what; see the properties."""

    path: Path

    @classmethod
    def create(cls, experiment: Experiment) -> "RunFolder":
        """Make a new folder ``<output>/<name>-seed<seed>-<time>`` with the resolved config in it.

        Raises `SettingsError` if the folder cannot be written.
        """
        stem = f"{experiment.name}-seed{experiment.seed}-{datetime.now():%Y%m%d-%H%M%S}"
        try:
            run = cls(_new_folder(Path(experiment.output), stem))
            run.config.write_text(to_toml(experiment), encoding="utf-8")
            run.note(**describe_origin(), seed=experiment.seed, outcome="unfinished", sessions=[])
        except OSError as error:
            raise SettingsError(f"'output' cannot be written to: {error}") from None
        return run

    @classmethod
    def of(cls, folder: str) -> "RunFolder":
        """Return the run that a path names; raises `SettingsError` if it is none."""
        run = cls(Path(folder))
        if not run.config.is_file():
            raise SettingsError(
                f"{folder}: no training run there; give the folder of a run, which holds "
                f"{run.config.name}"
            )
        return run

    def experiment(self, overrides: list[tuple[str, str]] | None = None) -> Experiment:
        """Return the run's experiment, changed by overrides as `load_experiment` takes them."""
        return load_experiment(str(self.config), overrides or [])

    def about(self) -> dict[str, Any]:
        """Return what `note` has noted."""
        if not self.notes.is_file():
            return {}
        noted: dict[str, Any] = json.loads(self.notes.read_text(encoding="utf-8"))
        return noted

    def note(self, **values: Any) -> None:
        """Keep what is known about the run besides its settings."""
        text = json.dumps({**self.about(), **values}, indent=2) + "\n"
        write_whole(self.notes, text.encode())

    def note_session(self, started: float, first: int, last: int) -> None:
        """Note that it was trained from a decision to another since ``started`` (`time.time`).

        It is said again with each checkpoint: of a session that is killed that much is known.
        """
        begun = datetime.fromtimestamp(started).isoformat(timespec="milliseconds")
        earlier = [one for one in self.about().get("sessions", []) if one["started"] != begun]
        session = {
            "started": begun,
            "seconds": round(time.time() - started, 1),
            "from": first,
            "to": last,
        }
        self.note(sessions=[*earlier, session])

    @property
    def config(self) -> Path:
        """The resolved settings."""
        return self.path / "config.toml"

    @property
    def notes(self) -> Path:
        """Versions, commit, hardware, seed, sessions, how it ended and the hash of the weights."""
        return self.path / "run.json"

    @property
    def model(self) -> Path:
        """The trained model, in stable-baselines3's format, without the optimiser's state."""
        return self.path / "model.zip"

    @property
    def best(self) -> Path:
        """The best model by validation, where there was any."""
        return self.path / "best.zip"

    @property
    def checkpoint(self) -> Path:
        """All that a killed run needs to go on."""
        return self.path / "checkpoint.pt"

    @property
    def curve(self) -> Path:
        """The learning curves, as JSON lines."""
        return self.path / "curve.jsonl"

    @property
    def log(self) -> Path:
        """The folder of TensorBoard's events."""
        return self.path / "log"

    @property
    def evaluation(self) -> Path:
        """The comparison with the baselines."""
        return self.path / "evaluation.json"

    @property
    def picture(self) -> Path:
        """A clip of an episode."""
        return self.path / "play.gif"


@dataclass(frozen=True)
class ModelFile:
    """A saved model and the run that it belongs to."""

    run: RunFolder
    path: Path

    @classmethod
    def find(cls, name: str | None) -> "ModelFile":
        """Return the model that is meant by the folder of a run, a model file in one, or None.

        Of a run the best model by validation is meant, and the last one where there is none; None
        means the agent that comes with the package. Raises `SettingsError` if there is no model.
        """
        if name is None:
            name = str(pretrained_run())
        path = Path(name)
        run = RunFolder.of(name if path.is_dir() or not path.exists() else str(path.parent))
        wanted = path
        if path.is_dir():
            wanted = run.best if run.best.is_file() else run.model
        if not wanted.is_file():
            raise SettingsError(
                f"{name}: no trained model there; give the folder of a run, which holds "
                f"{run.model.name} or {run.best.name}"
            )
        return cls(run, wanted)

    def describe(self) -> dict[str, Any]:
        """Return what tells this model from others, as JSON takes it."""
        digest = hashlib.sha256(self.path.read_bytes()).hexdigest()
        return {
            "run": self.run.path.resolve().name,
            "file": self.path.name,
            "sha256": digest,
            "seed": self.run.experiment().seed,
        }


def pretrained_run() -> Path:
    """Return the folder of the agent that comes with the package."""
    return Path(str(resources.files(__name__.rpartition(".experiment.")[0]))) / PRETRAINED


def _new_folder(parent: Path, stem: str) -> Path:
    """Make and return the first of ``stem``, ``stem-2``, ``stem-3``, ... that does not exist."""
    for number in count(1):
        path = parent / (stem if number == 1 else f"{stem}-{number}")
        try:
            path.mkdir(parents=True)
        except FileExistsError:
            if parent.exists() and not parent.is_dir():
                raise
        else:
            return path
    raise AssertionError("count never ends")
