"""Where a result comes from: versions, commit, machine; and the fingerprint of a network."""

import hashlib
import os
import platform
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from typing import Any

from ...version import __version__

# The packages on which the numbers of a training run depend.
PACKAGES = ("gymnasium", "llvmlite", "numba", "numpy", "stable_baselines3", "torch")

_ROOT = Path(__file__).resolve().parents[2]


def describe_origin() -> dict[str, Any]:
    """Return versions, git commit and hardware, as JSON takes them."""
    return {"versions": _versions(), "git": _commit(), "hardware": _hardware()}


def weights_hash(state: dict[str, Any]) -> str:
    """Return the SHA-256, in hexadecimal, of a ``state_dict``: names, shapes and bits."""
    digest = hashlib.sha256()
    for name, tensor in sorted(state.items()):
        array = tensor.detach().cpu().contiguous().numpy()
        digest.update(f"{name} {array.dtype.str} {array.shape}\n".encode())
        digest.update(array.tobytes())
    return digest.hexdigest()


def _versions() -> dict[str, str]:
    found = {"arkanoid": __version__, "python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return found


def _commit() -> dict[str, Any] | None:
    """Return the clone's commit, and whether files are changed; None without a clone."""
    commit = _git("rev-parse", "HEAD")
    top = _git("rev-parse", "--show-toplevel")
    # An installed copy may lie in another repository.
    if commit is None or top is None or Path(top).resolve() != _ROOT:
        return None
    return {"commit": commit, "changed": bool(_git("status", "--porcelain"))}


def _git(*arguments: str) -> str | None:
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=_ROOT, capture_output=True, text=True, timeout=30
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def _hardware() -> dict[str, Any]:
    return {
        "system": platform.platform(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "memory_gib": memory_gib(),
        "byte_order": sys.byteorder,
    }


def _processor() -> str:
    """Return the processor's name; on Linux only a file tells it."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def memory_gib() -> float | None:
    """Return the machine's memory in GiB, or None where the system does not tell."""
    try:
        size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return None
    return round(size / 2**30, 1)
