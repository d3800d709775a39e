"""The one way kernels are compiled: Numba, cached on disk, keyed by the source.

A *kernel* is a plain function over scalars, records and array views. It allocates nothing, touches
no Python object and, while stepping, uses only ``+ - * / sqrt``, so that it gives the same bits
compiled or interpreted (``NUMBA_DISABLE_JIT=1``) on every machine.

Numba's own cache notices a change of the file that holds a function, but not of a file that holds
a function it *calls*, and then runs stale machine code. Here the cache folder of a kernel is named
after a digest of its own file and of every file of this package that it imports, directly or not:
to be stale, a kernel would have to call something that it cannot name. A constant that a kernel
reads must therefore be written in source, not computed from the contents of some other file.

The folders lie in ``kernels`` under the user's cache folder, or under ``ARKANOID_CACHE_DIR``. Where
neither can be written, kernels are compiled anew in every process, and one line says so.
"""

import ast
import gc
import hashlib
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from pickle import UnpicklingError
from typing import Any, TypeVar, cast
from uuid import uuid4

import numba
import platformdirs
from numba.core import event as events
from numba.core.caching import FunctionCache
from numba.core.registry import CPUDispatcher

F = TypeVar("F", bound=Callable[..., Any])

CACHE_VARIABLE = "ARKANOID_CACHE_DIR"
# Long enough for a project that rests for a holiday, short enough to be no burden (a folder holds
# a few MB and every edit of a kernel begins new ones).
PRUNE_AFTER = 30 * 86_400.0  # seconds

_BEGAN = time.time()
# Numba's settings that change the machine code, each set by a variable NUMBA_...
_SETTINGS = ("BOUNDSCHECK", "DEBUGINFO_DEFAULT", "OPT")
_PACKAGE = __name__.rpartition(".physics.")[0]
_PACKAGE_FOLDER = Path(__file__).resolve().parents[2]
_FOLDER_NAME = re.compile("[0-9a-f]{16}")
# Numba says that it is typed and hardly is, differently in every release.
_numba = cast(Any, numba)


def is_interpreted() -> bool:
    """Return whether kernels are plain Python functions (``NUMBA_DISABLE_JIT=1``)."""
    return bool(_numba.config.DISABLE_JIT)


def kernel(function: F) -> F:
    """Compile ``function`` on its first call, or load it from the disk cache.

    IEEE arithmetic throughout (no ``fastmath``), NumPy's error model (a division by zero gives inf
    or nan, not an exception), and the GIL is released, so that threads run kernels in parallel.
    Numba's run time is left out, for it would count the references of every array that is passed
    on; so what allocates memory, or returns an array, does not compile.
    """
    return _compile(function, _nrt=False)


def accessor(function: F) -> F:
    """Compile a kernel that may return an array: a view into what it was given."""
    return _compile(function, _nrt=True)


def inner(function: F) -> F:
    """Make a kernel that only kernels may call: compiled without the way in from Python.

    That way, through which every argument is taken apart, is a good part of a small kernel's code.
    """
    compiled = _compile(function, _nrt=False, no_cpython_wrapper=True)
    if not is_interpreted():
        cast(Any, compiled).__class__ = _Inner
    return compiled


class _Inner(CPUDispatcher):  # type: ignore[misc]
    """A kernel that has no way in from Python."""

    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        """Refuse; without this, the process would crash."""
        raise TypeError(f"{self.__name__} can be called by kernels only; decorate it with @kernel")


def _compile(function: F, **options: bool) -> F:
    """Return the dispatcher of a function, with its cache (or the function, if not compiled)."""
    if is_interpreted():
        return function
    # No C function either, which nobody calls.
    compiled: F = _numba.njit(
        function, nogil=True, error_model="numpy", no_cfunc_wrapper=True, **options
    )
    _compile_once_for_literals(compiled)
    folder = cache_folder(Path(function.__code__.co_filename))
    if folder is not None and _prepared(folder):
        _cache_in(folder, compiled)
    return compiled


