"""What an observer has to offer: it turns the worlds of a batch into observations."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ..config import Config
from ..state import SharedRules, Worlds

Mask = NDArray[np.bool_]
Observe = Callable[[Mask], Any]


class Observer(Protocol):
    """The observations of a batch of worlds, in arrays that are written in place.

    Attributes:
        space: of one world's observation.
        layout: names of parts of an observation, as slices of its first axis.
        observations: the latest of each world, [n, ...].
    """

    space: spaces.Space[Any]
    layout: dict[str, slice]
    observations: NDArray[Any]

    def __init__(self, config: Config, num_worlds: int) -> None:
        """Make the arrays for a configuration and a number of worlds."""

    def advance(self) -> None:
        """Begin a new step: the next observations follow the present ones."""

    def check(self, observations: NDArray[Any]) -> None:
        """Raise a ValueError if these, [n, ...], can't be observations of worlds."""

    def recall(self, observations: NDArray[Any]) -> None:
        """Take these as the latest observations, [n, ...], or [1, ...] for all worlds.

        To be called when anything but the game has written the worlds: what was known of the
        observations is forgotten.
        """

    def clone(self) -> "Observer":
        """Return one that shows the same, in arrays of its own. What never changes is shared."""
        ...

    def part(self, worlds: Worlds, rules: SharedRules, share: slice) -> Observe:
        """Return a function that observes the worlds of a mask, bool [n], among those of a share.

        It only reads the worlds.

        Args:
            worlds: all of the batch.
            rules: of the batch.
            share: which worlds.
        """
        ...
