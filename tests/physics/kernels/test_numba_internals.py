"""What `numba_internals` patches in Numba, or uses undocumented: one test for each part.

If a new release of Numba lacks or changes a part, its test fails and says where it is used.
"""

import inspect
import pickle
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from arkanoid.physics.kernels import numba_internals
from numba.core import event, serialize, types
from numba.core.caching import FunctionCache
from numba.core.runtime.nrt import rtsys
from numba.np import arrayobj

CHANGED = "this Numba ({}) has another `{}`: see `{}` in physics/kernels/numba_internals.py"


def double(number: Any) -> Any:
    return number + number


def expect(holds: bool, part: str, user: str) -> None:
    """Fail with the name of the part of Numba that has changed, and of what uses it."""
    assert holds, CHANGED.format(numba.__version__, part, user)


@pytest.mark.parametrize("name", ["DISABLE_JIT", *numba_internals.CODE_SETTINGS])
def test_setting_exists(name: str) -> None:
    expect(hasattr(numba.config, name), f"config.{name}", "compiler_state")


def test_code_for_one_signature_turns_its_arguments_into_numbers() -> None:
    code = numba_internals.entry_for(numba.njit(double), ("int64",))
    expect(code(np.int32(3)) == 6, "Dispatcher.compile", "entry_for")
    with pytest.raises(TypeError):
        code(None)


def test_cache_dir_decides_where_a_cache_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    cache = FunctionCache(double)
    expect(tmp_path in Path(cache.cache_path).parents, "config.CACHE_DIR", "cache_in")


@pytest.mark.parametrize(
    "option",
    [
        numba_internals.WITHOUT_RUNTIME,
        numba_internals.WITH_RUNTIME,
        numba_internals.WITHOUT_PYTHON_ENTRY,
        numba_internals.WITHOUT_C_ENTRY,
    ],
)
def test_option_is_taken(option: dict[str, bool]) -> None:
    (name,) = option
    try:
        compiled = numba.njit(double, **option)
        compiled.compile("float64(float64)")
    except (KeyError, TypeError, numba.NumbaError):
        expect(False, f"njit({name}=...)", "WITHOUT_...")
    expect(compiled.targetoptions[name] is option[name], f"njit({name}=...)", "WITHOUT_...")


def test_call_template_is_asked_for_on_the_dispatcher() -> None:
    compiled = numba.njit(double)
    asked = []
    template = getattr(compiled, "get_call_template", None)
    expect(template is not None, "Dispatcher.get_call_template", "compile_once_for_constants")

    def get_call_template(arguments: Any, keywords: Any) -> Any:
        asked.append(arguments)
        return template(arguments, keywords)

    compiled.get_call_template = get_call_template
    assert numba.njit(lambda: compiled(2))() == 4
    expect(
        len(asked) > 0 and all(isinstance(argument, types.Type) for (argument,) in asked),
        "Dispatcher.get_call_template(arguments, keywords)",
        "compile_once_for_constants",
    )


def test_unliteral_turns_a_constant_into_its_type() -> None:
    expect(
        types.unliteral(types.literal(2)) == types.intp, "unliteral", "compile_once_for_constants"
    )


def test_a_dispatcher_keeps_its_cache_as_an_attribute() -> None:
    """It asks the cache for each signature before it compiles it, and saves it afterwards."""
    calls = []

    class Recorder:
        def load_overload(self, sig: Any, target_context: Any) -> None:
            calls.append("load")

        def save_overload(self, sig: Any, data: Any) -> None:
            calls.append("save")

    compiled = numba.njit(double)
    expect(hasattr(compiled, "_cache"), "Dispatcher._cache", "cache_in")
    compiled._cache = Recorder()
    compiled.compile("float64(float64)")
    expect(calls == ["load", "save"], "Dispatcher._cache", "cache_in")


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("__init__", ["self", "py_func"]),
        ("load_overload", ["self", "sig", "target_context"]),
        ("save_overload", ["self", "sig", "data"]),
    ],
)
def test_function_cache_has_its_methods(name: str, parameters: list[str]) -> None:
    method = getattr(FunctionCache, name, None)
    expect(method is not None, f"FunctionCache.{name}", "KernelCache")
    found = list(inspect.signature(method).parameters)
    expect(found == parameters, f"FunctionCache.{name}({', '.join(found)})", "KernelCache")


