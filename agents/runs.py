"""The folder of a training run."""

from dataclasses import dataclass
from datetime import datetime
from itertools import count
from pathlib import Path

from .schema import SettingsError, to_toml
from .settings import Experiment, load_experiment


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
        except OSError as error:
            raise SettingsError(f"'output' cannot be written to: {error}") from None
        return run

    @classmethod
    def of(cls, model: str) -> "RunFolder":
        """Return the run that a path names: its folder or the model in it.

        Raises `SettingsError` if there is no model, or no config beside it.
        """
        path = Path(model)
        run = cls(path if path.is_dir() else path.parent)
        wanted = run.model if path.is_dir() else path
        if wanted != run.model or not wanted.is_file() or not run.config.is_file():
            raise SettingsError(
                f"{model}: no trained model there; give the folder of a run, which holds "
                f"{run.model.name} and {run.config.name}"
            )
        return run

    def experiment(self, overrides: list[tuple[str, str]] | None = None) -> Experiment:
        """Return the run's experiment, changed by overrides as `load_experiment` takes them."""
        return load_experiment(str(self.config), overrides or [])

    @property
    def config(self) -> Path:
        """The resolved settings."""
        return self.path / "config.toml"

    @property
    def model(self) -> Path:
        """The trained model, in stable-baselines3's format."""
        return self.path / "model.zip"

    @property
    def log(self) -> Path:
        """The folder of the learning curves: TensorBoard's events and `progress.csv`."""
        return self.path / "log"

    @property
    def evaluation(self) -> Path:
        """The comparison with the baselines."""
        return self.path / "evaluation.json"

    @property
    def picture(self) -> Path:
        """A clip of an episode."""
        return self.path / "play.gif"


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
