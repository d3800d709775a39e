"""The state of a batch's worlds as bytes, which are refused where they do not belong.

A snapshot is sealed (`sealed`) with this content:

    4 bytes  length of the setup; 4 bytes: number of worlds
    setup    JSON: the rules' version, the configuration, digests of the levels and of the layout
    worlds   `World` records, their random generators among them
    outcomes `Outcome` records of the latest step
    observations, the latest of each world: a stack of pictures remembers earlier ones
"""

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels.sealed import seal, unseal
from .batch import Batch

_MARK = b"ARKASNAP"
_FORMAT = 1
_SIZES = struct.Struct("<II")


def take_snapshot(batch: Batch, world: int | None = None) -> bytes:
    """Return the state of all worlds of a batch, or of one of them.

    Raises:
        RuntimeError: a world was never reset, and has no state.
        TypeError, ValueError: there is no such world.
    """
    if world is not None:
        batch.check_world(world)
    share = slice(None) if world is None else slice(world, world + 1)
    worlds = batch.worlds[share]
    if not batch.seeded[share].all():
        raise RuntimeError("there is no state yet: reset the environment before a snapshot")
    sizes = _SIZES.pack(len(batch.setup), len(worlds))
    arrays = worlds, batch.outcomes[share], batch.observations[share]
    content = batch.alone.run(lambda: [array.tobytes() for array in arrays])
    return seal(_MARK, _FORMAT, b"".join((sizes, batch.setup, *content)))


def restore_snapshot(batch: Batch, snapshot: bytes) -> None:
    """Restore a snapshot of as many worlds as the batch has.

    Raises:
        TypeError, ValueError: see `_unpack`, or it has another number of worlds; nothing changes.
    """
    state = _unpack(batch, snapshot)
    if len(state[0]) != batch.num_worlds:
        raise ValueError(
            f"the snapshot has another number of worlds, {len(state[0])} instead of "
            f"{batch.num_worlds}; spread() takes that of one world to all"
        )
    batch.alone.run(batch.restore, *state)


def spread_snapshot(batch: Batch, snapshot: bytes, seeds: Sequence[int | None]) -> None:
    """Bring every world of a batch into the state of a snapshot of one world.

    Args:
        seeds: of each world's random numbers from here on; None: those of the snapshot.

    Raises:
        TypeError, ValueError: see `_unpack`, or it has several worlds; nothing changes then.
        RuntimeError: another call is in progress.
    """
    state = _unpack(batch, snapshot)
    if len(state[0]) != 1:
        raise ValueError(
            f"the snapshot has {len(state[0])} worlds, and spread() takes that of one: of a single "
            "environment, or snapshot(world)"
        )

    def spread() -> None:
        batch.restore(*state)
        for index, seed in enumerate(seeds):
            if seed is not None:
                batch.seed(index, seed)

    batch.alone.run(spread)


def _unpack(
    batch: Batch, snapshot: bytes
) -> tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[Any]]:
    """Return the worlds (bytes [n, k]), outcomes (bytes [n, k]) and observations of a snapshot.

    Raises:
        TypeError: it is not bytes.
        ValueError: it is corrupt, or of another release, rules, configuration or levels.
    """
    content = unseal("snapshot", _MARK, _FORMAT, snapshot)
    if len(content) < _SIZES.size:
        raise ValueError("the snapshot is corrupt: it has no state")
    length, count = _SIZES.unpack_from(content)
    place = _SIZES.size + length
    setup = content[_SIZES.size : place]
    if setup != batch.setup:
        theirs, ours = _read_setup(setup), json.loads(batch.setup)
        if theirs != ours:  # not only written differently, as 1 and 1.0
            raise ValueError(_difference(theirs, ours))
    arrays = batch.worlds, batch.outcomes, batch.observations
    if count == 0 or len(content) != place + count * sum(array[0].nbytes for array in arrays):
        raise ValueError("the snapshot is corrupt: it has not the length of its worlds")
    parts: list[NDArray[Any]] = []
    for array in arrays:
        size = count * array[0].nbytes
        parts.append(np.frombuffer(content[place : place + size], np.uint8).reshape(count, -1))
        place += size
    worlds, outcomes, observations = parts
    shape = (count, *batch.observations.shape[1:])
    return worlds, outcomes, observations.view(batch.observations.dtype).reshape(shape)


def _read_setup(setup: memoryview) -> dict[str, Any]:
    """Return a setup that differs from the expected one, with all of its parts."""
    try:
        read = json.loads(bytes(setup).decode())
        return {"config": dict(read["config"])} | {
            name: read[name] for name in ("rules", "levels", "layout")
        }
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise ValueError("the snapshot is corrupt: it does not say what it is of") from error


def _difference(theirs: dict[str, Any], ours: dict[str, Any]) -> str:
    """Return in words what two setups differ in."""
    if theirs["rules"] != ours["rules"]:
        return (
            f"the snapshot is of the rules' version {theirs['rules']}, and this release plays "
            f"version {ours['rules']}: restore it with the release that took it"
        )
    for name in ours["config"]:
        there, here = theirs["config"].get(name), ours["config"][name]
        if there != here:
            return (
                f"the snapshot is of another configuration: {name} is {there!r} there, and "
                f"{here!r} here"
            )
    if theirs["levels"] != ours["levels"]:
        return "the snapshot is of other levels: make the environment with the same `levels`"
    return (
        "the snapshot is of another release, which kept its state differently: restore it with the "
        "release that took it"
    )
