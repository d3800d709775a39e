"""Tries the environment with every peer, each in a virtual environment of its own.

Run: python tests/compat/run.py [PEER ...]        (or: make compat, make compat PEER=torchrl)

What came of it is kept in `results.json`, and docs/compatibility.md is written anew from there.
Virtual environments are in build/compat, and are used again until a requirement changes.
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
from pathlib import Path
from typing import Any

from page import RESULTS, read_results, write_page
from peers import ROOT, Peer, package, read_peers
from venvs import BUILD, build_wheel, call, make_venv

PATIENCE = 1800  # seconds that a command may take
KEPT = 6  # lines that are kept of what a command prints
PLACES = {"{examples}": ROOT / "docs" / "examples", "{tests}": ROOT / "tests"}
# Beside what a peer pins, what decides whether the environment works.
ALWAYS = ("arkanoid", "gymnasium", "numba", "numpy", "torch")
VERSIONS = """
import importlib.metadata, json, sys
found = {}
for name in sys.argv[1:]:
    try:
        found[name] = importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        pass
print(json.dumps(found))
"""


def main() -> None:
    """Try the peers that are named, or all."""
    peers = read_peers()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("peers", nargs="*", metavar="PEER", help=f"of {', '.join(peers)}")
    chosen = parser.parse_args().peers or list(peers)
    unknown = sorted(set(chosen) - set(peers))
    if unknown:
        parser.error(f"no peer {unknown[0]!r}; there are {', '.join(peers)}")
    wheel = build_wheel()
    results = read_results()
    failed = []
    for name in chosen:
        peer = peers[name]
        if not supports_this_python(peer):
            print(f"{name}: not tried, it has wheels for Python {' to '.join(peer.python)} only")
            continue
        results[name] = try_peer(peer, wheel)
        failed += [] if results[name]["passed"] else [name]
        # At once: the next one may take long, or be interrupted.
        RESULTS.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")
        write_page()
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


def supports_this_python(peer: Peer) -> bool:
    """Tell whether the peer can be installed into this Python."""
    oldest, newest = (tuple(map(int, version.split("."))) for version in peer.python)
    return oldest <= sys.version_info[:2] <= newest


def try_peer(peer: Peer, wheel: Path) -> dict[str, Any]:
    """Run a peer's commands until one fails, and return what came of it."""
    print(f"\n== {peer.name}: {peer.tried}", flush=True)
    result = {
        "passed": False,
        "seconds": 0,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "versions": {},
        "printed": [],
    }
    try:
        python = make_venv(peer, wheel)
    except RuntimeError as error:
        # The others may be installed nonetheless.
        print(f"FAILS: {error}", flush=True)
        return result | {"printed": str(error).splitlines()}
    names = dict.fromkeys([*map(package, peer.requirements), *ALWAYS])
    result["versions"] = json.loads(call(python, "-c", VERSIONS, *names))
    start = time.perf_counter()
    result["passed"], result["printed"] = run_all(peer.commands, python)
    result["seconds"] = round(time.perf_counter() - start)
    print(f"{'works' if result['passed'] else 'FAILS'}, {result['seconds']} s", flush=True)
    return result


def run_all(commands: Sequence[str], python: Path) -> tuple[bool, list[str]]:
    """Run commands until one fails; return whether all work, and what was printed."""
    printed: list[str] = []
    passed = True
    with tempfile.TemporaryDirectory() as folder:
        for command in commands:
            print("$", shown(command), flush=True)
            passed, lines = run(command, python, Path(folder))
            print(*lines, sep="\n", flush=True)
            printed += [f"$ {shown(command)}", *lines]
            if not passed:
                break
    return passed, printed


def run(command: str, python: Path, folder: Path) -> tuple[bool, list[str]]:
    """Run a command in a folder; return whether it works, and the end of what it prints."""
    for place, path in PLACES.items():
        command = command.replace(place, path.as_posix())
    words = shlex.split(command)
    assert words[0] == "python", command
    try:
        done = subprocess.run(
            [python, *words[1:]],
            cwd=folder,
            env=surroundings(),
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )
    except subprocess.TimeoutExpired:
        return False, [f"no end after {PATIENCE} s"]
    passed = done.returncode == 0
    text = done.stdout if passed else done.stdout + done.stderr
    text = text.replace(f"{ROOT}{os.sep}", "")  # it is kept in the documentation
    lines = [line.rstrip() for line in text.splitlines() if line.strip()]
    return passed, lines[-KEPT if passed else -4 * KEPT :]


def surroundings() -> dict[str, str]:
    """Return the variables that commands see."""
    # Networks are small: more threads would mostly wait for each other.
    ours = {"SDL_VIDEODRIVER": "dummy", "MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1"}
    ours |= {"ARKANOID_CACHE_DIR": str(BUILD / "kernels"), "RL_LOGGING_LEVEL": "WARNING"}
    return {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | ours


def shown(command: str) -> str:
    """Return a command as someone in the root of the repository would give it."""
    for place, path in PLACES.items():
        command = command.replace(place, path.relative_to(ROOT).as_posix())
    return " ".join(command.split())


if __name__ == "__main__":
    main()
