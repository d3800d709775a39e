"""Who is told of all that happens to a batch, for instance recorders."""

import weakref
from collections.abc import Iterator
from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class Listener(Protocol):
    """Something that follows all that happens to a batch."""

    def reset(self, mask: NDArray[np.bool_]) -> None:
        """The worlds of a mask, bool [n], were reset."""

    def step(self) -> None:
        """A decision was played in each world."""

    def interrupt(self) -> None:
        """The worlds were brought into another state."""


class Listeners:
    """The listeners of a batch, each as long as somebody else keeps it.

    So a recorder that nobody needs any more is gone, even if nobody has stopped it.

    Attributes:
        references: to the listeners, some of which may be gone.
    """

    def __init__(self) -> None:
        self.references: list[weakref.ref[Listener]] = []

    def __iter__(self) -> Iterator[Listener]:
        for reference in self.references:
            listener = reference()
            if listener is not None:
                yield listener

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def add(self, listener: Listener) -> None:
        """Add a listener."""
        self.references = [weakref.ref(each) for each in (*self, listener)]

    def remove(self, listener: Listener) -> None:
        """Remove a listener, if it is there."""
        self.references = [weakref.ref(each) for each in self if each is not listener]