def test_function_cache_keeps_its_files_through_an_attribute(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It loads and saves by a key that tells signatures apart, and names files by their stem."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    compiled = numba.njit(double)
    cache = FunctionCache(double)
    stem = getattr(getattr(cache, "_impl", None), "filename_base", None)
    expect(
        isinstance(stem, str) and "double" in stem, "FunctionCache._impl.filename_base", "CodeFiles"
    )
    saved = {}

    class Files:
        def load(self, key: Any) -> Any:
            return saved.get(repr(key))

        def save(self, key: Any, data: Any) -> None:
            saved[repr(key)] = data

    expect(hasattr(cache, "_cache_file"), "FunctionCache._cache_file", "KernelCache")
    cache._cache_file = Files()
    compiled._cache = cache
    compiled.compile("float64(float64)")
    compiled.compile("int64(int64)")
    expect(len(saved) == 2, "FunctionCache._cache_file.save(key, data)", "CodeFiles")
    expect(not list(tmp_path.rglob("*.nb[ci]")), "FunctionCache._cache_file", "KernelCache")
    again = numba.njit(double)
    again._cache = cache
    again.compile("float64(float64)")
    expect(sum(again.stats.cache_hits.values()) == 1, "FunctionCache._cache_file.load", "CodeFiles")


def test_a_cache_loads_without_knowing_how_to_compile() -> None:
    source = inspect.getsource(FunctionCache.load_overload)
    called = "target_context.refresh()" in source and "self._load_overload(" in source
    expect(called, "FunctionCache.load_overload", "KernelCache")
    expect(callable(getattr(rtsys, "initialize", None)), "rtsys.initialize", "KernelCache")


def test_dumps_writes_what_pickle_reads() -> None:
    key = (types.float64, types.Array(types.int64, 1, "C"))
    expect(pickle.loads(serialize.dumps(key)) == key, "serialize.dumps", "CodeFiles")


def test_compiling_is_an_event_with_its_dispatcher() -> None:
    compiled = numba.njit(double)
    with event.install_recorder("numba:compile") as recorder:
        compiled.compile("float64(float64)")
    ours = [each for _, each in recorder.buffer if each.data.get("dispatcher") is compiled]
    expect([each.is_start for each in ours] == [True, False], "numba:compile", "CompilerListener")
    expect(compiled.py_func is double, "Dispatcher.py_func", "CompilerListener")


def test_arrays_are_made_from_parts() -> None:
    parameters = list(inspect.signature(arrayobj.populate_array).parameters)
    expect(
        parameters[:6] == ["array", "data", "shape", "strides", "itemsize", "meminfo"],
        "populate_array",
        "borrowed_view",
    )
    expect(hasattr(arrayobj, "make_array"), "make_array", "borrowed_view")


def test_a_borrowed_view_looks_into_its_block() -> None:
    dtype = np.dtype(np.int64)

    @numba.njit
    def third(block: Any) -> Any:
        return numba_internals.borrowed_view(block, 8, 2, dtype)[1]

    block = np.arange(4)
    expect(third(block.view(np.uint8)) == 2, "array", "borrowed_view")


def test_compile_is_asked_for_on_the_dispatcher() -> None:
    compiled = numba.njit(double)
    plain = getattr(compiled, "compile", None)
    expect(plain is not None, "Dispatcher.compile", "hold_signals")
    asked = []

    def compile_whole(signature: Any) -> Any:
        asked.append(signature)
        return plain(signature)

    compiled.compile = compile_whole
    assert numba.njit(lambda: compiled(2))() == 4
    assert len(asked) > 0, "for a caller"
    del asked[:]
    compiled(2.0)
    expect(len(asked) == 1, "Dispatcher.compile(signature)", "hold_signals")


def test_arrays_at_addresses_and_on_the_stack() -> None:
    dtype = np.dtype(np.int64)

    @numba.njit
    def last(address: Any) -> Any:
        return numba_internals.addressed_array(address, (2, 2), dtype)[1, 1]

    expect(last(np.arange(4).ctypes.data) == 3, "array", "addressed_array")

    @numba.njit
    def count() -> Any:
        memory = numba_internals.stack_bytes(24)
        memory[:] = 1
        return memory.sum() * 100 + memory.size

    expect(count() == 2424, "cgutils.alloca_once", "stack_bytes")


def test_code_for_other_machines_can_be_had() -> None:
    """What `portable.afresh` takes from a dispatcher."""
    compiled = numba.njit(double)
    compiled.compile("(int64,)")
    (signature,) = compiled.signatures
    function = compiled.overloads[signature].fndesc.llvm_func_name
    code = compiled.inspect_llvm(signature)
    expect(f"@{function}(" in code.replace('"', ""), "Dispatcher.inspect_llvm", "afresh")


def test_indices_are_fixed_by_one_function_for_each_module() -> None:
    """Numba compiles a function's code into a module that has its name."""
    modules = []
    usual = arrayobj.fix_integer_index

    def fix(context: Any, builder: Any, *others: Any) -> Any:
        modules.append(builder.module.name)
        return usual(context, builder, *others)

    arrayobj.fix_integer_index = fix
    try:
        compiled = numba.njit(lambda items, index: items[index])
        assert compiled(np.arange(3), -1) == 2
    finally:
        arrayobj.fix_integer_index = usual
    (result,) = compiled.overloads.values()
    expect(modules == [result.fndesc.unique_name], "arrayobj.fix_integer_index", "plain_indices")
