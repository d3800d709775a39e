"""Files that exist whole or not at all, even if the process is killed or the disk is full."""

import contextlib
import os
import secrets
from collections.abc import Callable
from pathlib import Path

_UNFINISHED = "unfinished-"
# Letters of a file's name that its unfinished one keeps: a longer name would exceed what a file
# system takes.
_KEPT = 32


def write_atomically(path: Path, content: bytes | memoryview) -> None:
    """Write a file: all of it, or what was there before stays.

    Raises OSError if it cannot be written.
    """

    def write(unfinished: Path) -> None:
        unfinished.write_bytes(content)

    replace_atomically(path, write)


def replace_atomically(path: Path, write: Callable[[Path], None]) -> None:
    """Let ``write`` make a file, and put it in the place of ``path`` when it is on the disk.

    ``write`` gets the path of an empty file in the same folder, whose name ends as that of
    ``path``. If it fails, that file is removed, and ``path`` stays as it was.

    Raises OSError if there can be no file; where it names a file, that is ``path``.
    """
    # Two processes that write the same file must not write into each other's unfinished one.
    name = f"{_UNFINISHED}{secrets.token_hex(4)}-{path.name[-_KEPT:]}"
    unfinished = path.with_name(name)
    try:
        # Only a new file: through a link of this name another file would be written.
        unfinished.open("xb").close()
        try:
            write(unfinished)
            with unfinished.open("rb+") as file:
                os.fsync(file.fileno())
            os.replace(unfinished, path)
        except BaseException:
            with contextlib.suppress(OSError):
                unfinished.unlink()
            raise
    except OSError as error:
        if str(error.filename) != str(unfinished):
            raise
        # Nobody knows the unfinished file.
        raise OSError(error.errno, error.strerror, str(path)) from error


def remove_unfinished(folder: Path) -> None:
    """Remove unfinished files that a killed process left; no other process may write there."""
    for path in folder.glob(f"{_UNFINISHED}*"):
        path.unlink(missing_ok=True)


def why_no_kernels_are_kept() -> str | None:
    """Return why machine code can't be kept in the cache folder, in a clause; None if it can."""
    # Imported on demand: only `arkanoid warm-up` asks.
    from ..physics.kernels.cache import why_unkept

    return why_unkept()
