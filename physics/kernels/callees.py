"""How kernels are compiled for the kernels that call them: no machine code before the last caller.

Numba makes machine code of every function, and optimises it again as a part of each function above
it: in a deep tree of calls that is half of the compiler's work. Here only what Python calls becomes
machine code. All that it calls, directly or not, is joined to it first, as LLVM's code, which is
then optimised once, as a whole. So a kernel has two dispatchers: Python calls a `RootDispatcher`,
and kernels call the `CalleeDispatcher` behind it. Each compiles only if somebody calls it.

What this uses of Numba, mostly undocumented, has its tests in
``tests/physics/kernels/test_callees.py``.
"""

# Numba's own methods have no types, of which pyright makes up some.
# pyright: reportIncompatibleMethodOverride=false
from collections.abc import Callable
from functools import cached_property
from typing import Any, cast

from llvmlite.binding import Linkage
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import NativeLowering

from .numba_internals import plain_indices

OWN = ".own"  # ends the name of a function that belongs to one kernel
REFERENCE_COUNTING = "NRT_"  # begins the names of Numba's functions for it


class _CalleeLibrary(JITCodeLibrary):  # type: ignore[misc]
    """A function that waits for its callers: it is not optimised, and has no machine code."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class _RootLibrary(JITCodeLibrary):  # type: ignore[misc]
    """A function that Python calls, with all that it calls: nobody else calls that.

    As LLVM knows it then, it makes large functions with one caller a part of this caller, too, and
    leaves none over. A batch of worlds steps 1.2 times as fast.
    """

    def _optimize_final_module(self) -> None:
        for each in self._final_module.functions:
            # Numba finds what counts references by its name, and leaves out most of its calls.
            if each.name.startswith(REFERENCE_COUNTING):
                continue
            if not each.is_declaration and each.linkage == Linkage.linkonce_odr:
                each.linkage = Linkage.internal
                # LLVM may now change how it is called. Its loader does not tell internal functions
                # from others: under the old name, others would call it in the old way.
                each.name += OWN
        super()._optimize_final_module()


class _Callee:
    """Stands for a function without machine code, where Numba wants the one that Python calls."""


@register_pass(mutates_CFG=True, analysis_only=False)
class _KernelLowering(NativeLowering):  # type: ignore[misc]
    """Turns a typed function into LLVM's code, and takes every index as it is."""

    _name = "arkanoid_kernel_lowering"

    def run_pass(self, state: Any) -> bool:
        """Write the function's library."""
        with plain_indices(state.func_id.unique_name):
            return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class _CalleeLowering(_KernelLowering):
    """Turns a typed function into LLVM's code, for other functions."""

    _name = "arkanoid_callee_lowering"

    def run_pass(self, state: Any) -> bool:
        """Write the function's library, and tell Numba where its callers find it."""
        name = state.func_id.func_qualname
        state.library = _CalleeLibrary(state.targetctx.codegen(), name)
        state.flags.no_compile = True
        super().run_pass(state)
        state.library._ensure_finalized()
        callee = _Callee()
        state.targetctx.insert_user_function(callee, state["cr"].fndesc, [state.library])
        state["cr"] = state["cr"]._replace(cfunc=callee)
        return True


@register_pass(mutates_CFG=True, analysis_only=False)
class _RootLowering(_KernelLowering):
    """Turns a typed function into machine code."""

    _name = "arkanoid_root_lowering"

    def run_pass(self, state: Any) -> bool:
        """Write the function's library, which can be kept on disk."""
        state.library = _RootLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return super().run_pass(state)


class _Compiler(CompilerBase):  # type: ignore[misc]
    """Numba's compiler with another last step."""

    lowering: type[NativeLowering]

    def define_pipelines(self) -> list[Any]:
        """Return Numba's list of passes, one of them ours."""
        passes = PassManager(self.lowering._name)
        for each, title in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
            passes.add_pass(self.lowering if each is NativeLowering else each, title)
        passes.finalize()
        return [passes]


class CalleeCompiler(_Compiler):
    """The compiler of kernels for kernels."""

    lowering = _CalleeLowering


class RootCompiler(_Compiler):
    """The compiler of kernels for Python."""

    lowering = _RootLowering


class PortableCompiler(_Compiler):
    """The compiler of entries for other machines, which share what they call."""

    lowering = _KernelLowering


class CalleeDispatcher(CPUDispatcher):  # type: ignore[misc]
    """A kernel for kernels: Python cannot call it."""

    def add_overload(self, result: Any) -> None:
        """Note what was compiled for one signature."""
        self.overloads[tuple(result.signature.args)] = result

    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        """Refuse; without this, the process would crash."""
        raise TypeError(f"{self.__name__} can be called by kernels only; decorate it with @kernel")


class RootDispatcher(CPUDispatcher):  # type: ignore[misc]
    """A kernel for Python. Kernels that call it get its `callee` instead."""

    make_callee: Callable[[], CalleeDispatcher]

    @cached_property
    def callee(self) -> CalleeDispatcher:
        """What other kernels call; most kernels are loaded ready, and need none."""
        return self.make_callee()

    def get_call_template(self, arguments: Any, keywords: Any) -> Any:
        """Return how a kernel calls it."""
        return cast(Any, self).callee.get_call_template(arguments, keywords)

    def get_overload(self, signature: Any) -> Any:
        """Return what stands for its code there."""
        return cast(Any, self).callee.get_overload(signature)
