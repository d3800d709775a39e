"""Where machine code is kept: a folder on disk for each digest of sources.

The folders lie in ``kernels`` under the user's cache folder, or under ``ARKANOID_CACHE_DIR``. Where
neither can be written, every process compiles the kernels again, and one line says so.
"""

import os
import re
import shutil
import tempfile
import time
from functools import cache
from pathlib import Path

import platformdirs

from .digest import digest, is_edited
from .messages import CACHE_VARIABLE, say_uncached, say_unwritable

# Long enough for a project that pauses for a holiday, short enough to be no burden: a folder holds
# a few MB, and every edit of a kernel begins new ones.
PRUNE_AFTER = 30 * 86_400.0  # seconds

_FOLDER_NAME = re.compile("[0-9a-f]{16}")  # a digest


def writable_folder(file: Path, compiler: str) -> Path | None:
    """Return the folder for the machine code of one source file's kernels, made if need be.

    Args:
        file: the source file.
        compiler: the compiler's version and settings, see `numba_internals.compiler_state`.

    Returns:
        None if nothing can be kept: there is no such file (the function was typed at a prompt or
        lies in an archive), sources were edited after this process read them, or no cache folder
        can be written, and none is filled.
    """
    file = file.resolve()
    if not file.is_file() or is_edited(file):
        return None
    root = _cache_root()
    if root is None:
        return None
    folder = root / "kernels" / digest(file, compiler)
    return folder if _prepare(folder) else None


def why_unkept() -> str | None:
    """Return why no machine code can be kept, in a clause; None if it can."""
    root = _cache_root()
    if root is None:
        return "there is no cache folder"
    kernels = root / "kernels"
    try:
        kernels.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=kernels).close()
    except OSError as error:
        return f"{kernels} cannot be written ({error.strerror})"
    return None


def _cache_root() -> Path | None:
    """Return the folder that the variable names, or else the user's; None without a home."""
    try:
        root = os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_dir("arkanoid", False)
        return Path(root).expanduser().absolute()
    except RuntimeError as error:  # an unknown user without HOME, as containers have them
        say_uncached(f"There is no cache folder ({error})")
        return None


@cache
def _prepare(folder: Path) -> bool:
    """Make the folder, mark it as in use, and return whether it is there to be read or written.

    A folder that somebody else has filled, as in a container image, need not be written.
    Numba itself would fall back to ``__pycache__``, and with it to stale machine code.
    """
    try:
        if not folder.is_dir():
            folder.mkdir(parents=True, exist_ok=True)
            _prune(folder.parent)
        os.utime(folder)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        if _is_filled(folder):
            return True
        say_unwritable(folder.parent, error)
        return False
    return True


def _is_filled(folder: Path) -> bool:
    try:
        return any(each.is_dir() and os.access(each, os.R_OK) for each in folder.iterdir())
    except OSError:
        return False


def _prune(kernels: Path) -> None:
    """Delete the folders of earlier sources that no process has used for ``PRUNE_AFTER``."""
    for folder in kernels.iterdir():
        # The root may be any folder that the user named: delete only what has a name of ours.
        if _FOLDER_NAME.fullmatch(folder.name) and _age(folder) > PRUNE_AFTER:
            shutil.rmtree(folder, ignore_errors=True)


def _age(folder: Path) -> float:
    """Return the seconds since a process last used the folder, 0 if it is gone already."""
    try:
        return time.time() - folder.stat().st_mtime
    except OSError:
        return 0.0
