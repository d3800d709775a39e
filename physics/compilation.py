"""The one way kernels are compiled: Numba, cached on disk, keyed by the source.

A *kernel* is a plain function over scalars, records and array views. It allocates nothing, touches
no Python object and, while stepping, uses only ``+ - * / sqrt``, so that it gives the same bits
compiled or interpreted (``NUMBA_DISABLE_JIT=1``) on every machine.

Numba's own cache notices a change of the file that holds a function, but not of a file that holds
a function it *calls*, and then runs stale machine code. Here the cache folder of a kernel is named
after a digest of its own module and of every module of this package that it imports, directly or
not: to be stale, a kernel would have to call something that it cannot name.
"""

import ast
import hashlib
import os
import sys
from collections.abc import Callable
from functools import cache
from importlib.util import resolve_name
from pathlib import Path
from typing import Any, TypeVar

import numba
import platformdirs
from numba.core import event

F = TypeVar("F", bound=Callable[..., Any])

CACHE_VARIABLE = "ARKANOID_CACHE_DIR"
_ANNOUNCEMENT = "arkanoid: compiling kernels for this machine (once; up to 20 s) ..."


def kernel(function: F) -> F:
    """Compile ``function`` on its first call, or load it from the disk cache.

    IEEE arithmetic throughout (no ``fastmath``), NumPy's error model (a division by zero gives inf
    or nan, not an exception), and the GIL is released, so that threads run kernels in parallel.
    """
    # Numba takes the folder of a function's cache from this setting, when it is decorated.
    previous = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(cache_folder(function.__module__))
    try:
        compiled: F = numba.njit(function, cache=True, nogil=True, error_model="numpy")
    finally:
        numba.config.CACHE_DIR = previous
    return compiled


def cache_folder(module_name: str) -> Path:
    """Return the folder for the machine code of one module's kernels."""
    root = os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_dir("arkanoid", False)
    digest = hashlib.sha256(f"{numba.__version__} {sys.implementation.cache_tag}".encode())
    for name in sorted(_import_closure(module_name)):
        digest.update(_read(name))
    return Path(root) / digest.hexdigest()[:16]


def _import_closure(module_name: str) -> set[str]:
    """Return the module and all modules of its package that it imports, directly or not."""
    found = {module_name}
    frontier = [module_name]
    while frontier:
        for name in _relative_imports(frontier.pop()):
            if name not in found and _source_file(name) is not None:
                found.add(name)
                frontier.append(name)
    return found


@cache
def _relative_imports(module_name: str) -> tuple[str, ...]:
    """Return the modules named in ``from .x import y`` statements (inside the package all are)."""
    file = _source_file(module_name)
    assert file is not None
    is_package = file.name == "__init__.py"
    package = module_name if is_package else module_name.rpartition(".")[0]
    names = []
    for node in ast.walk(ast.parse(_read(module_name))):
        if isinstance(node, ast.ImportFrom) and node.level:
            target = resolve_name("." * node.level + (node.module or ""), package)
            names.append(target)
            # `from . import x` and `from .package import x` may name modules, too.
            names += [f"{target}.{alias.name}" for alias in node.names]
    return tuple(names)


@cache
def _read(module_name: str) -> bytes:
    file = _source_file(module_name)
    return b"" if file is None else file.read_bytes()


@cache
def _source_file(module_name: str) -> Path | None:
    """Return the file of a module of the package, found beside those already imported."""
    module = sys.modules.get(module_name)
    if module is not None and getattr(module, "__file__", None):
        return Path(str(module.__file__))
    parent, _, leaf = module_name.rpartition(".")
    parent_module = sys.modules.get(parent)
    for folder in getattr(parent_module, "__path__", ()):
        for candidate in (Path(folder) / f"{leaf}.py", Path(folder) / leaf / "__init__.py"):
            if candidate.is_file():
                return candidate
    return None


class _Announcer(event.Listener):  # type: ignore[misc]
    """Says on stderr, once a process, that the wait is for the compiler."""

    def __init__(self) -> None:
        self.silent = False

    def on_start(self, compiling: Any) -> None:
        package = __name__.rpartition(".physics.")[0]
        function = compiling.data["dispatcher"].py_func
        if not self.silent and function.__module__.startswith(package):
            self.silent = True
            print(_ANNOUNCEMENT, file=sys.stderr, flush=True)

    def on_end(self, compiling: Any) -> None:
        pass


event.register("numba:compile", _Announcer())
