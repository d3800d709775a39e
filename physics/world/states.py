"""The states of worlds, stepped and kept as bytes: what a single world and a batch share."""

import hashlib
import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import not_negative, whole
from ..kernels.sealed import seal, unseal
from .records import END, Hit
from .setup import ByteArray, Setup
from .stepping import INVALID, step_worlds

FIRST_ROOM = 64  # hits; it grows as needed

VERSION = 1  # of the format of snapshots
_MARK = b"ARKWORLD"
_DIGEST_SIZE = 16  # bytes


class Stepper:
    """Steps the worlds of a matrix of states, and keeps the memory that this takes.

    Args:
        setup: what the worlds share.
        states: uint8 [worlds, bytes], changed in place.
    """

    def __init__(self, setup: Setup, states: ByteArray) -> None:
        self.workspace = setup.workspace.copy()
        self._states = states
        self._has_sensors = len(setup.sensing) > 0
        self._hits: npt.NDArray[Any] = np.zeros(0, Hit)
        self._grow(FIRST_ROOM + 2 * len(setup.sensing))

    def step(self, dt: float, steps: int) -> npt.NDArray[Any]:
        """Step all worlds; return their hits, sorted by world and time.

        Raises:
            ValueError: if a position or velocity is not finite, or has become so.
        """
        count = step_worlds(self._states, self.workspace, self._buffer, 0, dt, steps)
        while count < 0:
            if count == INVALID:
                raise ValueError(
                    "a position or velocity is not finite: it was set so, or has become too large "
                    "for a number"
                )
            self._grow(2 * len(self._hits))
            count = step_worlds(self._states, self.workspace, self._buffer, -1 - count, dt, steps)
        if count == 0:
            return self._hits[:0]
        hits = self._hits[:count].copy()
        if self._has_sensors and (hits["kind"] == END).any():
            # That a body left a sensor is known later than it happened.
            hits = hits[np.lexsort((hits["time"], hits["world"]))]
        return hits

    def _grow(self, room: int) -> None:
        """Make room for so many hits."""
        hits = np.zeros(room, Hit)
        hits[: len(self._hits)] = self._hits
        self._hits, self._buffer = hits, hits.view(np.uint8)


def checked_step(dt: Any, steps: Any) -> tuple[float, int]:
    """Check the length of a step and the number of steps, and return them."""
    if type(dt) is float and 0.0 <= dt < math.inf and type(steps) is int and steps > 0:
        return dt, steps
    return not_negative("dt", dt), whole("steps", steps, at_least=1)


def pack_states(states: ByteArray, setup: Setup) -> bytes:
    """Return states, uint8 [worlds, bytes], and the digest of their setup, as a snapshot."""
    return seal(_MARK, VERSION, _digest(setup) + states.tobytes())


def unpack_states(snapshot: bytes, states: ByteArray, setup: Setup) -> None:
    """Write a snapshot into the states that it was taken of.

    Raises:
        TypeError: if it is not bytes.
        ValueError: if it is corrupt, of another version, or of another world or batch. The states
            do not change then.
    """
    content = unseal("snapshot of worlds", _MARK, VERSION, snapshot)
    digest, kept = content[:_DIGEST_SIZE], content[_DIGEST_SIZE:]
    if digest != _digest(setup) or len(kept) != states.nbytes:
        raise ValueError(
            "the snapshot is of another world: with other bodies, static ones elsewhere, other "
            "masks or restitutions, or another number of worlds"
        )
    states[:] = np.frombuffer(kept, np.uint8).reshape(states.shape)


def _digest(setup: Setup) -> bytes:
    return hashlib.sha256(setup.workspace.tobytes()).digest()[:_DIGEST_SIZE]
