"""Views into a block of bytes that are free to pass around.

Compiled code counts the references of every array that it passes on, and each count is an atomic
operation: with a score of arrays a world that costs more than the physics. A *borrowed* view counts
nothing. It must not outlive the block that it looks into; kernels return before their caller lets
go of the block.
"""

from typing import Any

import numpy as np
from numba.core import types
from numba.core.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array

from .decorators import accessor, is_interpreted


def _numpy_view(memory: Any, start: int, count: int, dtype: Any) -> Any:
    """Do the same where kernels run interpreted."""
    return memory[start : start + count * dtype.itemsize].view(dtype)


@intrinsic
def _borrowed_view(typing_context: Any, memory: Any, start: Any, count: Any, dtype: Any) -> Any:
    """Return an array that looks into a block and owns no part of it."""
    array_type = types.Array(dtype.dtype, 1, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        block = make_array(signature.args[0])(context, builder, arguments[0])
        view = make_array(array_type)(context, builder)
        place = builder.gep(block.data, [arguments[1]])
        size = context.get_abi_sizeof(context.get_data_type(array_type.dtype))
        size = context.get_constant(types.intp, getattr(array_type.dtype, "size", size))
        populate_array(
            view,
            data=builder.bitcast(place, view.data.type),
            shape=[arguments[2]],
            strides=[size],
            itemsize=size,
            meminfo=None,
        )
        return view._getvalue()

    return array_type(memory, types.intp, types.intp, dtype), generate


_view: Any = _numpy_view if is_interpreted() else _borrowed_view


@accessor
def borrowed(memory: Any, start: int, count: int, dtype: Any) -> Any:
    """Return ``count`` items of a dtype that begin at byte ``start`` of a block, uint8 [bytes]."""
    return _view(memory, start, count, dtype)


INDICES = np.dtype(np.int64)
BYTES = np.dtype(np.uint8)
