"""The restitution of single pairs: a hash table with open addresses, half of them empty.

The keys are handles, so a pair is forgotten with its bodies: nobody asks for it any more.
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ...kernels import kernel
from ..state.records import Override, Overrides

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
def _place_of(overrides: Overrides, low: int, high: int) -> int:
    """Return the place of a pair, or the empty one where it belongs; -1 if there is none."""
    length = overrides.shape[0]
    place = _first_place(low, high, length)
    for _ in range(length):
        override = overrides[place]
        if override.a == EMPTY or (override.a == low and override.b == high):
            return place
        place = place + 1 if place + 1 < length else 0
    return -1


@kernel
def find_override(overrides: Overrides, low: int, high: int) -> float:
    """Return the restitution of a pair of handles, low < high; nan if it has none of its own."""
    place = _place_of(overrides, low, high)
    if place < 0 or overrides[place].a == EMPTY:
        return math.nan
    return float(overrides[place].restitution)


@kernel
def put_override(overrides: Overrides, low: int, high: int, restitution: float) -> int:
    """Write the restitution of a pair; return how many more places are used, or -1 for no room.

    Args:
        overrides: the table.
        low, high: the handles, in order.
        restitution: nan to take it back.
    """
    place = _place_of(overrides, low, high)
    if place < 0:
        return -1
    override = overrides[place]
    used = int(override.a == EMPTY)
    override.a, override.b, override.restitution = low, high, restitution
    return used


def override_table(pairs: Iterable[Any]) -> npt.NDArray[Any]:
    """Return the table of some pairs, each (low, high, restitution), with room for as many more."""
    rows = [(int(low), int(high), float(e)) for low, high, e in pairs]
    table = np.zeros(4 << len(rows).bit_length(), Override)
    table["a"] = EMPTY
    for low, high, restitution in rows:
        put_override(table, low, high, restitution)
    return table
