"""Threads that share the work of a batch with the calling one.

Ctrl-C, or a signal's handler that raises, may end a call of Python's main thread between any two of
its steps. So nothing here takes a lock that somebody else waits for, and all that is handed over
was noted before.
"""

import os
import weakref
from _thread import allocate_lock
from collections.abc import Callable, Iterable, Sequence
from queue import SimpleQueue
from threading import Thread
from typing import Any, TypeVar

from .held_signals import held_signals

P = TypeVar("P")
R = TypeVar("R")

# Who takes a task.
_CALLER, _WORKER = 1, 2


class _Task:
    """A part of the work, for whoever takes it first.

    Attributes:
        ended: whether a thread has done it.
        end: a lock that is open from then on.
        result: what the function has returned.
        error: what it has raised instead, or None.
    """

    __slots__ = ("_function", "_part", "_taker", "end", "ended", "error", "result")

    def __init__(self, function: Callable[[Any], Any], part: Any) -> None:
        self._function = function
        self._part = part
        self._taker: dict[str, int] = {}
        self.ended = False
        self.end = allocate_lock()
        self.end.acquire()
        self.result: Any = None
        self.error: BaseException | None = None

    def take(self, who: int) -> bool:
        """Tell whether it is the caller's, or a worker's; who asks first is the one."""
        # One step for Python, and the same answer whenever the caller asks again.
        return self._taker.setdefault("", who) == who

    def do(self, who: int) -> None:
        """Do it, unless the other side has taken it."""
        if self.take(who):
            try:
                self.result = self._function(self._part)
            except BaseException as error:
                self.error = error
            self.ended = True
            self.end.release()

    def wait(self) -> None:
        """Wait for its end."""
        while not self.ended:
            self.end.acquire()


class Threads:
    """Threads that work beside the calling one, each on a part of the work.

    They start when they are first needed, and end when nobody keeps this object. A forked process
    has none of its parent's threads, so it starts its own.

    Args:
        name: of the threads.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._process = 0  # that has started the threads
        self._threads: list[Thread] = []
        self._queue: SimpleQueue[_Task | None] = SimpleQueue()
        self._tasks: Sequence[_Task] = ()  # that threads may still be working on

    def run(self, function: Callable[[P], R], parts: Sequence[P]) -> list[R]:
        """Call a function with each part, all at once; return the results in order.

        The calling thread works on the first part. Each time there must be as many parts. An error
        in one of them is raised when all are done. All threads have finished when this returns or
        raises, also if a signal's handler raises; some parts may not have been begun then.
        """
        queue = self._started(len(parts) - 1)
        if self._tasks:
            # A run was interrupted, and then the wait for its end, too.
            _settle(self._tasks)
        tasks = self._tasks = [_Task(function, part) for part in parts]
        try:
            for task in tasks[1:]:
                queue.put(task)
            for task in tasks:
                # Beside the first one, what no thread has begun: some wake up late.
                task.do(_CALLER)
            for task in tasks:
                task.wait()
        except BaseException:
            try:
                _settle(tasks)
            except BaseException:
                # Another interruption may have come before the wait began.
                _settle(tasks)
                raise
            raise
        self._tasks = ()
        for task in tasks:
            if task.error is not None:
                raise task.error
        return [task.result for task in tasks]

    def close(self) -> None:
        """End the threads; a later `run` starts them again."""
        threads, self._threads = self._threads, []
        if self._process == os.getpid():
            _end(self._queue, len(threads))
            for thread in threads:
                thread.join()

    def _started(self, count: int) -> "SimpleQueue[_Task | None]":
        """Return the queue of so many threads, which this process has started."""
        if not self._threads or self._process != os.getpid():
            with held_signals():
                self._process = os.getpid()
                self._tasks = ()
                self._queue = SimpleQueue()
                self._threads = [
                    Thread(target=_work, args=(self._queue,), name=self._name, daemon=True)
                    for _ in range(count)
                ]
                for thread in self._threads:
                    thread.start()
                weakref.finalize(self, _end, self._queue, count).atexit = False
        return self._queue


def _work(queue: "SimpleQueue[_Task | None]") -> None:
    """Do one task after another, until there is a None."""
    while (task := queue.get()) is not None:
        task.do(_WORKER)
        del task  # it holds the caller's arrays


def _end(queue: "SimpleQueue[_Task | None]", count: int) -> None:
    """End so many threads."""
    for _ in range(count):
        queue.put(None)


def _settle(tasks: Iterable[_Task]) -> None:
    """Take back the tasks that no thread has begun, and wait for the end of the others.

    However often the wait is interrupted: whoever catches that must not see the arrays change.
    """
    interruption: BaseException | None = None
    waiting = True
    while waiting:
        try:
            for task in tasks:
                if not task.take(_CALLER):
                    task.wait()
            waiting = False
        except BaseException as error:
            interruption = error
    if interruption is not None:
        raise interruption
