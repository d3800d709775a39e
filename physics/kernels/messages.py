"""What the compiler of kernels tells the user: lines on stderr, each at most once per process."""

import sys
from functools import cache
from pathlib import Path

CACHE_VARIABLE = "ARKANOID_CACHE_DIR"

# What a kernel belongs to, by how its module's name begins below the package: the first that fits.
# How long a part takes was measured on a core of an AMD EPYC that has nothing else to do.
PARTS = {
    "envs.draw.": "pictures (once; about 6 seconds)",
    "envs.observe.pixels": "pictures as observations (once; about 4 seconds)",
    "envs.observe.": "observations (once; some seconds)",
    "envs.levels.generator": "generated levels (once; some seconds)",
    "envs.": "the game (once; about 15 seconds)",
    "physics.": "the engine (once; some seconds)",
}


def say_compiling(module: str) -> None:
    """Say that the wait is for the compiler.

    Args:
        module: of the kernel that it compiles, as it is named below the package.
    """
    for beginning, part in PARTS.items():
        if module.startswith(beginning):
            _say_once(f"compiling kernels of {part} ...")
            return


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
