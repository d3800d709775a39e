"""Ctrl-C ends the command `arkanoid` in one sentence, also while its modules are imported."""

import contextlib
import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any, NoReturn

INTERRUPTED = "interrupted"


def is_command() -> bool:
    """Tell whether this process is the command, and not a program that imports the package."""
    program = sys.argv[0] if sys.argv else ""
    if program == "-m":  # in its place comes the module's file, once that is found
        program = sys.orig_argv[-len(sys.argv)]
    return Path(program).name.removesuffix(".exe") == "arkanoid"


def end_at_interrupt() -> None:
    """Let Ctrl-C end the process at once, until `noted_interrupts`.

    So it never meets a module that takes it for an error of its own.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        with contextlib.suppress(ValueError):  # only the main thread may handle signals
            signal.signal(signal.SIGINT, _end)


def _end(number: int, frame: FrameType | None) -> NoReturn:
    with contextlib.suppress(OSError):
        os.write(2, f"arkanoid: error: {INTERRUPTED}\n".encode())
    os._exit(130)


@contextlib.contextmanager
def noted_interrupts() -> Iterator[list[int]]:
    """Raise KeyboardInterrupt at Ctrl-C inside the block, as usual, and note it in a list."""
    noted: list[int] = []

    def note(number: int, frame: FrameType | None) -> NoReturn:
        noted.append(number)
        raise KeyboardInterrupt

    if signal.getsignal(signal.SIGINT) not in (_end, signal.default_int_handler):
        yield noted
        return
    with handled_interrupts(note):
        yield noted


@contextlib.contextmanager
def handled_interrupts(handler: Callable[[int, FrameType | None], Any] | int) -> Iterator[None]:
    """Let Ctrl-C inside the block call a handler; outside the main thread, change nothing."""
    before = signal.getsignal(signal.SIGINT)
    try:
        signal.signal(signal.SIGINT, handler)
    except ValueError:  # only the main thread may handle signals
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
