"""Views into a block of bytes that are free to pass around.

Compiled code counts the references of every array that it passes on, and each count is an atomic
operation: with twenty arrays per world that costs more than the physics. A *borrowed* view counts
nothing. It must not outlive the block that it looks into; kernels return before their caller lets
go of the block.
"""

from typing import Any

import numpy as np

from .decorators import accessor
from .numba_internals import block_address, borrowed_view, is_interpreted

INDEX = np.dtype(np.int64)
BYTE = np.dtype(np.uint8)


def _numpy_view(block: Any, start: int, count: int, dtype: Any) -> Any:
    """Do the same where kernels run interpreted."""
    return block[start : start + count * dtype.itemsize].view(dtype)


def _same(block: Any) -> Any:
    """Do the same as `anchor` where kernels run interpreted."""
    return block


_view: Any = _numpy_view if is_interpreted() else borrowed_view


# `anchor(block)` stands for a block in compiled code: its address alone. An array that is passed on
# to a function that is not merged into its caller is seven numbers.
anchor: Any = _same if is_interpreted() else block_address


@accessor
def borrowed(block: Any, start: int, count: int, dtype: Any) -> Any:
    """Return ``count`` items of a dtype that begin at byte ``start`` of a block, uint8 [bytes].

    An anchor will do for the block.
    """
    return _view(block, start, count, dtype)
