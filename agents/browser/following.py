"""A run that is followed: what its files say by now, also while a training writes them.

Models, checkpoints and notes are replaced as a whole, so that none is read half-written; of the
curves the last line may be, and `read_curve` leaves it out.
"""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np

from ..experiment.errors import SettingsError
from ..experiment.files import cause
from ..experiment.runs import FINISHED, INTERRUPTED, UNFINISHED, ModelFile, RunFolder
from ..experiment.settings import Experiment
from ..learn.curves import SHOWN, STEP, measured, read_curve
from ..learn.portable import portable_network

_POINTS = 200  # of a curve
_LEAST = 0.5  # seconds between two looks
_SHARE = 20  # looking takes one part of so many of a processor's time
_MOST = 5.0  # seconds, however long one look took: the first one loads libraries
_FPS = "time/fps"
_MINUTE, _HOUR = 60, 3600
_NONE_YET = "The training has not written its first checkpoint."
_NONE = "The training was stopped before its first checkpoint."

Curve = Sequence[Mapping[str, Any]]


class FollowedRun:
    """A run's folder, at which one looks again and again; threads can share it.

    Args:
        run: may be in training, or be resumed or deleted meanwhile.
        experiment: the run's, or with other settings of the game.

    Attributes:
        experiment: the same.
        fault: why the latest agent cannot play here; "" if it can, or there is none yet.
    """

    def __init__(self, run: RunFolder, experiment: Experiment) -> None:
        self.experiment = experiment
        self.fault = ""
        self._run = run
        self._lock = Lock()
        self._due = 0.0
        self._news: dict[str, Any] = {}
        self._file: tuple[Any, ...] = ()
        self._network: bytes | None = None

    def news(self) -> dict[str, Any]:
        """Return what the page shows, for `json.dumps`.

        - ``state``: "training", "stopped" or "finished"; "lost" if the run cannot be read.
        - ``said``: the same in a sentence.
        - ``done``: which part of the decisions is played, from 0 to 1; None if the run is lost.
        - ``curves``: ``title``, ``steps`` and ``values`` of each.
        - ``version``: of what `network` returns; None without an agent.
        - ``agent``: which one that is; or why there is none, in a sentence.
        """
        with self._lock:
            if time.monotonic() >= self._due:
                began = time.process_time()
                self._news = self._look()
                spent = time.process_time() - began
                self._due = time.monotonic() + min(_MOST, max(_LEAST, _SHARE * spent))
            return self._news

    def network(self) -> bytes | None:
        """Return the file of `portable_network` for the latest agent; None without one."""
        self.news()
        with self._lock:
            return self._network

    def _look(self) -> dict[str, Any]:
        run = self._run
        if not run.config.is_file():
            return self._lost(f"The folder {run.path} is gone.")
        try:
            trains = run.is_trained()
            notes, curve = run.read_notes(), read_curve(run.curve)
        except SettingsError as error:
            return self._lost(_sentence(error))
        # Who has only a model has a run that was finished.
        lone = UNFINISHED if run.checkpoint.is_file() else FINISHED
        outcome = notes.get("outcome") or lone
        ended = not trains and outcome not in (UNFINISHED, INTERRUPTED)
        done = self._done(notes, curve, trains)
        if trains:
            state, said = "training", f"Training: {_percent(done)}{self._left(curve)}"
        elif ended:
            reason = "" if outcome == FINISHED else f": {outcome}"
            state, said = "finished", f"Finished{reason}."
        else:
            state, said = "stopped", f"Stopped at {_percent(done)}."
        agent = self._agent(trains, outcome, notes)
        version = " ".join(map(str, self._file)) if self._network else None
        curves = [drawn for key in SHOWN if (drawn := _drawn(curve, key))]
        return {
            "state": state,
            "said": said,
            "done": done,
            "curves": curves,
            "version": version,
            "agent": agent,
        }

    def _lost(self, said: str) -> dict[str, Any]:
        """Return the news where nothing can be read; the agent is that of before."""
        before = {"done": None, "curves": [], "version": None, "agent": "", **self._news}
        return {**before, "state": "lost", "said": said}

    def _done(self, notes: Mapping[str, Any], curve: Curve, trains: bool) -> float:
        """Return which part of the decisions is played; of a stopped run what is kept."""
        sessions = notes.get("sessions", [])
        logged = curve[-1][STEP] if curve else 0
        kept = notes.get("timesteps") or (sessions[-1]["to"] if sessions else logged)
        played = logged if trains else kept
        return min(1.0, played / self.experiment.training.timesteps)

    def _left(self, curve: Curve) -> str:
        """Return how long a training will go on, as the end of a sentence."""
        paces = [row[_FPS] for row in curve if row.get(_FPS, 0.0) > 0.0]
        if not paces:
            return "."
        left = max(0, self.experiment.training.timesteps - curve[-1][STEP])
        return f", {_duration(left / paces[-1])} left."

    def _agent(self, trains: bool, outcome: str, notes: Mapping[str, Any]) -> str:
        """Read the latest agent if there is a new one; return what it is, or what is wrong."""
        try:
            model, what = self._model(trains, outcome, notes)
            status = None if model is None else model.path.stat()
        except SettingsError as error:
            self._file, self._network, self.fault = (), None, str(error)
            return _sentence(error)
        except OSError as error:
            return f"{self._run.path} cannot be read: {cause(error)}."
        if model is None or status is None:
            self._file, self._network, self.fault = (), None, ""
            return what
        file = (model.path.name, status.st_mtime_ns, status.st_size)
        if file != self._file:
            self._file, self.fault = file, ""
            try:
                self._network = portable_network(model, self.experiment)
            except SettingsError as error:
                self._network, self.fault = None, str(error)
        return _sentence(self.fault) if self.fault else what

    def _model(
        self, trains: bool, outcome: str, notes: Mapping[str, Any]
    ) -> tuple[ModelFile | None, str]:
        """Return the file of the latest agent, and what it is; None, and why there is none."""
        run = self._run
        if not trains and outcome != UNFINISHED:
            found = ModelFile.find(str(run.path), run.trusted)
            best = found.path == run.best
            return found, f"The {'best model by validation' if best else 'last model'} plays."
        if not run.checkpoint.is_file():
            return None, _NONE_YET if trains else _NONE
        sessions = notes.get("sessions", [])
        after = f"{sessions[-1]['to']:,} decisions" if sessions else "its latest checkpoint"
        return ModelFile(run, run.checkpoint), f"The agent after {after} plays."


