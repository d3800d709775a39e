"""The engines that are compared: this project's, and those of its peers that are installed.

Every module holds one class, and all classes are used in the same way::

    engine = Pymunk(scene, accurate=False, count=False)
    contacts = engine.run(steps)  # contacts that began; 0 unless count is set
    positions, velocities = engine.state()  # float64 [n, 2]; velocities in units per step

A `Sandbox` is a world that changes while it runs, for the scenes of ``sandboxes.py``.

``accurate`` chooses between two settings of a peer, which were found by trial (each class names
them): the fastest, and the one that conserves energy best. Counting costs the peers a callback or a
list per contact. So speeds are measured without it, and a second run counts.
"""

import importlib
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from .sandbox import Sandbox
from .scene import Scene

# The name of each peer: its package, and its module here.
PEERS = {
    "pymunk": ("pymunk", "pymunk_engine"),
    "Box2D 2.3": ("Box2D", "box2d_2"),
    "Box2D 3.1": ("pyb2d3", "box2d_3"),
}


class Engine(Protocol):
    """A scene in one of the engines."""

    def __init__(self, scene: Scene, *, accurate: bool = False, count: bool = False) -> None: ...

    def run(self, steps: int) -> int:
        """Take steps; return the number of contacts that began, if they are counted."""

    def state(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return positions and velocities of the discs, [n, 2], in units and units per step."""


def installed_peers() -> dict[str, type[Engine] | None]:
    """Return the class of each peer by its name; None for a peer that is not installed."""
    return {name: peer(package, module, "ENGINE") for name, (package, module) in PEERS.items()}


def installed_sandboxes() -> dict[str, type[Sandbox] | None]:
    """Return the sandbox of each peer by its name; None for a peer that is not installed."""
    return {
        name: peer(package, f"{module.removesuffix('_engine')}_sandbox", "SANDBOX")
        for name, (package, module) in PEERS.items()
    }


def peer(package: str, module: str, name: str) -> Any:
    try:
        importlib.import_module(package)
    except ImportError:
        return None
    return getattr(importlib.import_module(f".{module}", __name__), name)
