"""Arrays that begin at an address, or lie on the stack, for entries."""

import ctypes
import math
from typing import Any

import numpy as np

from ..decorators import accessor
from ..numba_internals import addressed_array, is_interpreted, stack_bytes


def _numpy_array(address: int, shape: tuple[int, ...], dtype: Any) -> Any:
    """Do the same where kernels run interpreted."""
    size = math.prod(shape) * dtype.itemsize
    # What comes out of a record is a number of NumPy's.
    memory: Any = (ctypes.c_char * int(size)).from_address(int(address))
    return np.frombuffer(memory, dtype).reshape(shape)


_array: Any = _numpy_array if is_interpreted() else addressed_array


@accessor
def array_at(address: int, shape: Any, dtype: Any) -> Any:
    """Return the contiguous array of a shape (a tuple) and a dtype that begins at an address.

    Nothing checks that there is one. It must outlive all use of the array.
    """
    return _array(address, shape, dtype)


def _numpy_bytes(size: int) -> Any:
    """Do the same as `on_stack` where kernels run interpreted."""
    return np.zeros(size, np.uint8)


# `on_stack(size)` returns an array of so many bytes, a constant, that begin with any values. They
# end with the kernel that asks for them, and must not be returned. A graphics card keeps what lies
# on the stacks of neighbouring threads side by side, and so reads and writes it fastest.
on_stack: Any = _numpy_bytes if is_interpreted() else stack_bytes
