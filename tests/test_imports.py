"""Which package may know which, and how little ``import arkanoid`` costs.

Read from the sources' syntax trees: what is imported inside a function counts, too.
"""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
# Each package, and the packages of ours that it may import.
MAY_IMPORT = {
    "physics": set[str](),
    "configs": set[str](),
    "envs": {"physics", "configs"},
    "agents": {"envs", "configs"},
}
FILES = [file for package in MAY_IMPORT for file in sorted((ROOT / package).rglob("*.py"))]
HEAVY = {"torch", "stable_baselines3", "pygame", "matplotlib", "tensorboard", "imageio", "rich"}


def named(file: Path) -> Iterator[str]:
    """Yield the modules that a file's imports name, as dotted paths from the top."""
    within = ["arkanoid", *file.relative_to(ROOT).parts[:-1]]
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = within[: len(within) + 1 - node.level] if node.level else []
            module = ".".join(base + ([node.module] if node.module else []))
            yield from (f"{module}.{alias.name}" for alias in node.names)


def test_every_package_has_its_rule() -> None:
    packages = {file.parent.name for file in ROOT.glob("*/__init__.py")}
    assert packages == set(MAY_IMPORT)


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(ROOT)))
def test_imports_go_one_way(file: Path) -> None:
    own = file.relative_to(ROOT).parts[0]
    ours = {name.split(".")[1] for name in named(file) if name.startswith("arkanoid.")}
    assert ours - {own, "version", "__version__"} <= MAY_IMPORT[own]


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(ROOT)))
def test_imports_inside_the_package_are_relative(file: Path) -> None:
    """So that editors and type checkers find the code in a folder of any name."""
    absolute = [
        node.lineno
        for node in ast.walk(ast.parse(file.read_bytes()))
        if (
            (isinstance(node, ast.ImportFrom) and not node.level and node.module)
            and node.module.split(".")[0] == "arkanoid"
        )
        or (
            isinstance(node, ast.Import)
            and any(alias.name.split(".")[0] == "arkanoid" for alias in node.names)
        )
    ]
    assert absolute == []


@pytest.mark.parametrize(
    "file",
    [file for file in FILES if file.relative_to(ROOT).parts[0] != "agents"],
    ids=lambda file: str(file.relative_to(ROOT)),
)
def test_engine_and_game_need_no_trainer(file: Path) -> None:
    """Pygame alone is allowed, inside the function that opens a window (see below)."""
    assert {name.split(".")[0] for name in named(file)} & (HEAVY - {"pygame"}) == set()


@pytest.mark.parametrize("statement", ["import arkanoid", "import arkanoid.envs, arkanoid.physics"])
def test_import_is_light(statement: str) -> None:
    loaded = python(
        f"{statement}; import sys; print(*{{name.split('.')[0] for name in sys.modules}})"
    )
    assert set(loaded.split()) & HEAVY == set()


def test_registering_twice_is_silent() -> None:
    """Gymnasium warns when an id is registered again, and a test run makes that an error."""
    before, after = python("""
import importlib, importlib.util, sys
import arkanoid
from gymnasium.envs.registration import registry
ours = lambda: sorted(str(spec) for name, spec in registry.items() if "Arkanoid" in name)
print(ours())
importlib.reload(arkanoid)
spec = importlib.util.spec_from_file_location(
    "house", arkanoid.__file__, submodule_search_locations=list(arkanoid.__path__))
sys.modules["house"] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(sys.modules["house"])
print(ours())
""").splitlines()
    assert before == after != "[]"


def test_pytest_does_not_import_the_root_under_another_name() -> None:
    """It did, taking the root for a package of tests: see tests/conftest.py."""
    elsewhere = [
        name
        for name, module in list(sys.modules.items())
        if getattr(module, "__file__", None) == str(ROOT / "__init__.py") and name != "arkanoid"
    ]
    assert elsewhere == []


def python(program: str) -> str:
    """Run a program in a new interpreter, warnings being errors, and return what it prints."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", program], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
