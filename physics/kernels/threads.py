"""Threads that share the work of a batch with the calling one."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any, TypeVar

P = TypeVar("P")
R = TypeVar("R")


class Threads:
    """Threads that work beside the calling one, each on a part of the work.

    They start when they are first needed. A forked process has none of its parent's threads, so it
    starts its own.

    Args:
        name: of the threads.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._pool: ThreadPoolExecutor | None = None
        self._process = 0  # that started the threads

    def run(self, function: Callable[[P], R], parts: Sequence[P]) -> list[R]:
        """Call a function with each part, all at once; return the results in order.

        The calling thread works on the first part. Each time there must be as many parts. All
        threads have finished when this returns or raises.
        """
        running: list[Future[R]] = []
        try:
            pool = self._started(len(parts) - 1)
            running += (pool.submit(function, part) for part in parts[1:])
            first = function(parts[0])
        finally:
            _finish(running)
        return [first, *(task.result() for task in running)]

    def close(self) -> None:
        """End the threads; a later `run` starts them again."""
        if self._pool is not None and self._process == os.getpid():
            self._pool.shutdown()
        self._pool = None

    def _started(self, count: int) -> ThreadPoolExecutor:
        """Return the pool of so many threads that this process has started."""
        if self._pool is None or self._process != os.getpid():
            self._pool = ThreadPoolExecutor(count, self._name)
            self._process = os.getpid()
        return self._pool


def _finish(running: list[Future[Any]]) -> None:
    """Wait until all tasks have finished, also if the user interrupts the wait."""
    try:
        wait(running)
    except KeyboardInterrupt:
        # Whoever catches it must not see the arrays change.
        wait(running)
        raise
