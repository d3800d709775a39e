"""What the compiler of kernels tells the user: lines on stderr, each at most once per process."""

import sys
from functools import cache
from pathlib import Path

CACHE_VARIABLE = "ARKANOID_CACHE_DIR"


def say_compiling() -> None:
    """Say that the wait is for the compiler."""
    _say_once("compiling kernels for this machine (once; about half a minute) ...")


def say_compiling_for(machines: str) -> None:
    """Say that the wait is for the compiler, which works for other machines."""
    _say_once(f"compiling kernels for {machines} (once; about a minute) ...")


def say_unwritable(folder: Path, error: OSError) -> None:
    """Say that a cache folder cannot be written, and what to do about it."""
    say_uncached(f"{folder} cannot be written ({error.strerror})")


def say_uncached(reason: str) -> None:
    """Say why nothing is cached, and what to do about it."""
    _say_once(
        f"{reason}, so every process compiles the kernels again. Set {CACHE_VARIABLE} to a folder "
        "that can be written."
    )


@cache
def _say_once(line: str) -> None:
    print(f"arkanoid: {line}", file=sys.stderr, flush=True)
