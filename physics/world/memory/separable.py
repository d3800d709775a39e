"""Whether all bodies that have to bounce can be separated."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ...pairs.table import contact_between
from ...shapes.records import Edge
from ..state.records import ON
from .setup import Setup, have_bounds


def inseparable_pair(setup: Setup) -> tuple[int, int] | None:
    """Return two bodies that have to bounce and that no finite translation separates, or None."""
    bodies = int(setup.header.bodies)
    traits, shapes = setup.traits[:bodies], setup.shapes
    is_open = ~have_bounds(shapes)[traits["collider"]] & (traits["sensor"] < 0)
    open_ones = np.flatnonzero(is_open & (setup.entries["state"][:bodies] == ON))
    for a in open_ones[traits["slot"][open_ones] >= 0]:
        for b in open_ones:
            one, other = traits[a], traits[b]
            meets = one["category"] & other["mask"] and other["category"] & one["mask"]
            if a == b or not meets or one["inverse_mass"] + other["inverse_mass"] == 0.0:
                continue
            pair = int(one["collider"]), int(other["collider"])
            depth = contact_between(shapes, _at_least_one(setup.edges), *pair, 0.0, 0.0)[3]
            if depth == math.inf:
                return int(a), int(b)
    return None


def _at_least_one(edges: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return edges, or one that nobody uses, so that even discs alone give what kernels accept."""
    return edges if len(edges) else np.zeros(1, Edge)
