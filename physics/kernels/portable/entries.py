"""Entries, and the machine-independent code that Numba makes of them."""

import os
import subprocess
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from ..decorators import UNCACHED

_PROGRAM = f"{__package__}.afresh"


class Entry(NamedTuple):
    """A kernel ``(index, address)`` that other machines can run.

    Attributes:
        module: where it lies, a dotted name.
        name: of the kernel there, and of the machine's function.
    """

    module: str
    name: str

    @property
    def file(self) -> Path:
        """The source file."""
        return Path(str(import_module(self.module).__file__))


def compile_entries(entries: Sequence[Entry], optimised: bool = True) -> str:
    """Return LLVM's code for entries, in its text form, not yet for any machine.

    What the disk cache gave to this process can't be looked into, and code that is meant for this
    processor's vectors is of no use elsewhere. So a process of its own compiles afresh.

    Args:
        optimised: whether LLVM has optimised it, as for machines with pointers of 64 bits.

    Raises:
        RuntimeError: it has failed; the message is its own.
    """
    environment = {
        **os.environ,
        UNCACHED: "1",
        "NUMBA_DISABLE_JIT": "0",
        "NUMBA_OPT": "3" if optimised else "0",
        "NUMBA_LOOP_VECTORIZE": "0",
        "NUMBA_SLP_VECTORIZE": "0",
        "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
    }
    names = [f"{entry.module}:{entry.name}" for entry in entries]
    done = subprocess.run(
        [sys.executable, "-m", _PROGRAM, *names],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError(f"the kernels could not be compiled afresh:\n{done.stderr}")
    return done.stdout
