"""PNG files, written with the standard library only.

Written by hand because twenty lines let anyone save a picture without an imaging library.
"""

import struct
import zlib
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..atomic import write_atomically

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_DEPTH = 8  # bits per channel
_COLOUR_TYPES = {1: 0, 3: 2}  # by number of channels: grey; red, green and blue
_BEST_COMPRESSION = 9  # zlib's level


def write_png(path: str | PathLike[str], picture: NDArray[np.uint8]) -> None:
    """Write a picture, uint8 [height, width, 1 or 3], to a file, and replace an older file.

    Raises:
        OSError: the file can't be written.
    """
    write_atomically(Path(path), png_bytes(picture))


def png_bytes(picture: NDArray[np.uint8]) -> bytes:
    """Return the bytes of a PNG file for a picture, uint8 [height, width, 1 or 3]."""
    height, width, channels = picture.shape
    head = struct.pack(">IIBBBBB", width, height, _DEPTH, _COLOUR_TYPES[channels], 0, 0, 0)
    # Each line begins with the number of its filter: 0, none. The game's pictures consist of flat
    # areas, which zlib packs well without filters.
    lines = np.zeros((height, 1 + width * channels), np.uint8)
    lines[:, 1:] = picture.reshape(height, -1)
    data = zlib.compress(lines.tobytes(), _BEST_COMPRESSION)
    return _SIGNATURE + _chunk(b"IHDR", head) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, content: bytes) -> bytes:
    """Return a chunk: length, kind, content, and the checksum of the last two."""
    checksum = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)
