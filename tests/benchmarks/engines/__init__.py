"""What is compared: this project's engine, and its peers as far as they are installed.

Every module here holds one class, and all classes are used in the same way::

    engine = Pymunk(scene, accurate=False, count=False)
    contacts = engine.run(steps)  # contacts that began; 0 unless asked to count
    positions, velocities = engine.state()  # float64 [n, 2]; velocities in units a step

``accurate`` picks one of the two settings of a peer, found by trying (each class says which): one
as fast as it goes, one that keeps the energy as well as it can. Counting costs the peers a callback
or a list a contact, so speeds are measured without it, and the same flight is counted apart.
"""

import importlib
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from .scene import Scene

# What a peer is called: its package, and the module here.
PEERS = {
    "pymunk": ("pymunk", "pymunk_engine"),
    "Box2D 2.3": ("Box2D", "box2d_2"),
    "Box2D 3.1": ("pyb2d3", "box2d_3"),
}


class Engine(Protocol):
    """A scene in one of the engines."""

    def __init__(self, scene: Scene, *, accurate: bool = False, count: bool = False) -> None: ...

    def run(self, steps: int) -> int:
        """Take steps; return the contacts that began, if they are counted."""

    def state(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return positions and velocities of the discs, [n, 2], in units and units a step."""


def installed_peers() -> dict[str, type[Engine] | None]:
    """Return the class of every peer by its name; None if it is not installed."""
    return {name: peer(package, module) for name, (package, module) in PEERS.items()}


def peer(package: str, module: str) -> Any:
    try:
        importlib.import_module(package)
    except ImportError:
        return None
    return importlib.import_module(f".{module}", __name__).ENGINE
