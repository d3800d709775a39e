"""Distributions hold what they should; extras can be installed under the constraints."""

import re
import shutil
import sys
import tarfile
import zipfile
from pathlib import Path, PurePosixPath

import pytest
from arkanoid import __version__
from helpers.processes import run, run_program
from helpers.repository import EXTRAS, PROJECT, ROOT
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

NOT_PACKAGES = ("tests/", "docs/", ".")  # folders of the root
# The files of constraints, and the extras that are installed under each.
LOCKS = {
    "constraints.txt": (
        *("train", "play", "minari", "gpu", "mlflow", "wandb", "web", "bench", "docs", "dev"),
    ),
    "constraints-ray.txt": ("train", "ray"),
}
LONGEST_PATH = 120  # letters, of the 260 that a whole path may have on Windows
RESERVED = re.compile(
    r'[\x00-\x1f<>:"\\|?*]|[ .](/|$)|(^|/)(con|prn|aux|nul|com\d|lpt\d)(\.|/|$)', re.I
)


def sources() -> list[str]:
    """Return the files of the repository: in a clone, those that git tracks or would."""
    if (ROOT / ".git").exists():
        listing = ("git", "ls-files", "--cached", "--others", "--exclude-standard")
        names = run(*listing, cwd=ROOT).stdout.splitlines()
    else:  # an unpacked source distribution
        paths = (path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file())
        names = [path.as_posix() for path in paths if not is_made(path)]
    return sorted(name for name in names if (ROOT / name).is_file())


def is_made(path: Path) -> bool:
    """Tell whether a file was made here: caches, builds, virtual environments."""
    return any(
        (part.startswith(".") and part not in (".ci", ".github"))
        or part in ("__pycache__", "build", "dist", "runs")
        for part in path.parent.parts
    )


def package_files() -> list[str]:
    """Return the files that belong into the wheel, as paths from the root."""
    return [
        name
        for name in sources()
        if ("/" in name and not name.startswith(NOT_PACKAGES) and ".egg-info/" not in name)
        or ("/" not in name and name.endswith((".py", "py.typed")))
    ]


def build(source: Path, target: Path, kind: str) -> Path:
    """Build a wheel or sdist with what is installed here, and return its file."""
    options = (f"--{kind}", "--no-isolation", "--outdir", target, source)
    run(sys.executable, "-m", "build", *options)
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


def test_sdist_builds_the_same_wheel(wheel: Path, sdist: Path, tmp_path: Path) -> None:
    with tarfile.open(sdist) as archive:
        archive.extractall(tmp_path, filter="data")
    (folder,) = tmp_path.iterdir()
    assert contents(build(folder, tmp_path / "out", "wheel")) == contents(wheel)


def test_sdist_holds_what_its_own_check_needs(sdist: Path) -> None:
    """Hidden files, too: once `.ci/run` and the hooks were missing."""
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
    changes = {"PYTHONPATH": str(tmp_path)}
    printed = run_program(program, warnings="default", cwd=tmp_path, changes=changes).stdout
    assert printed.split() == [str(tmp_path / "arkanoid" / "__init__.py"), __version__]


def test_every_system_can_hold_the_files() -> None:
    """Windows refuses some letters, some names and long paths; there and on macOS A is a."""
    names = sources()
    assert len({name.lower() for name in names}) == len(names)
    assert [name for name in names if len(name) > LONGEST_PATH or RESERVED.search(name)] == []


@pytest.mark.parametrize(("file", "extras"), LOCKS.items())
def test_extras_can_be_installed_under_the_constraints(file: str, extras: tuple[str, ...]) -> None:
    """If not: make lock."""
    lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
    pins = [Requirement(line) for line in lines if not line.startswith("#")]
    pinned = {canonicalize_name(pin.name): str(pin.specifier).removeprefix("==") for pin in pins}
    groups = [PROJECT["dependencies"], *(EXTRAS[name] for name in extras)]
    for wanted in (Requirement(text) for group in groups for text in group):
        assert (
            wanted.name == "arkanoid" or pinned[canonicalize_name(wanted.name)] in wanted.specifier
        )
