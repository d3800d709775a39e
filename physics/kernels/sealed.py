"""Bytes that can be kept: a header says what they are, their version and their checksum.

The header is eight bytes that say what it is, then as unsigned little-endian numbers the format's
version (2 bytes), the CRC-32 of the content (4) and its length (8). The content follows.
"""

import os
import struct
import zlib
from pathlib import Path
from uuid import uuid4

_HEADER = struct.Struct("<8sHIQ")


def seal(mark: bytes, version: int, content: bytes) -> bytes:
    """Return a content with its header; mark: eight bytes that say what it is."""
    return _HEADER.pack(mark, version, zlib.crc32(content), len(content)) + content


def write_sealed(path: Path, mark: bytes, version: int, content: bytes) -> None:
    """Write what `seal` returns to a file. Other processes see the whole file or none.

    Raises:
        OSError: it cannot be written.
    """
    unfinished = path.with_name(f"{path.name}.{uuid4().hex[:16]}")
    try:
        unfinished.write_bytes(seal(mark, version, content))
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def unseal(what: str, mark: bytes, version: int, sealed: bytes) -> memoryview:
    """Return the content of what `seal` returned.

    Args:
        what: the name of what is expected, for errors.
        mark: as for `seal`.
        version: as for `seal`; bytes of another version are refused.
        sealed: bytes that `seal` returned.

    Raises:
        TypeError: it is not bytes.
        ValueError: it is something else, of another version, cut short, or bits have changed.
    """
    if not isinstance(sealed, bytes | bytearray | memoryview):
        raise TypeError(f"a {what} is bytes; got {type(sealed).__name__}")
    view = memoryview(sealed)
    if len(view) < _HEADER.size or view[: len(mark)] != mark:
        raise ValueError(f"this is no {what}: it does not begin like one")
    _, found, checksum, length = _HEADER.unpack_from(view)
    if found != version:
        raise ValueError(
            f"the {what} is of format {found}, and this release reads format {version}: use the "
            "release that made it"
        )
    content = view[_HEADER.size :]
    if len(content) != length:
        raise ValueError(f"the {what} is corrupt: {len(content)} bytes of {length} are there")
    if zlib.crc32(content) != checksum:
        raise ValueError(f"the {what} is corrupt: some of its bytes have changed")
    return content
