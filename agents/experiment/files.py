"""Files that are replaced atomically: a killed process leaves the old file or the new one."""

import os
from collections.abc import Callable
from pathlib import Path


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file: all of it, or none of it."""

    def write(unfinished: Path) -> None:
        unfinished.write_bytes(content)

    replace_atomically(path, write)


def replace_atomically(path: Path, write: Callable[[Path], None]) -> None:
    """Let ``write`` make a file, and move it to ``path`` once it is on the disk."""
    unfinished = path.with_name(f"unfinished-{path.name}")
    write(unfinished)
    with unfinished.open("rb+") as file:
        os.fsync(file.fileno())
    os.replace(unfinished, path)
