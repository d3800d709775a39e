"""Everything that patches Numba, or uses a part of it that it does not document.

A new release of Numba may change any of this. ``tests/physics/kernels/test_numba_internals.py``
has one test for each part, which says what is missing and where it is used:

==================================  ================================================================
``config.DISABLE_JIT, .OPT, ...``   to know how Numba compiles
``config.CACHE_DIR``                to choose the cache folder of one function
``njit(_nrt=..., no_c..._wrapper)`` to leave out code that kernels do not need
``Dispatcher.get_call_template``    to compile once for constants and variables
``types.unliteral``                 the same
``Dispatcher.compile``              to hold back signals while it loads or compiles; it returns code
``Dispatcher._cache``               to put our cache in place of Numba's
``FunctionCache``                   our cache is a subclass
``CompileResultCacheImpl``,
``UserProvidedCacheLocator``        to read a folder that may not be written
``FunctionCache._impl``             to name the files of machine code
``FunctionCache._cache_file``       to put our files in place of Numba's
``FunctionCache._load_overload``    to load them before Numba knows how to compile
``rtsys.initialize``                the same
``serialize.dumps``                 to write them
``event`` ``numba:compile``         to notice that the compiler is at work
``intrinsic, arrayobj``             to make arrays that count no references
``cgutils.alloca_once``             to make them on the stack
``arrayobj.fix_integer_index``      to take indices as they are
==================================  ================================================================
"""

import gc
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, cast

import numba
from numba.core import event as events
from numba.core import types
from numba.core.caching import CompileResultCacheImpl, FunctionCache, UserProvidedCacheLocator
from numba.core.cgutils import alloca_once, ir  # of the llvmlite that belongs to this Numba
from numba.core.extending import intrinsic
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps
from numba.np import arrayobj
from numba.np.arrayobj import make_array, populate_array

from .code_files import CodeFiles
from .digest import PACKAGE
from .held_signals import held_signals
from .messages import say_compiling, say_unwritable

# Numba says that it is typed and hardly is, differently in every release.
_numba = cast(Any, numba)

# Settings that change the machine code; variables NUMBA_... of the same names set them.
CODE_SETTINGS = ("BOUNDSCHECK", "DEBUGINFO_DEFAULT", "OPT")

STACK_ALIGNMENT = 16  # bytes

# Without Numba's run time, which counts the references of every array that is passed on.
WITHOUT_RUNTIME = {"_nrt": False}
# With it: said explicitly, for otherwise a function inherits this from the one that calls it.
WITH_RUNTIME = {"_nrt": True}
# Without the function through which Python calls, which takes apart every argument.
WITHOUT_PYTHON_ENTRY = {"no_cpython_wrapper": True}
# Without a C function, which nobody calls.
WITHOUT_C_ENTRY = {"no_cfunc_wrapper": True}


def is_interpreted() -> bool:
    """Return whether kernels are plain Python functions (``NUMBA_DISABLE_JIT=1``)."""
    return bool(_numba.config.DISABLE_JIT)


def compiler_state() -> str:
    """Return what machine code depends on besides sources: versions and settings."""
    settings = [getattr(_numba.config, name) for name in CODE_SETTINGS]
    return f"{numba.__version__} {sys.implementation.cache_tag} {settings}"


def compile_once_for_constants(dispatcher: Any) -> None:
    """Let calls with constants share the machine code of calls with variables.

    Numba would compile a kernel that is called with the constants 2 and 3 for each of them, and
    with it all that it calls: once for each pair of shapes that a game knows, for instance.
    """
    template = dispatcher.get_call_template
    unliteral = _numba.types.unliteral

    def get_call_template(arguments: Any, keywords: Any) -> Any:
        plain = tuple(unliteral(argument) for argument in arguments)
        named = {name: unliteral(value) for name, value in dict(keywords).items()}
        return template(plain, named)

    dispatcher.get_call_template = get_call_template


def hold_signals(dispatcher: Any) -> None:
    """Let Ctrl-C wait until a kernel is loaded, or compiled.

    Numba and LLVM would stay locked for all other threads, where it comes at a bad moment. While a
    kernel is compiled, it comes as soon as one of those that it calls is finished.
    """
    plain = dispatcher.compile

    def compile_whole(signature: Any) -> Any:
        with held_signals():
            return plain(signature)

    dispatcher.compile = compile_whole


def entry_for(dispatcher: Any, types_of_arguments: tuple[str, ...]) -> Any:
    """Return a kernel's machine code for numbers of these types, compiled or loaded now.

    It turns its arguments into such numbers as `int` and `float` do, and raises what they raise.
    """
    return dispatcher.compile(tuple(getattr(types, name) for name in types_of_arguments))


def cache_in(folder: Path, dispatcher: Any) -> None:
    """Let a kernel keep its machine code in a folder."""
    # Numba reads this setting when the cache is made, and offers no argument for it.
    previous = _numba.config.CACHE_DIR
    _numba.config.CACHE_DIR = str(folder)
    try:
        dispatcher._cache = KernelCache(dispatcher.py_func)
    finally:
        _numba.config.CACHE_DIR = previous


class FolderLocator(UserProvidedCacheLocator):  # type: ignore[misc]
    """Where one function's code is kept; the folder may be one that can only be read."""

    def ensure_cache_path(self) -> None:
        """Raise OSError if there is no folder, and none can be made."""
        if not Path(self.get_cache_path()).is_dir():
            super().ensure_cache_path()


