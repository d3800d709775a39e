"""The folder of a training run, and the models in it."""

import hashlib
import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from itertools import count
from pathlib import Path
from typing import Any

from ...envs.atomic import remove_unfinished, write_atomically
from ...envs.config import plain
from ...envs.reading import read_limited
from .errors import SettingsError
from .files import cause
from .notes import known_notes
from .packaged import find_agent, packaged_agents
from .packed import has_weights, holds_settings, read_packed
from .programs import arkanoid
from .provenance import describe_origin
from .reading import parse_toml, parse_toml_value, read_settings, read_toml, to_toml
from .settings import Experiment

_PACKAGE = __name__.partition(".")[0]
# What decides the spaces of an environment, and so a network's inputs and outputs.
_INTERFACE = ("observation", "landing", "size", "grey", "stack", "channels", "actions")
# How a run has ended: with its budget, or so that it can be resumed. Validation has other reasons.
FINISHED = "finished"
UNFINISHED = "unfinished"
INTERRUPTED = "interrupted"
# A run's notes take about a thousand bytes, and eighty for each session.
_LARGEST_NOTES = 2**20
_A_LOOK = 1.0  # second


@dataclass(frozen=True)
class RunFolder:
    """Where a run keeps its files; the properties name them.

    Attributes:
        path: of the folder.
        trusted: whether reading the run may run its author's code: import the module that its
            ``env_id`` names, and unpickle its model. True for runs that this process made, and
            where the user says so.
        packed: of a model that lies alone: its file, which holds its run's settings, too.
    """

    path: Path
    trusted: bool = False
    packed: Path | None = None

    @classmethod
    def create(cls, experiment: Experiment) -> "RunFolder":
        """Make a new folder ``<output>/<name>-seed<seed>-<time>`` with all settings in it.

        Raises `SettingsError` if the folder cannot be written.
        """
        stem = f"{experiment.name}-seed{experiment.seed}-{datetime.now():%Y%m%d-%H%M%S}"
        try:
            run = cls(_new_folder(Path(experiment.output), stem), trusted=True)
            write_atomically(run.config, to_toml(experiment).encode())
            run.add_notes(
                **describe_origin(), seed=experiment.seed, outcome=UNFINISHED, sessions=[]
            )
        except OSError as error:
            what = f"{error.filename or experiment.output}: {cause(error)}"
            raise SettingsError(f"'output' cannot be written to: {what}") from None
        return run

    @classmethod
    def of(cls, folder: str, trusted: bool = False) -> "RunFolder":
        """Return the run in a folder; raise `SettingsError` if there is none."""
        run = cls(Path(folder), trusted)
        if not run.config.is_file():
            raise SettingsError(
                f"{folder}: no run there; give the folder of a run, which holds {run.config.name}"
            )
        return run

    def experiment(self, overrides: list[tuple[str, str]] | None = None) -> Experiment:
        """Return the run's experiment, changed by overrides as `load_experiment` takes them.

        Raises `SettingsError` if the settings are wrong, or if their ``env_id`` names a module and
        the run is not trusted.
        """
        source, table = self._read_settings()
        if not self.trusted:
            self._refuse_module(table)
        return read_settings(Experiment, table, source, overrides or [])

    def _read_settings(self) -> tuple[str, dict[str, Any]]:
        """Return where the settings come from, for messages, and their tables."""
        if self.packed is None:
            return read_toml(str(self.config))
        try:
            return f"the settings in {self.packed}", parse_toml(read_packed(self.packed))
        except (ValueError, RecursionError) as error:
            raise SettingsError(f"{self.packed}: its settings are damaged: {error}") from None

    def _refuse_module(self, table: dict[str, Any]) -> None:
        """Raise `SettingsError` if reading the settings would import a module."""
        module, colon, _ = str(table.get("env_id", "")).partition(":")
        if colon and module != _PACKAGE:
            raise SettingsError(
                f"{self.packed or self.config}: 'env_id' = {table['env_id']!r} imports the module "
                f"{module!r}, which can run any command on this computer; add --trust if you trust "
                f"its author"
            )

    def check_resumable(self) -> None:
        """Raise `SettingsError` if the run has ended."""
        # If the notes are lost, the checkpoint is enough.
        outcome = self.read_notes().get("outcome", UNFINISHED)
        if outcome not in (UNFINISHED, INTERRUPTED):
            raise SettingsError(
                f"{self.path}: nothing to resume: the run has ended ({outcome}); "
                f"to train on: {arkanoid('train', '--from', self.path)}; "
                f"to measure it: {arkanoid('evaluate', self.path)}"
            )

    def read_notes(self) -> dict[str, Any]:
        """Return what `add_notes` has written; nothing if the file is missing.

        Raises `SettingsError` if the file is damaged.
        """
        if not self.notes.exists():
            return {}
        try:
            return known_notes(json.loads(read_limited(self.notes, _LARGEST_NOTES)))
        except OSError as error:
            raise SettingsError(f"{self.notes}: cannot be read: {cause(error)}") from None
        except (ValueError, RecursionError) as error:
            raise SettingsError(
                f"{self.notes}: damaged ({error}); replace it with a copy or remove it; it says "
                f"only how the run was made and how it ended"
            ) from None

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Keep other processes from training this run.

        The lock ends with the process, even if that is killed. Raises `SettingsError` if another
        process holds it.
        """
        from filelock import FileLock, Timeout

        # Long enough for who only looks, see `is_trained`.
        lock = FileLock(self._lock, timeout=_A_LOOK)
        try:
            lock.acquire()
            remove_unfinished(self.path)
        except Timeout:
            raise SettingsError(
                f"{self.path}: another process is training this run; wait until it ends, or stop it"
            ) from None
        except OSError as error:
            lock.release()
            raise SettingsError(f"{self.path}: cannot be written to: {cause(error)}") from None
        try:
            yield
        finally:
            lock.release()

    def is_trained(self) -> bool:
        """Tell whether a process trains this run now."""
        from filelock import FileLock, Timeout

        if not self._lock.is_file():
            return False
        lock = FileLock(self._lock, timeout=0)
        try:
            lock.acquire()
        except Timeout:
            return True
        except OSError:  # nobody trains where nothing can be written
            return False
        lock.release()
        return False

    def add_notes(self, **values: Any) -> None:
        """Write down more about the run; a value replaces an earlier one of its name."""
        text = json.dumps({**self.read_notes(), **values}, indent=2) + "\n"
        write_atomically(self.notes, text.encode())

    def add_warning(self, message: str) -> None:
        """Write down a warning; `read_notes` has all of them in the list ``warnings``."""
        earlier = self.read_notes().get("warnings", [])
        # A resumed run may come to the same warning again.
        self.add_notes(warnings=[*earlier, *([] if message in earlier else [message])])

    def note_session(self, started: float, first: int, last: int) -> None:
        """Note a session that trains from decision ``first`` and has come to ``last``.

        Each checkpoint repeats it, so that a killed session is known up to its last checkpoint.
        ``started``, from `time.time`, tells the sessions apart.
        """
        begun = datetime.fromtimestamp(started).isoformat(timespec="milliseconds")
        earlier = [one for one in self.read_notes().get("sessions", []) if one["started"] != begun]
        session = {
            "started": begun,
            "seconds": round(time.time() - started, 1),
            "from": first,
            "to": last,
        }
        self.add_notes(sessions=[*earlier, session])

    @property
    def _lock(self) -> Path:
        """What a process holds that trains this run."""
        return self.path / "lock"

    @property
    def config(self) -> Path:
        """All settings, the defaults among them."""
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
        """The best model by validation; without validation there is none."""
        return self.path / "best.zip"

    @property
    def start(self) -> Path:
        """The model that the training began with; without one its weights were random."""
        return self.path / "start.zip"

    @property
    def checkpoint(self) -> Path:
        """All that a killed run needs to resume."""
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
    def film(self) -> Path:
        """A film of an episode."""
        return self.path / "play.gif"


@dataclass(frozen=True)
class ModelFile:
    """A saved model and the run that it belongs to."""

    run: RunFolder
    path: Path

    @classmethod
    def find(cls, name: str | None, trusted: bool = False) -> "ModelFile":
        """Return the model in the folder of a run, a model file itself, or a packaged agent's.

        Args:
            name: of a folder: its best model by validation, or else its last one; of a model file
                in such a folder: this one. One of `packaged_agents`: this one, unless there is such
                a path; None: their `DEFAULT_AGENT`.
            trusted: whether the run is, see `RunFolder`.

        Raises:
            SettingsError: there is no model.
        """
        path = find_agent(name)
        if path.is_dir():
            run = RunFolder.of(str(path), trusted)
            path = run.best if run.best.is_file() else run.model
            if not path.is_file():
                raise SettingsError(_without_model(name, run))
        elif not path.is_file():
            raise SettingsError(
                f"{name}: there is no such file or folder; give the folder of a run, a model's "
                f".zip file, or the name of a packaged agent: {', '.join(packaged_agents())}"
            )
        else:
            run = RunFolder(path.parent, trusted)
        _check_model(path, run)
        if not run.config.is_file():
            run = replace(run, packed=path)
            _check_settings(path)
        return cls(run, path)

    def experiment(self, overrides: list[tuple[str, str]] | None = None) -> Experiment:
        """Return the experiment in which the model plays: its run's, changed by overrides.

        Raises `SettingsError` as `RunFolder.experiment`, and if the overrides change what the model
        sees or what it can do: only a model that stable-baselines3 reads, which needs trust, can
        have another network than its run.
        """
        if self.run.trusted or not overrides:
            return self.run.experiment(overrides)
        config = self.run.experiment().config
        for key, text in overrides:
            table, _, name = key.partition(".")
            if table == "env" and name in _INTERFACE:
                own = getattr(config, name)
                if plain(parse_toml_value(text)) != plain(own):
                    raise _refused(self.path, name, own, f"leave out --{key}")
        experiment = self.run.experiment(overrides)
        for name in _INTERFACE:
            own = getattr(config, name)
            if getattr(experiment.config, name) != own:
                raise _refused(
                    self.path, name, own, f"choose another env_id than {experiment.env_id}"
                )
        return experiment

    def describe(self) -> dict[str, Any]:
        """Return what tells this model from others, as JSON takes it."""
        with self.path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256")
        return {
            "run": self.run.path.resolve().name,
            "file": self.path.name,
            "sha256": digest.hexdigest(),
            "seed": self.run.experiment().seed,
            "inputs": self.run.experiment().inputs,
        }


def _without_model(name: str | None, run: RunFolder) -> str:
    from ...envs.browser.shipped import offers_module

    fact = f"{name}: no trained model there"
    if run.read_notes().get("outcome", UNFINISHED) != UNFINISHED:
        return f"{fact}: {run.model.name} is missing; replace it with a copy, or train again"
    page = f"; to follow it: {arkanoid('watch', run.path, '--web')}" if offers_module() else ""
    return f"{fact}: the training has not ended{page}"


def _refused(path: Path, name: str, own: Any, hint: str) -> SettingsError:
    return SettingsError(
        f"{path}: the model was trained with 'env.{name}' = {plain(own)!r} and plays with nothing "
        f"else: {hint}"
    )


def _check_model(path: Path, run: RunFolder) -> None:
    """Raise `SettingsError` if a file holds no model, as far as that shows without torch."""
    try:
        if has_weights(path):
            return
        reason = "no model"
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read: {cause(error)}") from None
    except ValueError:
        reason = "a damaged model" if path in (run.model, run.best) else "no model"
    hint = (
        f"give the folder of its run: {path.parent}"
        if run.config.is_file()
        else ("give the folder of a run, or a model's .zip file")
    )
    if path in (run.model, run.best):
        hint = "replace it with a copy, or train again"
    raise SettingsError(f"{path}: this is {reason}; {hint}")


def _check_settings(path: Path) -> None:
    """Raise `SettingsError` if a model that lies alone does not say how it was trained."""
    if not holds_settings(path):
        raise SettingsError(
            f"{path}: the file does not say which game and network it is for: put the config.toml "
            f"of its run beside it"
        )


def _new_folder(parent: Path, stem: str) -> Path:
    """Make and return the first of ``stem``, ``stem-2``, ``stem-3``, ... that does not exist."""
    for attempt in count(1):
        path = parent / (stem if attempt == 1 else f"{stem}-{attempt}")
        try:
            path.mkdir(parents=True)
        except FileExistsError:
            if parent.exists() and not parent.is_dir():
                raise
        else:
            return path
    raise AssertionError("count never ends")
