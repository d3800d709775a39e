"""The restitution of single pairs: a hash table with open addresses, half of them empty."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ...kernels import kernel
from ..records import Override, Overrides

EMPTY = -1


@kernel
def find_override(overrides: Overrides, low: int, high: int) -> float:
    """Return the restitution of a pair of bodies, low < high; nan if it has none of its own."""
    length = overrides.shape[0]
    # Without an overflow: an index is below 2 ** 31.
    place = (low * 73856093 + high * 19349663) % max(length, 1)
    for _ in range(length):
        override = overrides[place]
        if override.a == EMPTY:
            break
        if override.a == low and override.b == high:
            return float(override.restitution)
        place = place + 1 if place + 1 < length else 0
    return math.nan


def override_table(pairs: Mapping[tuple[int, int], float]) -> npt.NDArray[Any]:
    """Return the table of some pairs (a, b), a < b."""
    length = 2 * len(pairs) + 1 if pairs else 0
    table = np.zeros(length, Override)
    table["a"] = EMPTY
    for (low, high), restitution in sorted(pairs.items()):
        place = (low * 73856093 + high * 19349663) % length
        while table[place]["a"] != EMPTY:
            place = (place + 1) % length
        table[place] = (low, high, restitution)
    return table
