"""How records lie in memory: each field where the processor likes to read it."""

from typing import Any

import numpy as np
import numpy.typing as npt

LINE = 64  # bytes that a processor reads together


def record_dtype(fields: list[tuple[Any, ...]]) -> "np.dtype[Any]":
    """Return the dtype of records with these fields, aligned as in C.

    Args:
        fields: (name, type) or (name, type, shape) of each, as for `numpy.dtype`.
    """
    # In one call, np.dtype((np.record, fields), align=True), NumPy would ignore `align`.
    return np.dtype((np.record, np.dtype(fields, align=True)))


def in_lines(size: int) -> int:
    """Return a number of bytes, rounded up to whole lines of a processor's cache."""
    return -(-size // LINE) * LINE


def aligned_bytes(rows: int, size: int) -> npt.NDArray[np.uint8]:
    """Return zeros, uint8 [rows, size], that begin where a line of a processor's cache does."""
    block = np.zeros(rows * size + LINE, np.uint8)
    start = -block.ctypes.data % LINE
    return block[start : start + rows * size].reshape(rows, size)
