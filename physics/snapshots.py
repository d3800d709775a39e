"""A state as bytes that can be kept, and is refused where it does not belong."""

import hashlib
import struct
import zlib

import numpy as np

from .world_setup import Bytes

_MAGIC = b"arkanoid-world"
VERSION = 1
_HEADER = struct.Struct("<14sH16sIQ")  # magic, version, setup's digest, checksum, length


def pack_states(states: Bytes, memory: Bytes) -> bytes:
    """Return states, uint8 [worlds, bytes], and the digest of their setup, as bytes."""
    content = states.tobytes()
    head = _HEADER.pack(_MAGIC, VERSION, _digest(memory), zlib.crc32(content), len(content))
    return head + content


def unpack_states(snapshot: bytes, states: Bytes, memory: Bytes) -> None:
    """Write a snapshot into the states that it was taken of.

    Raises:
        TypeError: if it is not bytes.
        ValueError: if it is corrupt, of another version, or of another world or batch; the states
            are as they were then.
    """
    if not isinstance(snapshot, bytes | bytearray | memoryview):
        raise TypeError(f"a snapshot must be bytes, but is a {type(snapshot).__name__}")
    if len(snapshot) < _HEADER.size or snapshot[: len(_MAGIC)] != _MAGIC:
        raise ValueError("this is no snapshot of a world")
    _, version, digest, checksum, length = _HEADER.unpack_from(snapshot)
    content = snapshot[_HEADER.size :]
    if version != VERSION:
        raise ValueError(
            f"the snapshot is of version {version}, and this is version {VERSION}: restore it with "
            "the release that took it"
        )
    if len(content) != length or zlib.crc32(content) != checksum:
        raise ValueError("the snapshot is corrupt: it is cut short, or bits have changed")
    if digest != _digest(memory) or length != states.nbytes:
        raise ValueError(
            "the snapshot is of another world: of other bodies, static ones elsewhere, other masks "
            "or restitutions, or another number of worlds"
        )
    states[:] = np.frombuffer(content, np.uint8).reshape(states.shape)


def _digest(memory: Bytes) -> bytes:
    return hashlib.sha256(memory.tobytes()).digest()[:16]
