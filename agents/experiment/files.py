"""Paths, errors and other people's texts in words that can be shown."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

from .errors import SettingsError


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


def check_folder(file: Path) -> None:
    """Raise `SettingsError` unless there is a folder in which a new file can be written."""
    folder = file.parent
    if not folder.is_dir():
        raise SettingsError(f"{folder}: there is no such folder; make it first")
    if file.is_dir():
        raise SettingsError(f"{file}: that is a folder; give the name of a file in it")
    if not os.access(folder, os.W_OK):
        named = Path.cwd() if folder == Path() else folder
        raise SettingsError(f"{named}: you may not write into this folder; name another one")


def check_new_folder(folder: Path) -> None:
    """Raise `SettingsError` unless a folder is there or can be made, and can be written into."""
    nearest = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not nearest.is_dir():
        raise SettingsError(f"{folder}: {nearest} is no folder; name another place")
    if not os.access(nearest, os.W_OK):
        raise SettingsError(f"{folder}: you may not write into {nearest}; name another place")


def check_picture(file: Path) -> None:
    """Raise `SettingsError` unless a PNG of this name can be written, as far as that shows now."""
    if file.suffix.lower() != ".png":
        raise SettingsError(f"{file}: pictures are written as PNG; let the name end in .png")
    check_folder(file)


def level_mistake(name: str, error: Exception) -> str:
    """Return a sentence about a level that cannot be played, and how levels are named."""
    told = str(error)
    if told.startswith("no level"):
        told += " Generated levels are seed:7, seeds:0-9, train or test."
    return told if name in told else f"level {name!r}: {told}"


def cause(error: OSError) -> str:
    """Return the reason of an error in words, without its number and file."""
    return error.strerror or str(error) or type(error).__name__
