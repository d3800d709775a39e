"""How the code is divided: who may import whom, and how large folders and files may become.

The tests read the sources' syntax trees. So an import inside a function counts, and so does one for
type checkers only.
"""

import ast
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from helpers.processes import run_program
from helpers.repository import ROOT, TESTS

# The packages, and the other packages that each may import.
MAY_IMPORT = {
    "physics": set[str](),
    "configs": set[str](),
    "envs": {"physics", "configs"},
    "agents": {"envs", "configs"},
}
# Within a package, a room (a subpackage, or a file at the top) imports only from rooms in its own
# line or in lines below. The package's own `__init__.py` may import all of them.
ORDER = {
    "physics": """
        scenes
        world
        drawing
        operations
        body protocols
        pairs
        shapes
        arguments
        kernels tolerances errors
    """,
    "configs": "",
    "envs": """
        browser
        registration
        tensor_vector_env
        arkanoid_env vector_env
        tensors
        play
        interface emulator masks
        batch
        observe
        draw
        game
        levels
        config state actions checks hints rules ranges atomic reading
    """,
    "agents": """
        cli
        commands
        show
        browser
        learn
        measure
        experiment pretrained
        tensor_adapter
        adapter interrupts output
    """,
}
# The same for rooms in a room.
ORDER_WITHIN = {
    "physics/world": """
        batch
        world
        questions
        memory
        queries editing
        stepping
        groups
        plans
        meetings
        lookup
        state
    """,
}
FILES = [file for package in ORDER for file in sorted((ROOT / package).rglob("*.py"))]
HEAVY = {
    *("torch", "stable_baselines3", "tensorboard", "optuna", "pygame", "matplotlib", "PIL"),
    *("pydantic", "jinja2", "markdown_it", "tomli_w", "minari", "h5py", "mlflow", "wandb"),
}
MAP = ROOT / "docs" / "architecture.md"
MOST_LINES = 400  # of a file
MOST_FILES = 16  # of code in a folder, not counting `__init__.py`
Module = tuple[str, ...]  # a dotted path from the top, such as ("arkanoid", "envs", "rules")


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@cache
def imported(file: Path) -> list[tuple[Module, str]]:
    """Return (module, name) of all that a file imports; of `import a.b`, ("a", "b") and ""."""
    found: list[tuple[Module, str]] = []
    folder = ("arkanoid", *file.relative_to(ROOT).parts[:-1])
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Import):
            found += [(tuple(alias.name.split(".")), "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = folder[: len(folder) + 1 - node.level] if node.level else ()
            module = (*base, *(node.module.split(".") if node.module else ()))
            found += [(module, alias.name) for alias in node.names]
    return found


def source(module: Module) -> Path | None:
    """Return the file of a module of ours."""
    path = ROOT.joinpath(*module[1:])
    places = (path.with_suffix(".py"), path / "__init__.py")
    return next((place for place in places if place.exists()), None)


def our_imports(file: Path) -> Iterator[tuple[Module, str, Path]]:
    """Yield (module, name, imported file) of all that is imported of ours but the version."""
    for module, name in imported(file):
        if module[0] == "arkanoid" and name != "__version__":
            target = source((*module, name)) or source(module)
            assert target is not None, f"{relative(file)} imports {'.'.join(module)}.{name}"
            yield module, name, target


def room(file: Path) -> tuple[str, str]:
    """Return the package of a file, and its room there; the room of an `__init__.py` is ""."""
    package, *rest = file.relative_to(ROOT).with_suffix("").parts
    return package, rest[0] if rest and rest[0] != "__init__" else ""


def room_within(file: Path, folder: Path) -> str:
    """Return the room of a file in a folder; that of the folder's `__init__.py` is ""."""
    name = file.relative_to(folder).with_suffix("").parts[0]
    return "" if name == "__init__" else name


def rooms_below(own: str, order: str) -> set[str]:
    """Return the rooms from which one may import; all of them for an `__init__.py`."""
    lines = [line.split() for line in order.splitlines()]
    place = next((place for place, line in enumerate(lines) if own in line), 0)
    return {own, *(name for line in lines[place:] for name in line)}


def test_every_room_has_its_place_in_the_order() -> None:
    assert {file.parent.name for file in ROOT.glob("*/__init__.py")} == set(ORDER)
    for name, order in (ORDER | ORDER_WITHIN).items():
        folder = ROOT / name
        rooms = {room_within(file, folder) for file in folder.rglob("*.py")}
        assert rooms - {""} == set(order.split())


def test_imports_go_one_way() -> None:
    wrong = []
    for file in FILES:
        package, own = room(file)
        below = rooms_below(own, ORDER[package])
        for _, _, target in our_imports(file):
            other, name = room(target)
            fits = name in below if other == package else other in MAY_IMPORT[package]
            if not fits:
                wrong.append(f"{relative(file)} imports {relative(target)}")
    assert wrong == []


@pytest.mark.parametrize("name", ["physics", "physics/world", "envs", "agents"])
def test_the_map_has_what_imports_above_what_is_imported(name: str) -> None:
    """It had not: worlds draw themselves, but stood below the row that draws."""
    _, _, section = MAP.read_text(encoding="utf-8").partition(f"\n### {name}\n")
    rows = [line.split("|")[1] for line in section.partition("\n#")[0].splitlines() if "](" in line]
    links = [re.findall(r"\(\.\./([\w./]+)\)", row) for row in rows]
    places = {ROOT / link: place for place, row in enumerate(links) for link in row}

    def place(file: Path) -> int | None:
        """Return the row of a file; None if it has none: the one at the bottom names no files."""
        return next((places[path] for path in (file, *file.parents) if path in places), None)

    assert len(places) > 5
    assert [
        f"{relative(file)} imports {relative(target)}"
        for file in FILES
        if (own := place(file)) is not None
        for _, _, target in our_imports(file)
        if (other := place(target)) is not None and other < own
    ] == []


@pytest.mark.parametrize("name", ORDER_WITHIN)
def test_imports_within_a_room_go_one_way(name: str) -> None:
    """They did not: what planned asked what met, and what met asked what planned."""
    folder = ROOT / name
    assert [
        f"{relative(file)} imports {relative(target)}"
        for file in folder.rglob("*.py")
        for _, _, target in our_imports(file)
        if target.is_relative_to(folder)
        and room_within(target, folder)
        not in rooms_below(room_within(file, folder), ORDER_WITHIN[name])
    ] == []


def test_only_public_names_of_other_rooms_are_imported() -> None:
    assert [
        f"{relative(file)} imports {name} of {'.'.join(module)}"
        for file in FILES
        for module, name, target in our_imports(file)
        if room(target) != room(file) and any(part.startswith("_") for part in (*module, name))
    ] == []


def test_no_circle_of_files() -> None:
    """Files in a circle cannot be understood, tested or moved one at a time."""
    graph = {file: {target for *_, target in our_imports(file)} for file in FILES}
    assert circles(graph) == []


def circles(graph: dict[Path, set[Path]]) -> list[set[str]]:
    """Return the strongly connected components of more than one file."""
    reached: dict[Path, set[Path]] = {}
    for start in graph:
        waiting, seen = [start], set[Path]()
        while waiting:
            new = graph.get(waiting.pop(), set()) - seen
            seen |= new
            waiting += new
        reached[start] = seen
    found = []
    for file in graph:
        circle = {other for other in reached[file] if file in reached.get(other, ())}
        if circle and file == min(circle):
            found.append({relative(other) for other in circle})
    return found


def test_a_circle_is_noticed() -> None:
    a, b, c, d = (ROOT / name for name in ("a.py", "b.py", "c.py", "d.py"))
    assert circles({a: {b}, b: {c, d}, c: {d}, d: set()}) == []
    assert circles({a: {b}, b: {c}, c: {b, d}, d: set()}) == [{"b.py", "c.py"}]


def test_imports_inside_the_package_are_relative() -> None:
    """So editors and type checkers find the code in a folder of any name."""
    assert [
        f"{relative(file)}, line {node.lineno}"
        for file in FILES
        for node in ast.walk(ast.parse(file.read_bytes()))
        if (isinstance(node, ast.ImportFrom) and not node.level and is_ours(node.module or ""))
        or (isinstance(node, ast.Import) and any(is_ours(alias.name) for alias in node.names))
    ] == []


def is_ours(module: str) -> bool:
    return module.split(".")[0] == "arkanoid"


def test_folders_are_small_and_say_what_they_are() -> None:
    for folder in sorted({file.parent for file in FILES}):
        files = [file.name for file in folder.glob("*.py") if file.name != "__init__.py"]
        assert len(files) <= MOST_FILES, relative(folder)
        docstring = ast.get_docstring(ast.parse((folder / "__init__.py").read_bytes()))
        assert docstring, relative(folder)


def test_files_are_short() -> None:
    lines = {
        relative(file): len(file.read_text(encoding="utf-8").splitlines())
        for file in [*FILES, *TESTS.rglob("*.py")]
    }
    assert {file: length for file, length in lines.items() if length > MOST_LINES} == {}


def test_engine_and_game_need_no_trainer() -> None:
    """Pygame is allowed inside the function that opens a window, torch for tensors."""
    assert [
        f"{relative(file)} imports {module[0]}"
        for file in FILES
        for module, _ in imported(file)
        if room(file)[0] != "agents" and module[0] in HEAVY - allowed_in(room(file)[1])
    ] == []


def allowed_in(name: str) -> set[str]:
    """Return which heavy packages a room of `envs` may import."""
    return {"pygame", "torch"} if name in ("tensors", "tensor_vector_env") else {"pygame"}


@pytest.mark.parametrize("statement", ["import arkanoid", "import arkanoid.envs, arkanoid.physics"])
def test_import_is_light(statement: str) -> None:
    program = f"{statement}; import sys; print(*{{name.split('.')[0] for name in sys.modules}})"
    assert set(run_program(program).stdout.split()) & HEAVY == set()


def test_registering_twice_is_silent() -> None:
    """Gymnasium warns when an id is registered again, and a test run makes that an error."""
    program = """
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
"""
    before, after = run_program(program).stdout.splitlines()
    assert before == after != "[]"


def test_pytest_does_not_import_the_root_under_another_name() -> None:
    """It did, because it took the root for a package of tests: see tests/conftest.py."""
    elsewhere = [
        name
        for name, module in list(sys.modules.items())
        if getattr(module, "__file__", None) == str(ROOT / "__init__.py") and name != "arkanoid"
    ]
    assert elsewhere == []
