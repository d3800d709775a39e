"""Standard output that tells its own errors from those of files; notes that stop no command."""

import contextlib
import errno
import io
import os
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from typing import Any, TextIO

_ERRORS = 2  # the descriptor of standard error


class OutputError(Exception):
    """Standard output takes nothing more.

    Attributes:
        reason: the error of the operating system.
        closed: whether it was closed by its reader, who has read enough.
    """

    def __init__(self, reason: OSError) -> None:
        super().__init__(reason)
        self.reason = reason
        self.closed = isinstance(reason, BrokenPipeError) or reason.errno == errno.EPIPE


class _Output:
    """A stream that raises `OutputError` where it cannot be written to.

    So no command takes a full disk behind ``>`` for an error of the file that it reads or writes.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        try:
            return self._stream.write(text)
        except OSError as error:
            raise OutputError(error) from error

    def flush(self) -> None:
        try:
            self._stream.flush()
        except OSError as error:
            raise OutputError(error) from error

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextlib.contextmanager
def checked_output(stream: TextIO | None) -> Iterator[None]:
    """Write all that is printed inside the block to a stream, to its end.

    Raises `OutputError` where the stream cannot be written to; what it still holds is dropped.
    Without a stream (a program may be started with a closed standard output) nothing is printed.
    """
    if stream is None:
        with open(os.devnull, "w", encoding="utf-8") as nowhere, redirect_stdout(nowhere):
            yield
        return
    if isinstance(stream, io.TextIOWrapper):
        # A letter that the terminal or file cannot show must not cost the results.
        stream.reconfigure(errors="replace")
    output: Any = _Output(stream)
    try:
        with redirect_stdout(output):
            try:
                yield
            finally:
                output.flush()
    except OutputError:
        _drop_the_rest(stream)
        raise


class _Notes:
    """A stream that takes everything, also what it cannot show."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        with contextlib.suppress(OSError, ValueError):
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        with contextlib.suppress(OSError, ValueError):
            self._stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextlib.contextmanager
def harmless_notes(stream: TextIO | None) -> Iterator[None]:
    """Write notes (bars, warnings, errors) to a stream, as far as it takes them.

    A command does its work even if nobody can read its notes: the disk behind them may be full, or
    the stream closed (None).
    """
    with contextlib.ExitStack() as stack:
        if stream is None:
            # Notes of other libraries must not get into a file that is opened in its place.
            if not _is_open(_ERRORS):
                _send_to_nowhere(_ERRORS)
            stream = stack.enter_context(open(os.devnull, "w", encoding="utf-8"))
        notes: Any = _Notes(stream)
        try:
            with redirect_stderr(notes):
                yield
        finally:
            try:
                stream.flush()
            except (OSError, ValueError):
                _drop_the_rest(stream)


def _is_open(descriptor: int) -> bool:
    try:
        os.fstat(descriptor)
    except OSError:
        return False
    return True


def _drop_the_rest(stream: TextIO) -> None:
    """Send what a stream still holds to nowhere: Python would complain once more at its end."""
    with contextlib.suppress(OSError, ValueError):
        _send_to_nowhere(stream.fileno())


def _send_to_nowhere(descriptor: int) -> None:
    nowhere = os.open(os.devnull, os.O_WRONLY)
    if nowhere != descriptor:
        os.dup2(nowhere, descriptor)
        os.close(nowhere)
