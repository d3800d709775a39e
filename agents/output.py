"""Standard output that tells its own errors from those of files, and a standard error without."""

import contextlib
import errno
import io
import os
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from typing import Any, TextIO


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


def _drop_the_rest(stream: TextIO) -> None:
    """Send what a stream still holds to nowhere: Python would complain once more at its end."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


class _Notes:
    """A stream that drops what it cannot write: notes and bars stop no run."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        try:
            return self._stream.write(text)
        except OSError:
            _drop_the_rest(self._stream)
            return len(text)

    def flush(self) -> None:
        try:
            self._stream.flush()
        except OSError:
            _drop_the_rest(self._stream)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextlib.contextmanager
def notes(stream: TextIO | None) -> Iterator[None]:
    """Write what goes to standard error inside the block to a stream, while that takes it.

    Without a stream it goes nowhere: ``print`` would send it to standard output.
    """
    if stream is None:
        with open(os.devnull, "w", encoding="utf-8") as nowhere, redirect_stderr(nowhere):
            yield
        return
    lenient: Any = _Notes(stream)
    with redirect_stderr(lenient):
        yield
