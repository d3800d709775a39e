"""Arrays that begin at an address, for entries."""

import ctypes
import math
from typing import Any

import numpy as np

from ..decorators import accessor
from ..numba_internals import addressed_array, is_interpreted


def _numpy_array(address: int, shape: tuple[int, ...], dtype: Any) -> Any:
    """Do the same where kernels run interpreted."""
    size = math.prod(shape) * dtype.itemsize
    memory = (ctypes.c_char * size).from_address(address)
    return np.frombuffer(memory, dtype).reshape(shape)


_array: Any = _numpy_array if is_interpreted() else addressed_array


@accessor
def array_at(address: int, shape: Any, dtype: Any) -> Any:
    """Return the contiguous array of a shape (a tuple) and a dtype that begins at an address.

    Nothing checks that there is one. It must outlive all use of the array.
    """
    return _array(address, shape, dtype)
