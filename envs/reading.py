"""Files of unknown origin: what is named may be endless, too large, or no file at all."""

import errno
import os
import stat
from pathlib import Path

_CHUNK = 1 << 20  # bytes


def read_limited(path: Path, limit: int) -> bytes:
    """Return a file's content.

    Raises:
        OSError: it cannot be read, or is a folder, a pipe, a device or the like, which could be
            endless or keep its reader waiting.
        ValueError: it has more than ``limit`` bytes.
    """
    content = bytearray()
    with open(path, "rb", opener=_open_at_once) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(errno.EINVAL, "not a regular file", str(path))
        while len(content) <= limit and (chunk := file.read(_CHUNK)):
            content += chunk
    if len(content) > limit:
        raise ValueError(f"it is larger than {limit:,} bytes")
    return bytes(content)


def _open_at_once(path: str, flags: int) -> int:
    """Open a file; of a pipe, do not wait for somebody who writes into it."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))
