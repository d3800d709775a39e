"""A scratch package with a few tiny kernels, which tests may edit, and a cache of its own.

It holds the real folder ``physics/kernels``. Every program runs in a fresh process, as a user's
would.
"""

import json
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

from helpers.processes import run
from helpers.repository import ROOT

FILES = {
    "arkanoid/__init__.py": "",
    "arkanoid/physics/__init__.py": "",
    "arkanoid/physics/numbers.py": "FACTOR = 2.0\n",
    "arkanoid/physics/callee.py": """
from .kernels import kernel
from .numbers import FACTOR

@kernel
def scaled(x):
    return x * FACTOR
""",
    "arkanoid/envs/__init__.py": "",
    "arkanoid/envs/caller.py": """
from ..physics.callee import scaled
from ..physics.kernels import kernel

@kernel
def shifted(x):
    return scaled(x) + 1.0
""",
    "user.py": """
from arkanoid.physics.callee import scaled
from arkanoid.physics.kernels import kernel

@kernel
def shifted(x):
    return scaled(x) + 1.0
""",
}

PRELUDE = """
import json
from numba.core import event
recorder = event.RecordingListener()
event.register("numba:compile", recorder)
def report(result):
    compiled = [e.data["dispatcher"].py_func.__name__ for _, e in recorder.buffer if e.is_start]
    print(json.dumps([result, compiled]))
"""
CALL = "from arkanoid.envs.caller import shifted; report(shifted(10.0))"


@dataclass(frozen=True)
class Outcome:
    """What a program reported, which kernels it compiled, and what it wrote to stderr."""

    result: float
    compiled: list[str]
    stderr: str


class Scratch:
    """A scratch package in ``folder / "code"`` and its cache in ``folder / "cache"``."""

    def __init__(self, folder: Path) -> None:
        self.code = folder / "code"
        self.cache = folder / "cache"
        for name, text in FILES.items():
            self.write(name, text)
        original = ROOT / "physics" / "kernels"
        shutil.copytree(
            original,
            self.code / "arkanoid" / "physics" / "kernels",
            ignore=shutil.ignore_patterns("__pycache__"),
        )

    def write(self, name: str, text: str) -> None:
        """Write a source file."""
        file = self.code / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def replace(self, name: str, old: str, new: str) -> None:
        """Replace text, which must be there, in a source file."""
        text = (self.code / name).read_text(encoding="utf-8")
        assert old in text
        self.write(name, text.replace(old, new))

    def run(self, program: str = CALL, **environment: str) -> Outcome:
        """Run a program in a new process; it ends with a call of ``report(result)``."""
        settings = {
            "PYTHONPATH": str(self.code),
            "ARKANOID_CACHE_DIR": str(self.cache),
            "NUMBA_DISABLE_JIT": "0",
        }
        done = run(
            *(sys.executable, "-c", PRELUDE + program),
            cwd=self.code,
            changes={**settings, **environment},
        )
        return Outcome(*json.loads(done.stdout), done.stderr)

    def folders(self) -> list[Path]:
        """Return the cache's folders, one for each digest."""
        return sorted((self.cache / "kernels").iterdir())

    def files(self) -> list[Path]:
        """Return the cache's files."""
        return sorted(file for file in self.cache.rglob("*") if file.is_file())
