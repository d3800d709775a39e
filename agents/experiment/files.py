"""Files that are there whole or not at all, whenever the process is killed."""

import os
from collections.abc import Callable
from pathlib import Path


def write_whole(path: Path, content: bytes) -> None:
    """Write a file: all of it, or what was there before stays."""

    def write(unfinished: Path) -> None:
        unfinished.write_bytes(content)

    replace_whole(path, write)


def replace_whole(path: Path, write: Callable[[Path], None]) -> None:
    """Let ``write`` make a file, and put it in the place of ``path`` when it is on the disk."""
    unfinished = path.with_name(f"unfinished-{path.name}")
    write(unfinished)
    with unfinished.open("rb+") as file:
        os.fsync(file.fileno())
    os.replace(unfinished, path)