def followed_run(folder: Path, trusted: bool, overrides: list[tuple[str, str]]) -> FollowedRun:
    """Return the run in a folder, to follow it; ``overrides`` change its game.

    Raises `SettingsError` if there is no run, its settings are wrong, or it has a model by now that
    no browser can play.
    """
    run = RunFolder.of(str(folder), trusted)
    followed = FollowedRun(run, ModelFile(run, run.checkpoint).experiment(overrides))
    followed.news()
    if followed.fault:
        raise SettingsError(followed.fault)
    return followed


def _drawn(curve: Curve, key: str) -> dict[str, Any] | None:
    """Return a curve as the page draws it: some of its points, evenly spread; None without any."""
    points = measured(curve, key)
    if not len(points):
        return None
    places = np.linspace(0, len(points) - 1, min(len(points), _POINTS)).round().astype(int)
    steps, values = points[places].T
    return {
        "title": SHOWN[key],
        "steps": [int(step) for step in steps],
        "values": [float(f"{value:.5g}") for value in values],
    }


def _percent(part: float) -> str:
    return f"{int(100 * part)} %"


def _duration(seconds: float) -> str:
    """Return a time in words, with the accuracy that a guess has."""
    if seconds >= _HOUR:
        minutes = round(seconds / _MINUTE)
        return f"{minutes // 60} h {minutes % 60} min"
    return f"{round(seconds / _MINUTE)} min" if seconds >= _MINUTE else f"{round(seconds)} s"


def _sentence(error: SettingsError | str) -> str:
    text = str(error)
    return text if text.endswith(".") else f"{text}."
