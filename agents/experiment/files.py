"""Files that may be too large, and paths and errors in words."""

import os
import shlex
import subprocess
import sys
from pathlib import Path


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
