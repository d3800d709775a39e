"""The one way kernels are compiled: by Numba, cached on disk, keyed by the source.

A *kernel* is a plain function over scalars, records and array views. It allocates nothing, touches
no Python object and, while stepping, uses only ``+ - * / sqrt``, so that it gives the same bits
compiled or interpreted (``NUMBA_DISABLE_JIT=1``) on every machine.
"""

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

from .cache import writable_folder
from .callees import (
    CalleeCompiler,
    CalleeDispatcher,
    PortableCompiler,
    RootCompiler,
    RootDispatcher,
)
from .numba_internals import (
    WITH_RUNTIME,
    WITHOUT_C_ENTRY,
    WITHOUT_PYTHON_ENTRY,
    WITHOUT_RUNTIME,
    cache_in,
    compile_once_for_constants,
    compiler_state,
    entry_for,
    hold_signals,
    is_interpreted,
)

F = TypeVar("F", bound=Callable[..., Any])

# Numba says that it is typed and hardly is, differently in every release.
_njit = cast(Any, numba).njit
# The variable that makes this process compile all kernels afresh, for `portable`.
UNCACHED = "ARKANOID_UNCACHED"
# NumPy's error model: a division by zero gives inf or nan, not an exception.
_ALWAYS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}


def kernel(function: F) -> F:
    """Compile ``function`` on its first call, or load it from the disk cache.

    IEEE arithmetic throughout (no ``fastmath``), NumPy's error model, and the GIL is released, so
    that threads run kernels in parallel. No index counts from an array's end: what is at -1 lies
    before it. Arrays are passed on without counting references; therefore a function that allocates
    memory, or returns an array, does not compile.
    """
    return _compile(function, **WITHOUT_RUNTIME)


def accessor(function: F) -> F:
    """Compile a kernel that may return an array: a view into an array that it was given."""
    return _compile(function, **WITH_RUNTIME)


def inner(function: F) -> F:
    """Make a kernel that only kernels may call; a call from Python is an error."""
    return function if is_interpreted() else _callee(function, WITHOUT_RUNTIME)


def inlined(function: F) -> F:
    """Make a kernel that becomes a part of its caller before anything is compiled.

    For a kernel with one caller. As a function of its own it would not always become a part of its
    caller's machine code, which costs up to a sixth of the speed.
    """
    if is_interpreted():
        return function
    joined: F = _njit(function, inline="always", **_ALWAYS)
    return joined


def entry_of(function: F, *types: str) -> F:
    """Return a kernel as Python calls it fastest, for numbers of these types ("int64", "float64").

    Numba looks at each argument of each call for the machine code that suits it. Here there is only
    one, so a call takes 0.1 µs less. This compiles the kernel, or loads it from the disk cache.
    """
    return function if is_interpreted() else cast(F, entry_for(function, types))


def _compile(function: F, **options: bool) -> F:
    """Return a function's dispatcher with its cache; the function itself if interpreted."""
    if is_interpreted():
        return function
    compiler = PortableCompiler if UNCACHED in os.environ else RootCompiler
    compiled: Any = _njit(
        function, pipeline_class=compiler, **_ALWAYS, **WITHOUT_C_ENTRY, **options
    )
    compiled.__class__ = RootDispatcher
    compiled.make_callee = partial(_callee, function, options)
    hold_signals(compiled)
    # The options are a part of the key: Numba's own does not hold them.
    state = f"{compiler_state()} {sorted(options.items())}"
    file = Path(function.__code__.co_filename)
    folder = None if UNCACHED in os.environ else writable_folder(file, state)
    if folder is not None:
        cache_in(folder, compiled)
    return cast(F, compiled)


def _callee(function: F, options: dict[str, bool]) -> F:
    """Return a function's dispatcher for kernels. Its code is kept with that of its callers."""
    compiled: Any = _njit(
        function,
        pipeline_class=CalleeCompiler,
        **_ALWAYS,
        **WITHOUT_C_ENTRY,
        **WITHOUT_PYTHON_ENTRY,
        **options,
    )
    compiled.__class__ = CalleeDispatcher
    compile_once_for_constants(compiled)
    hold_signals(compiled)
    return cast(F, compiled)
