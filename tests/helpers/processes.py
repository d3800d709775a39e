"""Runs programs in processes of their own, as users do.

Each function waits for the program's end, checks its exit status and returns what it printed. The
message of a failed check shows the command and all of its output.
"""

import os
import shlex
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypedDict, Unpack

# Seconds that a test waits for what must come. It is the last net: no correct program takes so long
# on a busy machine.
PATIENCE = 300.0
# Changes of the environment that switch Numba's compiler off and on.
INTERPRETED = {"NUMBA_DISABLE_JIT": "1"}
COMPILED = {"NUMBA_DISABLE_JIT": "0"}
# The command `arkanoid` of this interpreter, wherever its script lies.
ARKANOID = (sys.executable, "-m", "arkanoid")


class Options(TypedDict, total=False):
    """How to run a program: what every function below takes as keywords."""

    status: int | None  # the exit status to expect, 0 by default; None accepts any
    changes: Mapping[str, str]  # environment variables to set, beside those of this process
    cwd: str | Path  # the folder to run in
    timeout: float  # seconds; then the program is killed and the test fails. PATIENCE by default
    encoding: str  # in which a Python program writes and its output is read; UTF-8 by default


def run(*command: str | Path, **options: Unpack[Options]) -> subprocess.CompletedProcess[str]:
    """Run a command, check its exit status, and return its `returncode`, `stdout` and `stderr`."""
    words = [str(word) for word in command]
    status = options.get("status", 0)
    encoding = options.get("encoding", "utf-8")
    done = subprocess.run(
        words,
        env={**os.environ, "PYTHONIOENCODING": encoding, **options.get("changes", {})},
        cwd=options.get("cwd"),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding=encoding,
        errors="replace",
        timeout=options.get("timeout", PATIENCE),
    )
    assert status is None or done.returncode == status, (
        f"exit status {done.returncode} instead of {status}: {shlex.join(words)}\n"
        f"--- stdout ---\n{done.stdout}\n--- stderr ---\n{done.stderr}"
    )
    return done


def run_python(
    *arguments: str | Path, warnings: str = "error", **options: Unpack[Options]
) -> subprocess.CompletedProcess[str]:
    """Run this Python with arguments, such as a script's path.

    A warning is an error, unless `warnings` is another action of Python's `-W`, such as "default".
    """
    return run(sys.executable, "-W", warnings, *arguments, **options)


def run_program(
    text: str, *arguments: str | Path, warnings: str = "error", **options: Unpack[Options]
) -> subprocess.CompletedProcess[str]:
    """Run a Python program that is given as text, with arguments."""
    return run_python("-c", text, *arguments, warnings=warnings, **options)


def run_arkanoid(
    *arguments: str | Path, **options: Unpack[Options]
) -> subprocess.CompletedProcess[str]:
    """Run the command `arkanoid` with arguments. Warnings are shown, and are no errors."""
    return run(*ARKANOID, *arguments, **options)


def wait_for(condition: Callable[[], object], process: subprocess.Popen[str] | None = None) -> None:
    """Wait until a condition holds; a process, if one is given, must run until then."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert process is None or process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)


def start_arkanoid(
    *arguments: str | Path, start_new_session: bool = False
) -> subprocess.Popen[str]:
    """Start the command `arkanoid` and return its process, for a test that sends it signals.

    With `start_new_session` its processes form a group of their own.
    """
    return subprocess.Popen(
        [*ARKANOID, *map(str, arguments)],
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        start_new_session=start_new_session,
    )