def inlined(function: F) -> F:
    """Make a kernel that becomes a part of the one that calls it, before anything is compiled.

    For what is called in one place only: a function of its own is compiled again as a part of each
    one above it, which in a deep tree of calls takes longer than all the rest.
    """
    if is_interpreted():
        return function
    joined: F = _numba.njit(function, nogil=True, error_model="numpy", inline="always")
    return joined


def _compile_once_for_literals(compiled: Any) -> None:
    """Let calls with constants share the machine code of calls with variables.

    A kernel that is called with the constants 2 and 3 would be compiled for each of them, and so
    would all that it calls: one for each pair of shapes that a game knows, for instance.
    """
    template = compiled.get_call_template

    def get_call_template(arguments: Any, keywords: Any) -> Any:
        plain = tuple(numba.types.unliteral(argument) for argument in arguments)
        return template(
            plain, {name: numba.types.unliteral(value) for name, value in dict(keywords).items()}
        )

    compiled.get_call_template = get_call_template


def cache_folder(file: Path) -> Path | None:
    """Return the folder for the machine code of the kernels of one source file.

    None if there is no such file (the function was typed at a prompt or lies in an archive), if
    sources were edited since this process began and need not be what it has imported, or if there
    is no folder for caches.
    """
    if not file.is_file() or _last_edit(file.resolve()) > _BEGAN:
        return None
    root = _cache_root()
    return root and root / "kernels" / _digest(file.resolve())


def _cache_root() -> Path | None:
    """Return the folder that is named, or else the user's; None if the user has no home."""
    try:
        root = os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_dir("arkanoid", False)
        return Path(root).expanduser().absolute()
    except RuntimeError as error:  # an unknown user without HOME, as containers have them
        _say_uncached(f"There is no cache folder ({error})")
        return None


def _cache_in(folder: Path, compiled: Any) -> None:
    """Let a dispatcher keep its machine code in ``folder``."""
    # Numba takes the folder of a function's cache from this setting when the cache is made.
    previous = _numba.config.CACHE_DIR
    _numba.config.CACHE_DIR = str(folder)
    try:
        compiled._cache = _Cache(compiled.py_func)
    finally:
        _numba.config.CACHE_DIR = previous


class _Cache(FunctionCache):  # type: ignore[misc]
    """Numba's cache of one function, safe beside other processes and on a full or broken disk."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        # Numba numbers the data files of a function's signatures 1, 2, ... Two processes that
        # compile different signatures at once would both write number 1, and the index could send
        # one signature to the other's machine code. With a name for each the worst is to compile
        # twice.
        stem = self._impl.filename_base
        self._cache_file._data_name = lambda number: f"{stem}.{uuid4().hex[:16]}.nbc"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code for one signature; None if there is none that can be read."""
        try:
            return super().load_overload(sig, target_context)
        except (EOFError, UnpicklingError):  # a file was cut short, by a power failure, say
            with suppress(OSError):
                self.flush()
            return None
        except OSError:
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save the machine code for one signature, or go on without."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _say_unwritable(Path(self.cache_path).parents[1], error)


@cache
def _prepared(folder: Path) -> bool:
    """Make the folder, note that it is in use, and tell whether it can be written.

    Numba itself would fall back to ``__pycache__``, and with it to stale machine code.
    """
    try:
        if not folder.is_dir():
            folder.mkdir(parents=True, exist_ok=True)
            _prune(folder.parent)
        os.utime(folder)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        _say_unwritable(folder.parent, error)
        return False
    return True


def _prune(kernels: Path) -> None:
    """Delete the folders of earlier sources that no process has used for ``PRUNE_AFTER``."""
    for folder in kernels.iterdir():
        # Only what can be ours: the root may be any folder that the user named.
        if _FOLDER_NAME.fullmatch(folder.name) and _age(folder) > PRUNE_AFTER:
            shutil.rmtree(folder, ignore_errors=True)


