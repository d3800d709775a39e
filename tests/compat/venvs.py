"""Virtual environments, one a peer, made again only if what the peer requires has changed."""

import hashlib
import shutil
import subprocess
import sys
import venv
from pathlib import Path

from peers import ROOT, Peer

BUILD = ROOT / "build" / "compat"


def build_wheel() -> Path:
    """Build the wheel as it would be published, and return it.

    By way of the source distribution: one built in the tree holds what earlier builds left there.
    """
    folder = BUILD / "dist"
    shutil.rmtree(folder, ignore_errors=True)
    call(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT)
    (wheel,) = folder.glob("*.whl")
    return wheel


def make_venv(peer: Peer, wheel: Path) -> Path:
    """Return the Python of a virtual environment with the peer and the wheel."""
    wanted = "\n".join([*peer.requirements, *peer.constraints(), sys.version])
    folder = BUILD / f"{peer.name}-{hashlib.sha256(wanted.encode()).hexdigest()[:12]}"
    python = folder / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    pip = [python, "-m", "pip", "install", "--quiet", "--no-compile", "--disable-pip-version-check"]
    if not (folder / "ready").exists():
        for old in BUILD.glob(f"{peer.name}-{'?' * 12}"):
            shutil.rmtree(old)
        venv.create(folder, with_pip=True)
        constraints = folder / "constraints.txt"
        constraints.write_text("\n".join(peer.constraints()), encoding="utf-8")
        call(*pip, "--constraint", constraints, *peer.requirements, wheel)
        (folder / "ready").touch()
    else:
        call(*pip, "--no-deps", "--force-reinstall", wheel)
    return python


def call(*words: str | Path) -> str:
    """Run a program, and return what it prints; RuntimeError with its end if it fails."""
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        end = "\n".join((done.stdout + done.stderr).splitlines()[-20:])
        raise RuntimeError(f"{' '.join(map(str, words))}\n{end}")
    return done.stdout
