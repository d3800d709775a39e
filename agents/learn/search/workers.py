"""Trials side by side: one process for each, and what the user sees of them."""

import contextlib
import json
import multiprocessing
import os
import queue
import signal
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ...experiment.errors import SettingsError
from ...experiment.files import cause
from ...interrupts import handled_interrupts
from .board import Board
from .study import JOURNAL, count_ended, open_study
from .trials import Search, run_trial

if TYPE_CHECKING:
    import optuna

_PATIENCE = 60.0  # seconds, for processes to end their trainings by themselves

# Gets the name of one of `Board`'s methods, and its arguments.
Tell = Callable[..., None]


def usable_cores() -> int:
    """Return how many cores this process may use."""
    with contextlib.suppress(AttributeError):  # not on every system
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run_search(search: Search, trials: int, jobs: int) -> None:
    """Train trials until ``trials`` of the study have ended, ``jobs`` of them at a time.

    Raises:
        SettingsError: the study cannot be written, or a process of a trial has ended by itself.
        KeyboardInterrupt: Ctrl-C; all trials have ended then.
    """
    study = open_study(search.folder, search.space, search.seed)
    ended = count_ended(study)
    missing = trials - ended
    if missing <= 0:
        return
    context = multiprocessing.get_context("spawn")
    tickets = context.Value("q", missing)
    with contextlib.closing(Board(ended, trials)) as board:
        if min(jobs, missing) == 1:
            _work(study, search, trials, tickets, lambda name, *rest: getattr(board, name)(*rest))
        else:
            _Workers(context, search, trials, min(jobs, missing), tickets).follow(board)


def _work(study: "optuna.Study", search: Search, trials: int, tickets: Any, tell: Tell) -> None:
    """Train trials one after the other, as long as there are tickets for them."""

    def play(trial: "optuna.Trial") -> float:
        return run_trial(trial, search, lambda *news: tell("progress", *news))

    def report(study: "optuna.Study", trial: "optuna.trial.FrozenTrial") -> None:
        words = trial.user_attrs.get("refused") or json.dumps(trial.params)
        tell("end", trial.number, trial.state.name.lower(), trial.value, words)

    # Other commands may work on the same study.
    while _take(tickets) and count_ended(study) < trials:
        try:
            study.optimize(play, n_trials=1, callbacks=[report])
        except OSError as error:
            where = search.folder / JOURNAL
            raise SettingsError(f"{where}: cannot be written: {cause(error)}") from None


def _take(tickets: Any) -> bool:
    """Take a ticket, if there is one."""
    with tickets.get_lock():
        tickets.value -= 1
        return bool(tickets.value >= 0)


class _Workers:
    """Processes that train trials, and tell about them through a queue.

    Args:
        context: of `multiprocessing`.
        search: what they train.
        trials: of the whole study.
        jobs: how many processes.
        tickets: how many trials are left for them, a shared integer.
    """

    def __init__(self, context: Any, search: Search, trials: int, jobs: int, tickets: Any) -> None:
        self._tickets = tickets
        self._news = context.Queue()
        self._processes = [
            context.Process(
                target=_child, args=(search, trials, tickets, self._news, job), daemon=True
            )
            for job in range(jobs)
        ]

    def follow(self, board: Board) -> None:
        """Start the processes, and show what they tell until all have ended.

        Raises:
            SettingsError: one of them says so, or has ended by itself; the others have ended then.
            KeyboardInterrupt: Ctrl-C; all have ended then.
        """
        try:
            # The processes ignore Ctrl-C until they handle it.
            with handled_interrupts(signal.SIG_IGN):
                for process in self._processes:
                    process.start()
            while any(process.is_alive() for process in self._processes):
                self._show(board, 0.5)
                self._check()
            self._show(board, 0.0)
            self._check()
        except BaseException:
            self._end()
            raise

    def _show(self, board: Board, seconds: float) -> None:
        """Show all news, and wait so long for the first."""
        with contextlib.suppress(queue.Empty):
            while True:
                name, *rest = self._news.get(timeout=seconds)
                getattr(board, name)(*rest)

    def _check(self) -> None:
        """Raise `SettingsError` if a process was killed, or failed."""
        for process in self._processes:
            code = process.exitcode
            if code not in (None, 0):
                reason = f"was killed by signal {-code}" if code < 0 else f"has failed ({code})"
                hint = "; if memory is short, take fewer --jobs" if code == -9 else ""
                raise SettingsError(f"the process of a trial {reason}{hint}")

    def _end(self) -> None:
        """End all processes: between two decisions, or by force if they take too long."""
        with self._tickets.get_lock():
            self._tickets.value = 0
        deadline = time.monotonic() + _PATIENCE
        try:
            for process in self._processes:
                _interrupt(process)
            while time.monotonic() < deadline:
                alive = [process for process in self._processes if process.is_alive()]
                if not alive:
                    break
                alive[0].join(0.2)
                # What nobody reads would keep a process from ending.
                with contextlib.suppress(queue.Empty):
                    while True:
                        self._news.get_nowait()
        finally:
            for process in self._processes:
                if process.is_alive():
                    process.terminate()


def _child(search: Search, trials: int, tickets: Any, news: Any, job: int) -> None:
    """Train trials in a process of their own."""
    _hear_only_the_parent()
    threading.Thread(target=_end_with_parent, daemon=True).start()

    def tell(*message: Any) -> None:
        news.put(message)

    try:
        study = open_study(search.folder, search.space, search.seed, job)
        _work(study, search, trials, tickets, tell)
    except SettingsError as error:
        tell("fail", str(error))
    except KeyboardInterrupt:
        pass


def _hear_only_the_parent() -> None:
    """Take one interrupt, from the process that started this one; not also the terminal's."""

    def handle(number: int, frame: Any) -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        raise KeyboardInterrupt

    if hasattr(os, "setpgrp"):
        os.setpgrp()
    signal.signal(signal.SIGINT, handle)


def _end_with_parent() -> None:
    """End this process when the one that started it is gone, however that ended."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _interrupt(process: Any) -> None:
    """Ask a process to end: a training does so between two decisions."""
    if not process.is_alive():
        return
    if os.name == "nt":
        process.terminate()
    else:
        os.kill(process.pid, signal.SIGINT)