def _age(folder: Path) -> float:
    """Return the seconds since a process last used the folder, 0 if it is gone already."""
    try:
        return time.time() - folder.stat().st_mtime
    except OSError:
        return 0.0


@cache
def _last_edit(file: Path) -> float:
    """Return when the file or one that it imports was edited, in seconds since the epoch."""
    return max(source.stat().st_mtime for source in _import_closure(file))


@cache
def _digest(file: Path) -> str:
    """Return the digest of all that the machine code of a file's kernels is made from."""
    settings = [getattr(_numba.config, name) for name in _SETTINGS]
    compiler = f"{numba.__version__} {sys.implementation.cache_tag} {settings}"
    digest = hashlib.sha256(compiler.encode())
    for source in sorted(_import_closure(file)):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


@cache
def _import_closure(file: Path) -> frozenset[Path]:
    """Return the file and all files of the package that it imports, directly or not."""
    found = {file}
    frontier = [file]
    while frontier:
        new = _imported_files(frontier.pop()) - found
        found |= new
        frontier += new
    return frozenset(found)


@cache
def _imported_files(file: Path) -> frozenset[Path]:
    """Return the files of the package that one file names in its import statements."""
    found = set()
    for node in ast.walk(ast.parse(file.read_bytes())):
        for folder, dotted in _imported_names(node, file):
            path = folder.joinpath(*dotted.split("."))
            found |= {path.with_name(f"{path.name}.py"), path / "__init__.py"}
    return frozenset(path for path in found if path.is_file())


def _imported_names(node: ast.AST, file: Path) -> Iterator[tuple[Path, str]]:
    """Yield what an import statement may name: a folder, and dotted names below it.

    Inside the package every import is relative; kernels outside of it name the package.
    """
    if isinstance(node, ast.ImportFrom) and node.level:
        folder = file.parents[node.level - 1]
        dotted = node.module or ""
    elif isinstance(node, ast.ImportFrom) and node.module:
        top, _, dotted = node.module.partition(".")
        if top != _PACKAGE:
            return
        folder = _PACKAGE_FOLDER
    elif isinstance(node, ast.Import):
        for alias in node.names:
            top, _, dotted = alias.name.partition(".")
            if top == _PACKAGE:
                yield _PACKAGE_FOLDER, dotted
        return
    else:
        return
    yield folder, dotted
    # `from . import x` and `from .package import x` may name modules, too.
    for alias in node.names:
        yield folder, f"{dotted}.{alias.name}".strip(".")


@cache
def _say_once(line: str) -> None:
    print(f"arkanoid: {line}", file=sys.stderr, flush=True)


def _say_unwritable(folder: Path, error: OSError) -> None:
    _say_uncached(f"{folder} cannot be written ({error.strerror})")


def _say_uncached(why: str) -> None:
    _say_once(
        f"{why}, so every process compiles the kernels anew. Set {CACHE_VARIABLE} to a folder "
        "that can be written."
    )


class _Attendant(events.Listener):  # type: ignore[misc]
    """Says on stderr, once a process, that the wait is for the compiler, and shortens it.

    The compiler makes millions of small objects and little garbage: the collector of cycles, which
    looks through them again and again, would take a fifth of the time.
    """

    def __init__(self) -> None:
        self._depth = 0  # kernels that are compiled for kernels that are compiled
        self._collected = False  # garbage was, before

    def on_start(self, event: Any) -> None:
        """Tell of the first kernel of this package that is compiled."""
        if event.data["dispatcher"].py_func.__module__.startswith(f"{_PACKAGE}."):
            _say_once("compiling kernels for this machine (once; up to 20 s) ...")
        if self._depth == 0:
            self._collected = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        """Let garbage be collected again."""
        self._depth -= 1
        if self._depth == 0 and self._collected:
            gc.enable()


events.register("numba:compile", _Attendant())
