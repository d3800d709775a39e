"""Kernels that kernels call: they get no machine code of their own, and Numba has what that needs.

If a new release of Numba lacks or changes a part, its test fails and says what is missing.
"""

import inspect
import runpy
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from arkanoid.physics.kernels import inner, kernel
from arkanoid.physics.kernels.numba_internals import is_interpreted
from numba.core import codegen, compiler, typed_passes
from numba.core.compiler_machinery import PassManager
from numba.core.registry import CPUDispatcher

pytestmark = pytest.mark.skipif(is_interpreted(), reason="nothing is compiled")

CHANGED = f"this Numba ({numba.__version__}) has another `{{}}`: see physics/kernels/callees.py"


def doubled(number: Any) -> Any:
    return number + number


def test_only_what_python_calls_becomes_machine_code(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Each function was optimised again in each one above it: half of the first step's wait."""
    # Otherwise an earlier run has left the compiled kernel.
    monkeypatch.setenv("ARKANOID_CACHE_DIR", str(tmp_path))
    finished = []
    plain = codegen.JITCodeLibrary._finalize_specific

    def finish(library: Any) -> None:
        finished.append(library.name)
        plain(library)

    monkeypatch.setattr(codegen.JITCodeLibrary, "_finalize_specific", finish)
    callee = kernel(doubled)

    @kernel
    def caller(number: Any) -> Any:
        return callee(number) + callee(number)

    assert caller(2.5) == 10.0
    assert any("caller" in name for name in finished)
    assert not any("doubled" in name for name in finished)
    assert callee.signatures == []  # type: ignore[attr-defined]
    assert len(caller.signatures) == 1  # type: ignore[attr-defined]


def test_a_kernel_serves_python_and_kernels() -> None:
    callee = kernel(doubled)

    @kernel
    def caller(number: Any) -> Any:
        return callee(number) + callee(1)

    assert [callee(2), caller(2), callee(2.5), caller(2.5)] == [4, 6, 5.0, 7.0]


def test_compiled_functions_are_cpu_dispatchers() -> None:
    assert type(numba.njit(doubled)) is CPUDispatcher, CHANGED.format("CPUDispatcher")


@pytest.mark.parametrize("name", ["add_overload", "get_call_template", "get_overload"])
def test_a_dispatcher_has_its_methods(name: str) -> None:
    assert hasattr(CPUDispatcher, name), CHANGED.format(f"Dispatcher.{name}")


def test_a_library_is_finished_in_steps() -> None:
    for name in ("_optimize_final_module", "_finalize_final_module", "_finalize_dynamic_globals"):
        assert hasattr(codegen.JITCodeLibrary, name), CHANGED.format(f"JITCodeLibrary.{name}")


def test_lowering_may_leave_the_machine_code_out() -> None:
    source = inspect.getsource(typed_passes.NativeLowering.run_pass)
    assert "flags.no_compile" in source, CHANGED.format("Flags.no_compile")
    assert "cfunc" in compiler._LowerResult._fields, CHANGED.format("_LowerResult")


def test_lowering_is_one_of_the_passes() -> None:
    passes: list[Any] = []

    class Looking(compiler.CompilerBase):  # type: ignore[misc]
        def define_pipelines(self) -> list[PassManager]:
            pipeline = compiler.DefaultPassBuilder.define_nopython_pipeline(self.state)
            passes.extend(each for each, _ in pipeline.passes)
            return [pipeline]

    assert numba.njit(doubled, pipeline_class=Looking)(2) == 4
    assert typed_passes.NativeLowering in passes, CHANGED.format("define_nopython_pipeline")


def test_what_a_kernel_calls_is_its_own() -> None:
    """Large functions stayed apart from their only caller: a batch took 1.2 times as long."""
    callee = kernel(doubled)

    @kernel
    def caller(number: Any) -> Any:
        return callee(number) + callee(number)

    assert caller(2.5) == 10.0
    (signature,) = caller.signatures  # type: ignore[attr-defined]
    code = caller.inspect_llvm(signature)  # type: ignore[attr-defined]
    assert "linkonce_odr" not in code
    assert not any("doubled" in line for line in code.splitlines() if line.startswith("define"))


def test_others_do_not_call_what_belongs_to_a_kernel(tmp_path: Path) -> None:
    """Numba's own functions called a kernel's in the way of before LLVM changed it: a crash."""
    branches = "".join(
        f"    if kind == {i}:\n"
        f"        s += x * {i}.5 / (y + {i})\n"
        f"        if s > y:\n"
        f"            s = s / (x + {i})\n"
        for i in range(200)  # enough that LLVM leaves it apart from two callers
    )
    file = tmp_path / "large.py"
    file.write_text(f"def large(kind, unused, x, y):\n    s = 0.0\n{branches}    return s\n")
    plain = runpy.run_path(str(file))["large"]
    large = inner(plain)

    @kernel
    def owner(a: Any, b: Any) -> Any:
        return large(int(b), a, a, b) + large(int(a) + 2, b, b, a) + large(int(a), 1.0, a, b)

    @numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
    def other(a: Any, b: Any) -> Any:
        total = 0.0
        for i in range(10):
            total += large(i, a, b, a) + large(i + 1, b, a, b) + large(i * 2, b, a, b)
        return total

    assert owner(2.0, 5.0) == plain(5, 2.0, 2.0, 5.0) + plain(4, 5.0, 5.0, 2.0) + plain(2, 1, 2, 5)
    expected = 0.0
    for i in range(10):
        expected += plain(i, 2.0, 5.0, 2.0) + plain(i + 1, 5.0, 2.0, 5.0) + plain(2 * i, 5, 2, 5)
    assert other(2.0, 5.0) == expected


def item_at(items: Any, index: Any) -> Any:
    return items[index]


def test_no_index_counts_from_the_end() -> None:
    """Numba looked at each index whether it did: billiards took up to 1.18 times as long."""
    items = np.arange(5.0)[1:]  # so there is something before it
    callee = kernel(item_at)

    @kernel
    def caller(items: Any, index: Any) -> Any:
        return callee(items, index) + items[index]

    assert [caller(items, 2), caller(items, -1)] == [6.0, 0.0]
    assert numba.njit(item_at)(items, -1) == 4.0, "other functions are as they were"
