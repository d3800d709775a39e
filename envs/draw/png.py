"""PNG files with nothing but the standard library: a picture for whoever has no imaging package."""

import struct
import zlib
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_DEPTH = 8  # bits a channel
_COLOUR_TYPES = {1: 0, 3: 2}  # by channels: grey; red, green and blue
_SMALLEST = 9  # zlib's level


def write_png(path: str | PathLike[str], picture: NDArray[np.uint8]) -> None:
    """Write a picture, uint8 [height, width, 1 or 3], into a file; an older one is replaced.

    Raises:
        OSError: the file can't be written.
    """
    Path(path).write_bytes(png_bytes(picture))


def png_bytes(picture: NDArray[np.uint8]) -> bytes:
    """Return what a PNG file of a picture, uint8 [height, width, 1 or 3], holds."""
    height, width, channels = picture.shape
    head = struct.pack(">IIBBBBB", width, height, _DEPTH, _COLOUR_TYPES[channels], 0, 0, 0)
    # Each line begins with the number of its filter: 0, none. Pictures of the game are flat areas,
    # which zlib alone packs well.
    lines = np.zeros((height, 1 + width * channels), np.uint8)
    lines[:, 1:] = picture.reshape(height, -1)
    data = zlib.compress(lines.tobytes(), _SMALLEST)
    return _SIGNATURE + _chunk(b"IHDR", head) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, content: bytes) -> bytes:
    """Return a chunk: length, kind, content, and the checksum of the last two."""
    checksum = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)
