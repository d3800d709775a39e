"""Paths, errors and other people's texts in words that can be shown."""

import os
import shlex
import subprocess
import sys
from pathlib import Path


def quoted(path: Path | str) -> str:
    """Return a path as one word of a shell's command line."""
    # A name that begins with a dash would be taken for an option.
    text = os.path.join(os.curdir, path) if str(path).startswith("-") else str(path)
    return subprocess.list2cmdline([text]) if sys.platform == "win32" else shlex.quote(text)


def printable(text: str) -> str:
    """Return a text in one line, and without what a terminal would obey."""
    return "".join(
        letter if letter.isprintable() else f"\\x{ord(letter):02x}"
        for letter in " ".join(text.split())
    )


def shown(value: object) -> str:
    """Return the beginning of a value in words, however long or deep it is."""
    try:
        return f"{value!r:.200}"
    except (RecursionError, ValueError):  # an integer of thousands of digits
        return f"a {type(value).__name__}"


def cause(error: OSError) -> str:
    """Return the reason of an error in words, without its number and file."""
    return error.strerror or str(error) or type(error).__name__
