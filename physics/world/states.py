"""The states of worlds, stepped and kept as bytes: what a single world and a batch share."""

import hashlib
import itertools
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import not_negative, whole
from ..kernels.layouts import record_dtype
from ..kernels.sealed import seal, unseal
from .lookup.inside import inside_blocks, pairs_inside
from .records import END, Clock, Header, Hit, Motion, Plan
from .setup import ByteArray, Setup
from .stepping import INVALID, call_of, step_worlds
from .view import CLOCK_SIZE

FIRST_ROOM = 64  # hits; it grows as needed

VERSION = 2  # of the format of snapshots
_MARK = b"ARKWORLD"
_DIGEST_SIZE = 16  # bytes

# What is kept of a moving body. All else follows from it, and is made again.
Kept = record_dtype(
    [
        ("shown", Motion),
        ("after_step", Motion),
        ("motion", Motion),
        ("at", np.float64),
        ("at_low", np.float64),
        ("speed", np.float64),
        ("fresh", np.int64),
    ]
)
_OF_PLANS = ("at", "at_low", "speed", "fresh")  # the same in `Plan`
_MANY = 1 << 60  # of what is counted


NO_HITS: npt.NDArray[Any] = np.zeros(0, Hit)


class Stepper:
    """Steps the worlds of a matrix of states, and keeps the memory that this takes.

    Args:
        setup: what the worlds share.
        states: uint8 [worlds, bytes], changed in place.
        insides: uint8 [worlds, bytes], the same for what is inside sensors.

    Attributes:
        workspace: uint8 [bytes], a copy of the setup's.
    """

    def __init__(self, setup: Setup, states: ByteArray, insides: ByteArray) -> None:
        self.workspace = setup.workspace.copy()
        self._states = states
        self._has_sensors = len(setup.sensing) > 0
        self._hits: npt.NDArray[Any]
        self._use(insides, np.zeros(FIRST_ROOM, Hit))

    @property
    def insides(self) -> ByteArray:
        """What is inside sensors, uint8 [worlds, bytes], see `lookup.inside`."""
        return self._insides

    @insides.setter
    def insides(self, blocks: ByteArray) -> None:
        self._use(blocks, self._hits)

    def step(self, dt: float, steps: int) -> npt.NDArray[Any]:
        """Step all worlds; return their hits, sorted by world and time.

        Raises:
            ValueError: if a position or velocity is not finite, or has become so.
        """
        count = step_worlds(self._call, 0, dt, steps)
        while count < 0:
            if count == INVALID:
                raise ValueError(
                    "a position or velocity is not finite: it was set so, or has become too large "
                    "for a number; or the time has"
                )
            self._make_room()
            count = step_worlds(self._call, -1 - count, dt, steps)
        if count == 0:
            return NO_HITS  # a slice would take a tenth of the time of a short step
        hits = self._hits[:count].copy()
        if self._has_sensors and (hits["kind"] == END).any():
            # That a body left a sensor is known later than it happened.
            hits = hits[np.lexsort((hits["time"], hits["world"]))]
        return hits

    def _make_room(self) -> None:
        """Make room for more hits, and for more that is inside sensors."""
        hits = np.zeros(2 * len(self._hits), Hit)
        hits[: len(self._hits)] = self._hits
        insides = self._insides
        if self._has_sensors:
            header = self.workspace[: Header.itemsize].view(Header)[0]
            insides = inside_blocks(pairs_inside(insides), int(header.bodies), True)
        self._use(insides, hits)

    def _use(self, insides: ByteArray, hits: npt.NDArray[Any]) -> None:
        """Step with other arrays from now on."""
        insides = np.ascontiguousarray(insides)
        call = call_of(self._states, insides, self.workspace, hits)
        # Together, so that Ctrl-C cannot leave addresses of arrays that are no longer there.
        self._insides, self._hits, self._call = insides, hits, call


def checked_step(dt: Any, steps: Any) -> tuple[float, int]:
    """Check the length of a step and the number of steps, and return them."""
    return not_negative("dt", dt), whole("steps", steps, at_least=1)


def pack_states(states: ByteArray, insides: Iterable[ByteArray], setup: Setup) -> bytes:
    """Return worlds as a snapshot: what they hold, and the digest of their setup.

    Args:
        states: uint8 [worlds, bytes].
        insides: uint8 [worlds, bytes], perhaps in parts.
        setup: what the worlds share.
    """
    kept = np.zeros((len(states), len(setup.moving)), Kept)
    plans = setup.records(states, "plans", Plan)
    kept["shown"] = states[:, CLOCK_SIZE : setup.header.shown_after_step_at].view(Motion)
    kept["after_step"] = setup.records(states, "shown_after_step", Motion)
    kept["motion"] = setup.records(states, "motions", Motion)
    for name in _OF_PLANS:
        kept[name] = plans[name]
    clocks = states[:, :CLOCK_SIZE].copy().view(Clock)
    clocks["planned"] = 0
    pairs = [own for part in insides for own in pairs_inside(part)]
    counts = np.array([len(own) for own in pairs], np.int64)
    parts = (clocks, kept, counts, *pairs)
    return seal(_MARK, VERSION, _digest(setup) + b"".join(part.tobytes() for part in parts))


