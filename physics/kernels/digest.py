"""The digest of all that a kernel's machine code is made from: its file, and what that imports.

Numba's own cache notices a change in the file that holds a function, but not in a file that holds
a function it *calls*, and then runs stale machine code. Here the digest covers the file and every
file of this package that it imports, directly or not: to be stale, a kernel would have to call
something that it cannot name. A constant that a kernel reads must therefore be written in source,
not computed from the contents of some other file.

A process runs the sources that it imported, which may have been edited since. It reads each file
once, while it imports the kernels, and afterwards only compares the file's time and size with those
it had then. So no clock matters: a file may be dated in the future.
"""

import ast
import hashlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

PACKAGE = __name__.rpartition(".physics.")[0]
_PACKAGE_FOLDER = Path(__file__).resolve().parents[2]


# These decide where machine code is kept and what the user is told, not what the machine code is.
_WITHOUT_INFLUENCE = frozenset(
    Path(__file__).resolve().with_name(name)
    for name in ("cache.py", "code_files.py", "messages.py", "sealed.py")
)


@cache
def digest(file: Path, compiler: str) -> str:
    """Return 16 hexadecimal digits for a source file, what it imports, and the compiler's state."""
    result = hashlib.sha256(compiler.encode())
    for source in sorted(_import_closure(file)):
        result.update(_read(source).digest)
    return result.hexdigest()[:16]


def is_edited(file: Path) -> bool:
    """Return whether the file, or one that it imports, changed after this process read it."""
    return any(_stamp(source) != _read(source).stamp for source in _import_closure(file))


@cache
def _import_closure(file: Path) -> frozenset[Path]:
    """Return the file and all files of the package that it imports, directly or not."""
    found = {file}
    frontier = [file]
    while frontier:
        new = _read(frontier.pop()).imports - found
        found |= new
        frontier += new
    return frozenset(found)


class _Source(NamedTuple):
    """A source file when this process first read it."""

    stamp: tuple[int, int] | None
    digest: bytes
    imports: frozenset[Path]


@cache
def _read(file: Path) -> _Source:
    stamp = _stamp(file)
    content = file.read_bytes()
    return _Source(stamp, hashlib.sha256(content).digest(), _imported_files(file, content))


def _stamp(file: Path) -> tuple[int, int] | None:
    """Return a file's time in nanoseconds and its size in bytes, None if it is gone."""
    try:
        status = file.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def _imported_files(file: Path, content: bytes) -> frozenset[Path]:
    """Return the files of the package that one file names in its import statements."""
    found = set()
    for node in _statements(ast.parse(content).body):
        for folder, dotted in _imported_names(node, file):
            path = folder.joinpath(*dotted.split("."))
            found |= {path.with_name(f"{path.name}.py"), path / "__init__.py"}
    return frozenset(path for path in found - _WITHOUT_INFLUENCE if path.is_file())


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield all statements; `ast.walk` would look into all expressions, too."""
    for statement in body:
        yield statement
        for part in (
            statement,
            *getattr(statement, "handlers", ()),
            *getattr(statement, "cases", ()),
        ):
            for name in ("body", "orelse", "finalbody"):
                yield from _statements(getattr(part, name, []))


def _imported_names(node: ast.AST, file: Path) -> Iterator[tuple[Path, str]]:
    """Yield what an import statement may name: a folder, and dotted names below it.

    Inside the package every import is relative; kernels outside of it name the package.
    """
    if isinstance(node, ast.ImportFrom) and node.level:
        folder = file.parents[node.level - 1]
        dotted = node.module or ""
    elif isinstance(node, ast.ImportFrom) and node.module:
        top, _, dotted = node.module.partition(".")
        if top != PACKAGE:
            return
        folder = _PACKAGE_FOLDER
    elif isinstance(node, ast.Import):
        for alias in node.names:
            top, _, dotted = alias.name.partition(".")
            if top == PACKAGE:
                yield _PACKAGE_FOLDER, dotted
        return
    else:
        return
    yield folder, dotted
    # `from . import x` and `from .package import x` may name modules, too.
    for alias in node.names:
        yield folder, f"{dotted}.{alias.name}".strip(".")
