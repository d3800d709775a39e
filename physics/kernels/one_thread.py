"""A guard for what belongs to one thread at a time."""

import os
from collections.abc import Callable
from functools import wraps
from typing import Any, NoReturn, TypeVar
from weakref import WeakSet

R = TypeVar("R")
F = TypeVar("F", bound=Callable[..., Any])


class OneThread:
    """Refuses a call while another one is in progress.

    A method that is called often does itself what `run` does, in the same order. Nothing is called
    between the question and the answer, so no other thread comes between; and neither does Ctrl-C
    between taking it and the `try`.

    Args:
        what: it guards, in words.

    Attributes:
        taken: whether a call is in progress.
    """

    __slots__ = ("__weakref__", "_what", "taken")

    def __init__(self, what: str) -> None:
        self._what = what
        self.taken = False
        _all.add(self)

    def refuse(self) -> NoReturn:
        """Raise a RuntimeError that says why."""
        raise RuntimeError(
            f"another call is using {self._what}: it belongs to one thread at a time"
        )

    def run(self, function: Callable[..., R], *arguments: Any, **keywords: Any) -> R:
        """Call a function while all other calls are refused.

        Raises:
            RuntimeError: another call is in progress.
        """
        if self.taken:
            self.refuse()
        self.taken = True
        try:
            return function(*arguments, **keywords)
        finally:
            self.taken = False


def alone(method: F) -> F:
    """Let a method be refused while another call uses its object, whose guard is ``_alone``."""

    @wraps(method)
    def guarded(self: Any, *arguments: Any, **keywords: Any) -> Any:
        return self._alone.run(method, self, *arguments, **keywords)

    return guarded  # type: ignore[return-value]


_all: "WeakSet[OneThread]" = WeakSet()


def _free_all() -> None:
    """Forget the calls in progress: a forked process has not the threads that were in them."""
    for guard in list(_all):
        guard.taken = False


if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=_free_all)
