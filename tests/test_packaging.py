"""The wheel holds exactly the package, however it is built."""

import ast
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path, PurePosixPath

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
# Folders of the root that are no packages.
NOT_PACKAGES = ("tests/", "docs/")
DATA = ("py.typed", ".toml", ".txt")
# Each set of versions, and the extras that are installed by it.
LOCKS = {
    "constraints.txt": {"train", "play", "bench", "docs", "dev"},
    "constraints-ray.txt": {"train", "ray"},
}
# The agent that comes with the package: its settings, where it comes from, its network.
PRETRAINED = tuple(f"agents/pretrained/{name}" for name in ("config.toml", "run.json", "model.zip"))
LONGEST_PATH = 120  # letters, of the 260 that a whole path may have on Windows
RESERVED = re.compile(
    r'[\x00-\x1f<>:"\\|?*]|[ .](/|$)|(^|/)(con|prn|aux|nul|com\d|lpt\d)(\.|/|$)', re.I
)


def sources() -> list[str]:
    """Return the files of the repository: what git tracks or would, if this is a clone."""
    listing = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    if (ROOT / ".git").exists():
        assert listing.returncode == 0, listing.stderr
        names = listing.stdout.splitlines()
    else:  # an unpacked source distribution
        paths = (path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file())
        names = [path.as_posix() for path in paths if not is_made(path)]
    return sorted(name for name in names if (ROOT / name).is_file())


def is_made(path: Path) -> bool:
    """Tell whether a file was made here: caches, builds, virtual environments."""
    return any(
        part.startswith(".") or part in ("__pycache__", "build", "dist", "runs")
        for part in path.parent.parts
    )


def package_files() -> list[str]:
    """Return the files that belong into the wheel, as paths from the root."""
    return [
        name
        for name in sources()
        if ("/" in name and not name.startswith((*NOT_PACKAGES, ".")) and ".egg-info/" not in name)
        or ("/" not in name and name.endswith((".py", "py.typed")))
    ]


