"""Tries one peer in the virtual environment that holds it, and keeps the result.

    python -m compat.run torchrl        in tests/; `make compat` makes the virtual environments

The result goes into `results.json`, and from there into the documentation.
"""

import argparse
import json
import os
import platform
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from .page import RESULTS, read_results, write_page
from .peers import ROOT, Peer, package, read_peers

PATIENCE = 1800  # seconds that a command may take
KEPT = 6  # lines of a command's output that are kept
PLACES = {
    "{examples}": ROOT / "docs" / "examples",
    "{tests}": ROOT / "tests",
    "{clones}": ROOT / "build" / "clones",
}
# Packages whose versions are kept for every peer, beside the peer's requirements.
ALWAYS = ("arkanoid", "gymnasium", "numba", "numpy", "torch")


def main() -> None:
    """Try the peer that the command line names."""
    peers = read_peers()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("peer", choices=peers)
    name = parser.parse_args().peer
    results = read_results() | {name: try_peer(peers[name])}
    RESULTS.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")
    write_page()
    if not results[name]["passed"]:
        sys.exit(f"{name} fails")


def try_peer(peer: Peer) -> dict[str, Any]:
    """Run a peer's commands until one fails, and return the result."""
    start = time.perf_counter()
    passed, printed = run_all(peer.commands)
    return {
        "passed": passed,
        "seconds": round(time.perf_counter() - start),
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "versions": {name: commit[:8] for name, commit in peer.commits().items()}
        | installed([*map(package, (*peer.alone, *peer.requirements)), *ALWAYS]),
        "printed": printed,
    }


def installed(names: Sequence[str]) -> dict[str, str]:
    """Return the versions of those packages that are installed here."""
    found = {}
    for name in names:
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


def run_all(commands: Sequence[str]) -> tuple[bool, list[str]]:
    """Run commands until one fails; return whether all work, and what they printed."""
    printed: list[str] = []
    passed = True
    with tempfile.TemporaryDirectory() as folder:
        for command in commands:
            print("$", shown(command), flush=True)
            passed, lines = run(command, Path(folder))
            print(*lines, sep="\n", flush=True)
            printed += [f"$ {shown(command)}", *lines]
            if not passed:
                break
    return passed, printed


def run(command: str, folder: Path) -> tuple[bool, list[str]]:
    """Run a command in a folder; return whether it works, and the end of its output."""
    for place, path in PLACES.items():
        command = command.replace(place, path.as_posix())
    words = shlex.split(command)
    assert words[0] == "python", command
    try:
        done = subprocess.run(
            [sys.executable, *words[1:]],
            cwd=folder,
            env=variables(),
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )
    except subprocess.TimeoutExpired:
        return False, [f"still running after {PATIENCE} s"]
    passed = done.returncode == 0
    text = done.stdout if passed else done.stdout + done.stderr
    text = text.replace(f"{ROOT}{os.sep}", "")  # the output is committed
    lines = [line.rstrip() for line in text.splitlines() if line.strip()]
    return passed, lines[-KEPT if passed else -4 * KEPT :]


def variables() -> dict[str, str]:
    """Return the environment variables for the commands."""
    # The networks are small: more threads would mostly wait for each other.
    ours = {"SDL_VIDEODRIVER": "dummy", "MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1"}
    ours |= {"RL_LOGGING_LEVEL": "WARNING"}
    return {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | ours


def shown(command: str) -> str:
    """Return a command as a reader in the root of the repository would type it."""
    for place, path in PLACES.items():
        command = command.replace(place, path.relative_to(ROOT).as_posix())
    return " ".join(command.split())


if __name__ == "__main__":
    main()