class FolderCode(CompileResultCacheImpl):  # type: ignore[misc]
    """What is kept of a function: nothing is ever kept beside its source."""

    _locator_classes = (FolderLocator,)


class KernelCache(FunctionCache):  # type: ignore[misc]
    """Numba's cache of one function, safe beside other processes and on a full or broken disk."""

    _impl_class = FolderCode

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        # Numba's own files have no checksum, and two processes that compile two signatures at the
        # same time may write both to one file.
        self._cache_file = CodeFiles(Path(self.cache_path), self._impl.filename_base, dumps)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code for one signature; None if there is none that can be read.

        Numba would first load all that it can compile, which takes longer than everything else.
        Code that is ready needs Numba's run time at most.
        """
        rtsys.initialize(target_context)
        with suppress(OSError):
            return self._load_overload(sig, target_context)
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save the machine code for one signature, or go on without."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            say_unwritable(Path(self.cache_path).parents[1], error)


class CompilerListener(events.Listener):  # type: ignore[misc]
    """Tells the user that the compiler is at work, and makes it faster.

    The compiler makes millions of small objects and little garbage. The collector of cycles, which
    looks through them again and again, would take a fifth of the time: it pauses.
    """

    def __init__(self) -> None:
        self._depth = 0  # kernels being compiled, each for the one before it
        self._was_collecting = False

    def on_start(self, event: Any) -> None:
        """Note that a function is compiled; tell the user, unless it is for another one."""
        if self._depth == 0:
            say_compiling(event.data["dispatcher"].py_func.__module__.removeprefix(f"{PACKAGE}."))
            self._was_collecting = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        """Let garbage be collected again."""
        self._depth -= 1
        if self._depth == 0 and self._was_collecting:
            gc.enable()


events.register("numba:compile", CompilerListener())


@contextmanager
def plain_indices(module: str) -> Iterator[None]:
    """Let LLVM's code of one module take every index as it is: none counts from an array's end.

    Else Numba would look at each signed index whether it does, which takes up to a sixth of the
    time. Numba compiles one function at a time, whatever threads there are.
    """
    usual = arrayobj.fix_integer_index

    def fix_integer_index(context: Any, builder: Any, kind: Any, index: Any, size: Any) -> Any:
        if builder.module.name != module:
            return usual(context, builder, kind, index, size)
        return context.cast(builder, index, kind, types.intp if kind.signed else types.uintp)

    arrayobj.fix_integer_index = fix_integer_index
    try:
        yield
    finally:
        arrayobj.fix_integer_index = usual


@intrinsic
def borrowed_view(typing_context: Any, block: Any, start: Any, count: Any, dtype: Any) -> Any:
    """Return an array that looks into a block of bytes, or its address, and owns no part of it."""
    array_type = types.Array(dtype.dtype, 1, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        view = make_array(array_type)(context, builder)
        if isinstance(block, types.Integer):
            first = builder.inttoptr(arguments[0], ir.IntType(8).as_pointer())
        else:
            first = make_array(signature.args[0])(context, builder, arguments[0]).data
        address = builder.gep(first, [arguments[1]])
        size = context.get_abi_sizeof(context.get_data_type(array_type.dtype))
        size = context.get_constant(types.intp, getattr(array_type.dtype, "size", size))
        populate_array(
            view,
            data=builder.bitcast(address, view.data.type),
            shape=[arguments[2]],
            strides=[size],
            itemsize=size,
            meminfo=None,
        )
        return view._getvalue()

    return array_type(block, types.intp, types.intp, dtype), generate


@intrinsic
def block_address(typing_context: Any, block: Any) -> Any:
    """Return the address of a block of bytes."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        data = make_array(signature.args[0])(context, builder, arguments[0]).data
        return builder.ptrtoint(data, context.get_value_type(types.intp))

    return types.intp(block), generate


@intrinsic
def addressed_array(typing_context: Any, address: Any, shape: Any, dtype: Any) -> Any:
    """Return a contiguous array that begins at an address."""
    array_type = types.Array(dtype.dtype, shape.count, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        view = make_array(array_type)(context, builder)
        item = context.get_data_type(array_type.dtype)
        size = context.get_constant(types.intp, context.get_abi_sizeof(item))
        lengths = [builder.extract_value(arguments[1], axis) for axis in range(shape.count)]
        strides = [size]
        for length in reversed(lengths[1:]):
            strides.insert(0, builder.mul(strides[0], length))
        populate_array(
            view,
            data=builder.inttoptr(arguments[0], view.data.type),
            shape=lengths,
            strides=strides,
            itemsize=size,
            meminfo=None,
        )
        return view._getvalue()

    return array_type(types.intp, shape, dtype), generate


@intrinsic(prefer_literal=True)  # type: ignore[untyped-decorator, unused-ignore]
def stack_bytes(typing_context: Any, size: Any) -> Any:
    """Return an array of bytes on the stack of the kernel that calls this."""
    array_type = types.Array(types.uint8, 1, "C")
    length = size.literal_value

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        memory = alloca_once(builder, ir.ArrayType(ir.IntType(8), length))
        memory.align = STACK_ALIGNMENT
        view = make_array(array_type)(context, builder)
        populate_array(
            view,
            data=builder.bitcast(memory, view.data.type),
            shape=[context.get_constant(types.intp, length)],
            strides=[context.get_constant(types.intp, 1)],
            itemsize=context.get_constant(types.intp, 1),
            meminfo=None,
        )
        return view._getvalue()

    return array_type(size), generate