def unpack_states(snapshot: bytes, states: ByteArray, setup: Setup) -> ByteArray:
    """Write a snapshot into the states that it was taken of.

    Returns:
        the blocks of what is inside sensors, uint8 [worlds, bytes].

    Raises:
        TypeError: if it is not bytes.
        ValueError: if it is corrupt, of another version, or of another world or batch, or if no
            step leaves a world like that. The states do not change then.
    """
    content = unseal("snapshot of worlds", _MARK, VERSION, snapshot)
    worlds, movers, bodies = len(states), len(setup.moving), len(setup.traits)
    sizes = [_DIGEST_SIZE, CLOCK_SIZE * worlds, Kept.itemsize * worlds * movers, 8 * worlds]
    cuts = np.cumsum(sizes).tolist()
    digest, clock_bytes, kept_bytes, count_bytes, pair_bytes = (
        content[start:end] for start, end in itertools.pairwise([0, *cuts, len(content)])
    )
    if digest != _digest(setup) or len(content) < cuts[-1]:
        raise ValueError(
            "the snapshot is of another world: with other bodies, static ones elsewhere, other "
            "masks or restitutions, or another number of worlds"
        )
    clocks = np.frombuffer(clock_bytes, Clock)
    kept = np.frombuffer(kept_bytes, Kept).reshape(worlds, movers)
    counts = np.frombuffer(count_bytes, np.int64)
    if (counts < 0).any() or (counts > len(pair_bytes)).any():
        raise _corrupt("numbers of bodies inside sensors")
    if counts.sum() * 16 != len(pair_bytes):
        raise ValueError("the snapshot is of another number of worlds, or corrupt")
    pairs = np.frombuffer(pair_bytes, np.int64).reshape(-1, 2)
    own_pairs = np.split(pairs, np.cumsum(counts)[:-1])
    _check_clocks(clocks)
    _check_motions(kept, clocks)
    for own in own_pairs:
        _check_pairs(own, setup)
    insides = inside_blocks(own_pairs, bodies, len(setup.sensing) > 0)
    states[:, :CLOCK_SIZE] = clocks.view(np.uint8).reshape(worlds, CLOCK_SIZE)
    states[:, CLOCK_SIZE : setup.header.shown_after_step_at].view(Motion)[:] = kept["shown"]
    setup.records(states, "shown_after_step", Motion)[:] = kept["after_step"]
    setup.records(states, "motions", Motion)[:] = kept["motion"]
    plans = setup.records(states, "plans", Plan)
    for name in ("hits", "rests", "instant", "nowhere", "stage"):
        plans[name] = 0
    for name in _OF_PLANS:
        plans[name] = kept[name]
    return insides


def _digest(setup: Setup) -> bytes:
    return hashlib.sha256(setup.workspace.tobytes()).digest()[:_DIGEST_SIZE]


def _corrupt(part: str) -> ValueError:
    return ValueError(f"the snapshot is corrupt: no world can have such {part}")


def _check_clocks(clocks: npt.NDArray[Any]) -> None:
    """Raise a ValueError unless clocks are sums of two numbers, and their counts are possible."""
    whole_time = np.isfinite(clocks["time"]) & (
        clocks["time"] + clocks["time_low"] == clocks["time"]
    )
    counts = (clocks["capped"] >= 0) & (clocks["capped"] < _MANY)
    flags = (clocks["planned"] == 0) & ((clocks["fresh"] == 0) | (clocks["fresh"] == 1))
    if not (whole_time & counts & flags).all():
        raise _corrupt("a clock")


def _check_motions(kept: npt.NDArray[Any], clocks: npt.NDArray[Any]) -> None:
    """Raise a ValueError unless motions are finite, and began before now."""
    for part in ("shown", "after_step", "motion"):
        for name in ("x", "y", "vx", "vy"):
            if not np.isfinite(kept[part][name]).all():
                raise _corrupt("motions")
    if not ((kept["speed"] >= 0.0) & np.isfinite(kept["speed"])).all():
        raise _corrupt("speeds")
    at, low, now, now_low = kept["at"], kept["at_low"], clocks["time"], clocks["time_low"]
    past = (at < now[:, None]) | ((at == now[:, None]) & (low <= now_low[:, None]))
    if not (past & (at + low == at) & ((kept["fresh"] == 0) | (kept["fresh"] == 1))).all():
        raise _corrupt("courses")


def _check_pairs(pairs: npt.NDArray[np.int64], setup: Setup) -> None:
    """Raise a ValueError unless bodies are inside sensors, in order, and each once."""
    bodies = len(setup.traits)
    if not len(pairs):
        return
    if ((pairs < 0) | (pairs >= bodies)).any():
        raise _corrupt("bodies inside sensors")
    keys = pairs[:, 1] * bodies + pairs[:, 0]
    sensors = setup.traits["sensor"] >= 0
    if (np.diff(keys) <= 0).any() or not (sensors[pairs[:, 0]] & ~sensors[pairs[:, 1]]).all():
        raise _corrupt("bodies inside sensors")
