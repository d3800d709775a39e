"""The restitution of single pairs: a hash table with open addresses, half of them empty."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ...kernels import kernel
from ..records import Override, Overrides

EMPTY = -1
_BITS = (1 << 30) - 1


@kernel
def _first_place(low: int, high: int, length: int) -> int:
    """Return where the search for a pair begins in a table, whose length is a power of two."""
    # Only some bits of the numbers: so nothing overflows.
    mixed = (low & _BITS) * 73856093 + (high & _BITS) * 83492791
    mixed ^= mixed >> 17
    mixed = (mixed & _BITS) * 19349663
    return (mixed ^ (mixed >> 13)) & (length - 1)


@kernel
def find_override(overrides: Overrides, low: int, high: int) -> float:
    """Return the restitution of a pair of bodies, low < high; nan if it has none of its own."""
    length = overrides.shape[0]
    place = _first_place(low, high, length)
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
    length = 1 << (2 * len(pairs)).bit_length() if pairs else 0
    table = np.zeros(length, Override)
    table["a"] = EMPTY
    for (low, high), restitution in sorted(pairs.items()):
        place = _first_place(low, high, length)
        while table[place]["a"] != EMPTY:
            place = (place + 1) % length
        table[place] = (low, high, restitution)
    return table
