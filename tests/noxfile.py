"""Runs that need virtual environments of their own: `nox -f tests/noxfile.py -l` lists them.

It does not lie in the root, where every Python file is a part of the package.
"""

import sys
import tarfile
from pathlib import Path
from tempfile import TemporaryDirectory

import nox

TESTS = Path(__file__).resolve().parent
ROOT = TESTS.parent
sys.path.insert(0, str(TESTS))

from compat.peers import Peer, read_peers  # noqa: E402

nox.needs_version = ">=2024.10"
nox.options.default_venv_backend = "venv"
nox.options.envdir = str(ROOT / "build" / "nox")
PEERS = [nox.param(peer, id=peer.name) for peer in read_peers().values()]
# As in the Makefile.
PARALLEL = ("-n", "2", "--dist", "worksteal")
INSTALLED = "import arkanoid, sys; sys.exit(not arkanoid.__file__.startswith(sys.prefix))"


@nox.session
@nox.parametrize("peer", PEERS)
def compat(session: nox.Session, peer: Peer) -> None:
    """Try the environment with a peer."""
    if not peer.supports(sys.version_info[:2]):
        session.skip(f"{peer.name} has wheels for Python {' to '.join(peer.python)} only")
    with TemporaryDirectory() as temporary:
        constraints = Path(temporary, "constraints.txt")
        constraints.write_text("\n".join(peer.constraints()), encoding="utf-8")
        wheel, _ = build(session, Path(temporary, "dist"))
        session.install("--constraint", str(constraints), *peer.requirements, str(wheel))
    if peer.alone:
        session.install("--no-deps", "--no-build-isolation", *peer.alone)
    for clone in peer.clones:
        address, commit = clone.split("@")
        folder = ROOT / "build" / "clones" / Path(address).name.lower()
        if not folder.exists():
            session.run("git", "clone", "--quiet", address, str(folder), external=True)
        session.run("git", "-C", str(folder), "checkout", "--quiet", commit, external=True)
    session.chdir(TESTS)
    kernels = str(ROOT / "build" / "compat-kernels")
    session.run("python", "-m", "compat.run", peer.name, env={"ARKANOID_CACHE_DIR": kernels})


@nox.session
@nox.parametrize("kind", ["wheel", "sdist"])
def distcheck(session: nox.Session, kind: str) -> None:
    """Run the tests against a distribution; options of pytest follow --.

    The tests are those of the unpacked source distribution, outside of the repository. So nothing
    else provides a file that a distribution lacks.
    """
    with TemporaryDirectory() as folder:
        wheel, sdist = build(session, Path(folder, "dist"))
        requirement = f"arkanoid[dev] @ {(wheel if kind == 'wheel' else sdist).as_uri()}"
        session.install("--constraint", str(ROOT / "constraints.txt"), requirement)
        with tarfile.open(sdist) as archive:
            archive.extractall(folder, filter="data")
        (root,) = Path(folder).glob("arkanoid-*")
        with session.chdir(root):
            session.run("python", "-c", INSTALLED)
            # Otherwise copies of the same sources would replace each other's compiled kernels.
            cache = {"ARKANOID_CACHE_DIR": str(Path(folder, "cache"))}
            session.run("python", "-m", "pytest", *PARALLEL, *session.posargs, env=cache)


@nox.session(reuse_venv=True)
def ray(session: nox.Session) -> None:
    """Train with RLlib and measure it; parts of the run follow --.

    RLlib pins an older Gymnasium, so it has constraints of its own.
    """
    session.chdir(ROOT)
    session.install("--constraint", "constraints-ray.txt", "--editable", ".[ray,train]")
    session.run("python", "tests/cluster/run.py", *session.posargs)


@nox.session(reuse_venv=True)
def lock(session: nox.Session) -> None:
    """Pin the versions that make installs; options of uv follow --, such as --upgrade.

    A pin stays as it is while pyproject.toml allows it. The constraints hold for every system and
    for every Python that is supported, and agree in everything but the Gymnasium that RLlib pins.
    The requirements are the same pins with the checksums of their files.
    """
    session.chdir(ROOT)
    session.install("uv")
    resolve = (
        *("uv", "pip", "compile", "pyproject.toml", "--universal", "--python-version", "3.11"),
        *("--no-build", "--no-annotate", "--custom-compile-command", "make lock", "--quiet"),
        *session.posargs,
    )
    hashed = ("--generate-hashes", "--constraint")
    extras = ("--extra", "dev", "--extra", "docs", "--extra", "bench")
    extras += ("--extra", "gpu", "--extra", "mlflow", "--extra", "wandb")
    session.run(*resolve, *extras, "--output-file", "constraints.txt", silent=True)
    locked = (*hashed, "constraints.txt", "--output-file", "requirements.txt")
    session.run(*resolve, *extras, *locked, silent=True)
    pins = Path("constraints.txt").read_text(encoding="utf-8").splitlines()
    with TemporaryDirectory() as folder:
        shared = Path(folder, "shared.txt")
        shared.write_text("\n".join(p for p in pins if not p.startswith("gymnasium==")), "utf-8")
        extras = ("--extra", "ray", "--extra", "train", "--constraint", str(shared))
        session.run(*resolve, *extras, "--output-file", "constraints-ray.txt", silent=True)
        locked = (*hashed, "constraints-ray.txt", "--output-file", "requirements-ray.txt")
        session.run(*resolve, *extras, *locked, silent=True)


def build(session: nox.Session, folder: Path) -> tuple[Path, Path]:
    """Build the distributions into a folder, and return the wheel and the source distribution.

    The wheel is built from the source distribution: one that is built in the tree would also hold
    what earlier builds left there.
    """
    ship = (sys.executable, "-m", "arkanoid.envs.browser.shipped")
    session.run_install(*ship, external=True, silent=True)
    command = (sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT))
    session.run_install(*command, external=True, silent=True)
    (wheel,), (sdist,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
    return wheel, sdist
