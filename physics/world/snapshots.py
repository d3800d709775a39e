"""A state as bytes that can be kept, and is refused where it does not belong."""

import hashlib

import numpy as np

from ..kernels.sealed import seal, unseal
from .setup import Bytes

_MARK = b"ARKWORLD"
VERSION = 1
_DIGEST_SIZE = 16  # bytes


def pack_states(states: Bytes, memory: Bytes) -> bytes:
    """Return states, uint8 [worlds, bytes], and the digest of their setup, as bytes."""
    return seal(_MARK, VERSION, _digest(memory) + states.tobytes())


def unpack_states(snapshot: bytes, states: Bytes, memory: Bytes) -> None:
    """Write a snapshot into the states that it was taken of.

    Raises:
        TypeError: if it is not bytes.
        ValueError: if it is corrupt, of another version, or of another world or batch; the states
            are as they were then.
    """
    content = unseal("snapshot of worlds", _MARK, VERSION, snapshot)
    digest, kept = content[:_DIGEST_SIZE], content[_DIGEST_SIZE:]
    if digest != _digest(memory) or len(kept) != states.nbytes:
        raise ValueError(
            "the snapshot is of another world: of other bodies, static ones elsewhere, other masks "
            "or restitutions, or another number of worlds"
        )
    states[:] = np.frombuffer(kept, np.uint8).reshape(states.shape)


def _digest(memory: Bytes) -> bytes:
    return hashlib.sha256(memory.tobytes()).digest()[:_DIGEST_SIZE]
