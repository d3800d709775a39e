"""Files that exist whole or not at all, even if the process is killed or the disk is full."""

import contextlib
import os
import secrets
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

_UNFINISHED = "unfinished-"


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
    """
    # Two processes that write the same file must not write into each other's unfinished one.
    unfinished = path.with_name(f"{_UNFINISHED}{secrets.token_hex(4)}-{path.name}")
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


def remove_unfinished(folder: Path) -> None:
    """Remove unfinished files that a killed process left; no other process may write there."""
    for path in folder.glob(f"{_UNFINISHED}*"):
        path.unlink(missing_ok=True)


def read_limited(path: Path, limit: int) -> bytes:
    """Return a file's content; raise ValueError if it has more than ``limit`` bytes."""
    with path.open("rb") as file:
        content = file.read(limit + 1)
    if len(content) > limit:
        raise ValueError(f"it is larger than {limit:,} bytes")
    return content


def quoted(path: Path | str) -> str:
    """Return a path as one word of a shell's command line."""
    # A name that begins with a dash would be taken for an option.
    text = os.path.join(os.curdir, path) if str(path).startswith("-") else str(path)
    return subprocess.list2cmdline([text]) if sys.platform == "win32" else shlex.quote(text)


def cause(error: OSError) -> str:
    """Return the reason of an error in words, without its number and file."""
    return error.strerror or str(error) or type(error).__name__
