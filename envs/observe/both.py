"""The `dict` observation: the pictures of `rgb` and the numbers of `vector` together."""

from copy import copy
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ..config import Config
from ..state import SharedRules, Worlds, copy_records
from .pixels import PixelObserver
from .protocol import Mask, Observe, Observer
from .vector import VectorObserver


class DictObserver:
    """`Observer` of pictures and numbers: records [n] with the fields ``"rgb"`` and ``"vector"``.

    `layout` has each one's layout under its name, and `parts` the observers.
    """

    def __init__(self, config: Config, num_worlds: int) -> None:
        """Make the observers, and the array that holds what both show."""
        self.parts: dict[str, Observer] = {
            "rgb": PixelObserver(config, num_worlds),
            "vector": VectorObserver(config, num_worlds),
        }
        shown = {name: each.space for name, each in self.parts.items()}
        self.space: spaces.Space[Any] = spaces.Dict(shown)
        self.layout: Any = {name: each.layout for name, each in self.parts.items()}
        arrays = {name: each.observations for name, each in self.parts.items()}
        fields = [(name, array.dtype, array.shape[1:]) for name, array in arrays.items()]
        self.observations: NDArray[Any] = np.zeros(num_worlds, np.dtype(fields, align=True))

    def advance(self) -> None:
        """Begin a new step."""
        for observer in self.parts.values():
            observer.advance()

    def check(self, observations: NDArray[Any]) -> None:
        """Raise a ValueError if no world could be observed like this."""
        for name, observer in self.parts.items():
            observer.check(observations[name])

    def recall(self, observations: NDArray[Any]) -> None:
        """Go on from these pictures and numbers."""
        for name, observer in self.parts.items():
            observer.recall(observations[name])
            self.observations[name] = observations[name]

    def clone(self) -> "DictObserver":
        """Return one that shows the same in arrays of its own."""
        clone = copy(self)
        clone.parts = {name: each.clone() for name, each in self.parts.items()}
        clone.observations = copy_records(self.observations)
        return clone

    def part(self, worlds: Worlds, rules: SharedRules, share: slice) -> Observe:
        """Return what observes a share of the worlds."""
        parts = {name: each.part(worlds, rules, share) for name, each in self.parts.items()}
        shown = {name: self.observations[name][share] for name in parts}

        def observe(mask: Mask) -> None:
            everywhere = bool(mask.all())
            for name, part in parts.items():
                part(mask)
                seen = self.parts[name].observations[share]
                if everywhere:
                    shown[name][...] = seen
                else:
                    shown[name][mask] = seen[mask]

        return observe
