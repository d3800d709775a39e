"""What turns the worlds of a batch into observations: one class for each kind of observation."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ..config import Config

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
        """Begin a new step: what is observed next follows what was observed before."""

    def recall(self, observations: NDArray[Any]) -> None:
        """Go on from these as the latest observations, [n, ...], or [1, ...] for all worlds."""

    def clone(self) -> "Observer":
        """Return one that shows the same in arrays of its own, and shares what never changes."""
        ...

    def part(self, worlds: Any, rules: Any, share: slice) -> Observe:
        """Return what observes a share of the worlds: those of a mask, bool [worlds in it].

        Args:
            worlds: `World` records, all of the batch.
            rules: `Rules` [1].
        """
        ...
