"""States of games: tests compare them, or set them up by hand."""

from typing import Any

import numpy as np
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.state import World

# What the state has only for those who show the bricks; the game's course does not depend on it.
_FOR_OBSERVERS = ("brick_changes", "changed_cells")


def writable_states(env: Any) -> Any:
    """Return the `World` records [n] of an environment, to write into.

    Environments show their states read-only. A test that writes one answers for it: the game takes
    it as it is. After writing bricks, call `observe_anew` to see them.
    """
    return env.unwrapped._batch.worlds


def writable_state(env: ArkanoidEnv) -> Any:
    """Return the `World` record of a single environment, to write into."""
    return writable_states(env)[0]


def latest_observations(env: ArkanoidEnv | ArkanoidVectorEnv) -> Any:
    """Return the latest observations, [n, ...], without a copy."""
    return env.unwrapped._batch.observations


def observe_anew(env: ArkanoidEnv | ArkanoidVectorEnv, shown: Any = None) -> Any:
    """Observe the states as they are, without playing, and return the observations [n, ...].

    Args:
        shown: the observations as they are before, when nobody knows what they show; None leaves
            them as they are.
    """
    batch = env.unwrapped._batch
    batch.observer.recall(batch.observations.copy() if shown is None else shown)
    batch.observe(np.ones(len(batch.worlds), np.bool_))
    return batch.observations


def portable_bytes(states: Any) -> bytes:
    """Return the numbers of `World` records as bytes that do not depend on the records' layout."""
    parts = []
    for name in sorted(set(World.fields) - set(_FOR_OBSERVERS)):
        values = states[name]
        parts.append(values if values.dtype.kind in "fu" else values.astype(np.int64))
    return b"".join(part.tobytes() for part in parts)
