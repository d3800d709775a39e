"""How records lie in memory: each field where the processor likes to read it."""

from typing import Any

import numpy as np


def record_dtype(fields: list[tuple[Any, ...]]) -> "np.dtype[Any]":
    """Return the dtype of records with these fields, aligned as in C.

    Args:
        fields: (name, type) or (name, type, shape) of each, as for `numpy.dtype`.
    """
    # In one call, np.dtype((np.record, fields), align=True), NumPy would ignore `align`.
    return np.dtype((np.record, np.dtype(fields, align=True)))
