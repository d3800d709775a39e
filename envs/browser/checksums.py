"""Checksums as replays and sealed files have them: CRC-32, as zlib computes it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import inlined, kernel
from ..batch.recorder import CHECKED, Checked
from ..state import World

_ALL = 0xFFFFFFFF
_POLYNOMIAL = 0xEDB88320


def _table() -> NDArray[np.int64]:
    """Return the checksum of each byte."""
    table = np.zeros(256, np.int64)
    for byte in range(256):
        word = byte
        for _ in range(8):
            word = word >> 1 ^ (_POLYNOMIAL if word & 1 else 0)
        table[byte] = word
    return table


def _parts() -> NDArray[np.int64]:
    """Return of each field of `CHECKED`: its place, bytes a number, and bytes in a checksum."""
    rows = []
    for name in CHECKED:
        field, place = World.fields[name][:2]  # type: ignore[index]
        wide = Checked[name].base.itemsize
        size = field.base.itemsize
        rows.append((place, field.itemsize // size, size, wide))
    return np.array(rows, np.int64)


_TABLE = _table()
_PARTS = _parts()


@inlined
def _with_byte(checksum: int, byte: int) -> int:
    """Return an unfinished checksum with one byte more."""
    return int(_TABLE[(checksum ^ byte) & 255]) ^ (checksum >> 8)


@kernel
def checksum_of(memory: Any, checksum: int) -> int:
    """Return the checksum of bytes, uint8 [n], that follow those of a checksum (0: of none)."""
    checksum ^= _ALL
    for index in range(memory.shape[0]):
        checksum = _with_byte(checksum, memory[index])
    return checksum ^ _ALL


@kernel
def checksum_of_world(memory: Any, checksum: int) -> int:
    """Return the checksum of a world as a recorder notes it.

    Args:
        memory: the world, uint8 [bytes]; checksum: of its earlier states.
    """
    checksum ^= _ALL
    for part in range(_PARTS.shape[0]):
        size, wide = _PARTS[part, 2], _PARTS[part, 3]
        for number in range(_PARTS[part, 1]):
            first = _PARTS[part, 0] + number * size
            for byte in range(size):
                checksum = _with_byte(checksum, memory[first + byte])
            # Integers are recorded with 64 bits.
            sign = 255 if wide > size and memory[first + size - 1] >= 128 else 0
            for _ in range(size, wide):
                checksum = _with_byte(checksum, sign)
    return checksum ^ _ALL
