"""Forged data: contents that nobody's play made, under a header whose checksum is right.

The programs beside the tests (`forge_*.py`) make them, and are run under `NUMBA_BOUNDSCHECK=1`.
"""

import struct
import zlib
from typing import Any

import numpy as np

_HEADER = struct.Struct("<8sHIQ")
_ODD = (0, 1, -1, 2, 3, 7, 100, 255, 256, 2**15, 2**31 - 1, -(2**31), 2**53, 2**62, 2**63 - 1)
_ODD_FLOATS = (0.0, -0.0, 1.0, -1.0, np.nan, np.inf, -np.inf, 1e300, -1e300, 1e-300, 1e9, 0.5)


def opened(sealed: bytes) -> bytearray:
    """Return the content of what `seal` returned."""
    return bytearray(sealed[_HEADER.size :])


def sealed_again(sealed: bytes, content: bytes) -> bytes:
    """Return another content under the header of what `seal` returned, with the right checksum."""
    mark, version, _, _ = _HEADER.unpack_from(sealed)
    return _HEADER.pack(mark, version, zlib.crc32(content), len(content)) + bytes(content)


def forge(rng: np.random.Generator, records: Any, ranges: Any = None) -> str:
    """Write a wrong number into one field of a random record; return the field's name.

    Args:
        rng: chooses what and how.
        records: a writable structured array [n].
        ranges: of fields, (least, largest); then some numbers are within them.
    """
    record = records[rng.integers(len(records))]
    name = str(rng.choice(records.dtype.names))
    field = records.dtype[name]
    row = record[name]
    if field.shape:
        where = tuple(int(rng.integers(size)) for size in field.shape)
        row[where] = _number(rng, row[where], field.base, ranges and ranges[name])
        if rng.random() < 0.2:
            row[...] = row[where]
    else:
        record[name] = _number(rng, row, field.base, ranges and ranges[name])
    return name


def _number(rng: np.random.Generator, old: Any, dtype: "np.dtype[Any]", bounds: Any) -> Any:
    """Return another number for a field."""
    way = rng.integers(5)
    if bounds is not None and way < 3:
        low, high = bounds
        if dtype.kind == "f":
            new: Any = low + (high - low) * float(rng.random())
        else:
            new = int(low) + int(float(rng.random()) * min(int(high) - int(low) + 1, 1 << 40))
    elif way == 3:
        new = rng.choice(_ODD_FLOATS) if dtype.kind == "f" else int(rng.choice(_ODD))
    elif way == 4 and dtype.kind != "f":
        new = int(old) + int(rng.integers(-3, 4))
    elif dtype.kind == "f":
        new = float(old) + float(rng.normal()) * float(rng.choice([1e-12, 1e-6, 0.1, 3.0, 100.0]))
    else:
        new = int(rng.integers(-(2**63), 2**63 - 1))
    if dtype.kind == "f":
        return dtype.type(new)
    if dtype.kind == "b":
        return bool(new)
    # What does not fit is cut off, as in a file's bytes.
    return np.frombuffer((new % (1 << 64)).to_bytes(8, "little")[: dtype.itemsize], dtype)[0]
