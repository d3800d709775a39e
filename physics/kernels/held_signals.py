"""Signals that wait while something is done that must not be broken off.

Python runs a signal's handler between any two steps of the main thread. Where a handler raises, as
that of Ctrl-C does, it may leave a lock of Python, Numba or LLVM locked for ever.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import get_ident, main_thread
from types import FrameType
from typing import Any

_SIGNALS = sorted(signal.valid_signals())
# What the handlers were, and which signals have come, while they are held back.
_handlers: dict[int, Any] = {}
_noted: list[int] = []


@contextmanager
def held_signals() -> Iterator[None]:
    """Hold back all signals that have a handler in Python, and hand them on at the end.

    Only the main thread handles signals: in another one, this does nothing. It may be nested;
    signals are handed on at the end of each.
    """
    if get_ident() != main_thread().ident:
        yield
    elif _handlers:
        yield
        _hand_on(_handlers)
    else:
        found: dict[int, Any] = {number: signal.getsignal(number) for number in _SIGNALS}
        handlers = {number: each for number, each in found.items() if callable(each)}
        try:
            for number in handlers:
                signal.signal(number, _note)
            _handlers.update(handlers)
            yield
        finally:
            try:
                _restore(handlers)
            except BaseException:
                # One of them has come again, when its handler was back.
                _restore(handlers)
                raise
        _hand_on(handlers)


def _note(number: int, frame: FrameType | None) -> None:
    _noted.append(number)


def _restore(handlers: dict[int, Any]) -> None:
    _handlers.clear()
    for number, handler in handlers.items():
        signal.signal(number, handler)


def _hand_on(handlers: dict[int, Any]) -> None:
    """Call the handlers of the signals that have come."""
    while _noted:
        number = _noted.pop(0)
        handlers[number](number, None)
