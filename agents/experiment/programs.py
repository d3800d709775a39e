"""Command lines for the user's shell, which need not know where the programs lie."""

import shutil
import sys
import sysconfig
from pathlib import Path

from ..interrupts import is_command
from .files import quoted

ARKANOID = "arkanoid"


def command(program: str, *words: Path | str) -> str:
    """Return a command line that works as it is, also where no environment is activated.

    It begins with the program's name where the shell finds the one of this environment by it, and
    otherwise with its path. Words are taken as they are; paths are quoted.
    """
    own = (quoted(word) if isinstance(word, Path) else word for word in words)
    return " ".join([start_of(program), *own])


def arkanoid(*words: Path | str) -> str:
    """Return a command line of this program, see `command`."""
    return command(ARKANOID, *words)


def start_of(program: str) -> str:
    """Return what a command line of a program begins with."""
    own = _own(program)
    if own is None:
        is_module = program in (ARKANOID, "pip")
        return f"{quoted(sys.orig_argv[0])} -m {program}" if is_module else program
    found = shutil.which(program)
    known = found is not None and Path(found).exists() and Path(found).samefile(own)
    return program if known else quoted(own)


def activation() -> str | None:
    """Return the command that lets the shell find the programs by name; None if it does so.

    Also None without a virtual environment.
    """
    own = _own(ARKANOID)
    if own is None or start_of(ARKANOID) == ARKANOID:
        return None
    script = Path(own).with_name("activate")
    if not script.is_file():
        return None
    return quoted(script) if sys.platform == "win32" else f". {quoted(script)}"


def _own(program: str) -> str | None:
    """Return the path of a program of this environment, as it was typed; None if there is none."""
    folder = str(Path(sys.argv[0]).parent) if is_command() else sysconfig.get_path("scripts")
    here = shutil.which(program, path=folder)
    # Started by `python -m`, the command lies in the package and not among the scripts.
    return here or shutil.which(program, path=sysconfig.get_path("scripts"))