def build(source: Path, target: Path, kind: str) -> Path:
    """Build a wheel or sdist with what is installed here, and return its file."""
    done = subprocess.run(
        [sys.executable, "-m", "build", f"--{kind}", "--no-isolation", "--outdir", target, source],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (file,) = target.iterdir()
    return file


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the sources: builds leave files beside them, and reuse what they find."""
    folder = tmp_path_factory.mktemp("any name")
    for name in sources():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    return folder


@pytest.fixture(scope="module")
def wheel(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(tree, tmp_path_factory.mktemp("wheel"), "wheel")


@pytest.fixture(scope="module")
def sdist(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(tree, tmp_path_factory.mktemp("sdist"), "sdist")


def contents(wheel: Path) -> list[str]:
    """Return what a wheel installs, without its metadata."""
    names = zipfile.ZipFile(wheel).namelist()
    return sorted(name for name in names if not PurePosixPath(name).parts[0].endswith(".dist-info"))


def test_wheel_holds_exactly_the_package(wheel: Path) -> None:
    assert contents(wheel) == sorted(f"arkanoid/{name}" for name in package_files())


def test_every_file_of_the_package_is_source_or_data() -> None:
    assert [
        name for name in package_files() if not name.endswith((".py", *DATA, *PRETRAINED))
    ] == []


def test_wheel_holds_types_experiments_and_levels(wheel: Path) -> None:
    names = contents(wheel)
    assert "arkanoid/py.typed" in names
    assert any(re.fullmatch(r"arkanoid/configs/\w+\.toml", name) for name in names)
    assert {f"arkanoid/{name}" for name in PRETRAINED} <= set(names)
    assert any(re.fullmatch(r"arkanoid/envs/levels/named/\w+\.txt", name) for name in names)


def test_sdist_builds_the_same_wheel(wheel: Path, sdist: Path, tmp_path: Path) -> None:
    with tarfile.open(sdist) as archive:
        archive.extractall(tmp_path, filter="data")
    (folder,) = tmp_path.iterdir()
    assert contents(build(folder, tmp_path / "out", "wheel")) == contents(wheel)


def test_sdist_holds_what_its_own_check_needs(sdist: Path) -> None:
    """Hidden files, too: once .ci/run and the hooks, which CONTRIBUTING.md names, were missing."""
    with tarfile.open(sdist) as archive:
        held = {name.partition("/")[2] for name in archive.getnames()}
    assert {name for name in sources() if name not in held} <= {".gitignore"}


def test_wheel_works_without_the_repository(wheel: Path, tmp_path: Path) -> None:
    zipfile.ZipFile(wheel).extractall(tmp_path)
    program = """
import importlib, pkgutil, sys
import arkanoid
for module in pkgutil.walk_packages(arkanoid.__path__, "arkanoid."):
    if not module.name.startswith("arkanoid.agents"):
        importlib.import_module(module.name)
print(arkanoid.__file__, arkanoid.__version__)
"""
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [str(tmp_path / "arkanoid" / "__init__.py"), version()]


def version() -> str:
    """Return the version without importing the package."""
    (assignment,) = (
        node
        for node in ast.parse((ROOT / "version.py").read_bytes()).body
        if isinstance(node, ast.Assign)
    )
    return str(ast.literal_eval(assignment.value))


def test_every_system_can_hold_the_files() -> None:
    """Windows refuses some letters, some names and long paths; there and on macOS A is a."""
    names = sources()
    assert len({name.lower() for name in names}) == len(names)
    assert [name for name in names if len(name) > LONGEST_PATH or RESERVED.search(name)] == []


def pins(file: str) -> dict[str, str]:
    """Return the version that a file of constraints has for each package."""
    lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
    pairs = (line.split("==") for line in lines if not line.startswith("#"))
    return {canonical(name): version for name, version in pairs}


@pytest.mark.parametrize(("file", "extras"), LOCKS.items())
def test_every_requirement_has_its_pin(file: str, extras: set[str]) -> None:
    """What `make` installs is one set of versions, without a hole, and those that are allowed."""
    project = PROJECT["project"]
    groups = [project["dependencies"], *(project["optional-dependencies"][name] for name in extras)]
    wanted = [Requirement(text) for group in groups for text in group]
    pinned = pins(file)
    assert {canonical(one.name) for one in wanted} - pinned.keys() <= {"arkanoid"}
    for one in wanted:
        assert one.name == "arkanoid" or pinned[canonical(one.name)] in one.specifier


def test_constraints_differ_only_in_gymnasium() -> None:
    """RLlib wants exactly one version of it; all else is the same with and without RLlib."""
    everywhere, ray = pins("constraints.txt"), pins("constraints-ray.txt")
    both = everywhere.keys() & ray.keys()
    assert {name for name in both if everywhere[name] != ray[name]} <= {"gymnasium"}


def canonical(name: str) -> str:
    """Return the one of a package's many spellings that compares."""
    return re.sub(r"[-_.]+", "-", name).lower()


def test_version_is_in_one_place(wheel: Path) -> None:
    assert "version" not in PROJECT["project"]
    assert wheel.name.startswith(f"arkanoid-{version()}-")


def test_every_subpackage_is_listed() -> None:
    """Setuptools is told the packages by name; a new one would silently miss in the wheel."""
    folders = {PurePosixPath("arkanoid", name).parent for name in package_files()}
    assert sorted(PROJECT["tool"]["setuptools"]["packages"]) == sorted(
        ".".join(folder.parts) for folder in folders
    )


def test_extras_for_developing_hold_those_for_users() -> None:
    extras = PROJECT["project"]["optional-dependencies"]
    assert set(extras) == {"train", "play", "ray", "bench", "docs", "dev"}
    assert "arkanoid[train,play]" in extras["dev"]


@pytest.mark.parametrize("file", LOCKS)
def test_constraints_are_portable(file: str) -> None:
    """A pin such as ``torch==2.13.0+cpu`` names a build that the package index does not have."""
    lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
    listed = [line for line in lines if not line.startswith("#")]
    assert [pin for pin in listed if not re.fullmatch(r"[\w-]+==[\w.]+", pin)] == []
    assert "torch==2.13.0" in listed
    assert "nvidia" not in " ".join(listed)
