"""Builds the wheel and the source distribution, and runs the tests against each, installed.

    make distcheck                                # the whole suite, twice
    make distcheck PYTEST=tests/test_imports.py   # options of pytest are passed on

The tests are those of the unpacked source distribution, in a folder outside of the repository, and
the packages are in a virtual environment of its own: what a distribution lacks, nothing else lends.
"""

import os
import subprocess
import sys
import tarfile
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
INSTALLED = "import arkanoid, sys; sys.exit(not arkanoid.__file__.startswith(sys.prefix))"


def main(options: list[str]) -> None:
    """Check both distributions with pytest's options."""
    with tempfile.TemporaryDirectory(prefix="arkanoid-") as name:
        folder = Path(name)
        # The wheel is built from the source distribution, which nothing that lies around can enter.
        run([sys.executable, "-m", "build", "--outdir", folder / "dist", ROOT], folder)
        (wheel,) = (folder / "dist").glob("*.whl")
        (sdist,) = (folder / "dist").glob("*.tar.gz")
        venv.create(folder / "venv", with_pip=True)
        for distribution in (wheel, sdist):
            install(distribution, folder)
            check(unpack(sdist, folder / distribution.name), folder, options)
            print(f"{distribution.name}: the tests pass", flush=True)


def install(distribution: Path, folder: Path) -> None:
    """Install a distribution with what its tests need, in place of the one before."""
    pip = [python(folder), "-m", "pip", "install", "--constraint", ROOT / "constraints.txt"]
    run([*pip, f"{distribution}[dev]"], folder)
    run([*pip, "--force-reinstall", "--no-deps", distribution], folder)


def unpack(sdist: Path, target: Path) -> Path:
    """Return the folder of an unpacked source distribution."""
    with tarfile.open(sdist) as archive:
        archive.extractall(target, filter="data")
    (root,) = target.iterdir()
    return root


def check(root: Path, folder: Path, options: list[str]) -> None:
    """Run the tests of a folder against the package that is installed."""
    run([python(folder), "-c", INSTALLED], root)
    # Compiled kernels are kept apart: other copies of the same sources would take turns with ours.
    environment = os.environ | {"ARKANOID_CACHE_DIR": str(folder / "cache")}
    run([python(folder), "-m", "pytest", "-n", "2", *options], root, environment)


def python(folder: Path) -> Path:
    """Return the interpreter of the virtual environment."""
    return folder / "venv" / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def run(command: list[str | Path], where: Path, environment: dict[str, str] | None = None) -> None:
    """Run a command; if it fails, so does all."""
    done = subprocess.run(command, cwd=where, env=environment)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, command))}")


if __name__ == "__main__":
    main(sys.argv[1:])
