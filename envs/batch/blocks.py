"""Worlds in blocks that fit into a core's cache, and blocks in shares, one per thread.

A block is stepped and observed before the next one, so that what a step has brought into the cache
is still there when it is observed.
"""

import itertools
import os
from collections.abc import Callable
from typing import NamedTuple

from ..observe.protocol import Mask, Observe
from ..state import Outcomes, Worlds

# By the kind of observation. To start a thread's work takes some 60 µs per step, and a thread with
# fewer worlds gains less than that.
WORLDS_PER_THREAD = {"vector": 1024, "grid": 512, "rgb": 128, "dict": 128}
# What a step touches of this number of worlds and their vectors fits into a cache of 1 MB.
WORLDS_PER_BLOCK = 512


class Block(NamedTuple):
    """A block of a batch's worlds, and the kernels together with the arrays that they take.

    Attributes:
        where: its worlds are in the batch.
        worlds, outcomes: those of the block.
        play: plays one decision in each world, and returns how many episodes are over.
        reset: begins a new episode in the worlds of a mask, bool [n].
        observe: writes the observations of the worlds of a mask.
        everywhere: the mask of all its worlds.
    """

    where: slice
    worlds: Worlds
    outcomes: Outcomes
    play: Callable[[], int]
    reset: Callable[[Mask], None]
    observe: Observe
    everywhere: Mask


def thread_count(num_worlds: int, observation: str) -> int:
    """Return how many threads pay for a number of worlds and a kind of observation."""
    worth = num_worlds // WORLDS_PER_THREAD[observation]
    return min(os.cpu_count() or 1, worth) if worth > 1 else 1


def divide(num_worlds: int, threads: int) -> list[list[slice]]:
    """Return the blocks of each thread's share, as slices of the worlds."""
    shares = min(threads, num_worlds)
    bounds = [num_worlds * share // shares for share in range(shares + 1)]
    return [
        [
            slice(first, min(first + WORLDS_PER_BLOCK, stop))
            for first in range(start, stop, WORLDS_PER_BLOCK)
        ]
        for start, stop in itertools.pairwise(bounds)
    ]
