"""Memory that is asked for before it is needed."""

from typing import Any, cast

from numba.core import types
from numba.core.cgutils import ir  # of the llvmlite that belongs to this Numba
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

from .numba_internals import is_interpreted

_LINE = 64  # bytes of a processor's cache that come together
_BYTE = ir.IntType(8)
_FLAG = ir.IntType(32)
# What the intrinsic of LLVM takes: 0 for reading, 3 to keep it in all caches, 1 for data.
_HOW = (ir.Constant(_FLAG, 0), ir.Constant(_FLAG, 3), ir.Constant(_FLAG, 1))


def prefetch(array: Any, index: int, first: int, size: int) -> None:
    """Ask for a part of an element of an array's first axis, and go on without waiting for it.

    It changes nothing but the time that reading or writing that part takes. Large arrays lie in
    memory that a processor waits hundreds of cycles for; asked in time, it computes meanwhile.

    Args:
        array: of any dtype, records included.
        index: of the element; it may lie beyond the array's end.
        first: of the part's bytes in the element, a constant.
        size: of the part in bytes, a constant.
    """


@intrinsic(prefer_literal=True)  # type: ignore[untyped-decorator, unused-ignore]
def _prefetch(typing_context: Any, array: Any, index: Any, first: Any, size: Any) -> Any:
    """Compile `prefetch`."""
    start, stop = first.literal_value, first.literal_value + size.literal_value
    # One byte of each line, wherever in a line the part begins.
    part = [*range(start, stop - 1, _LINE), stop - 1]

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        values = make_array(signature.args[0])(context, builder, arguments[0])
        pointer = _BYTE.as_pointer()
        stride = builder.extract_value(values.strides, 0)
        element = builder.gep(
            builder.bitcast(values.data, pointer), [builder.mul(arguments[1], stride)]
        )
        function = builder.module.declare_intrinsic(
            "llvm.prefetch",
            [pointer],
            ir.FunctionType(ir.VoidType(), [pointer, _FLAG, _FLAG, _FLAG]),
        )
        for offset in part:
            line = builder.gep(element, [ir.Constant(arguments[1].type, offset)])
            builder.call(function, [line, *_HOW])
        return context.get_dummy_value()

    return types.void(array, types.intp, first, size), generate


if not is_interpreted():
    prefetch = cast(Any, _prefetch)
