"""Worlds that change while they run: what each engine offers to a game, under the same names.

Units are metres; a step lasts `STEP` seconds. Bodies do not turn, and nothing has friction.
"""

from collections.abc import Sequence
from typing import Any, Protocol

STEP = 1 / 60  # seconds; Chipmunk and Box2D are made for it
Pair = tuple[float, float]


class Sandbox(Protocol):
    """A world in one of the engines.

    Handles are whatever the engine gives; positions and velocities are pairs, in metres and metres
    a second.
    """

    def __init__(self, gravity: float = 0.0, restitution: float = 1.0) -> None:
        """Make an empty world.

        Args:
            gravity: metres a second squared, downwards.
            restitution: of every pair of bodies, 0 or 1.
        """

    def disc(self, position: Pair, velocity: Pair, radius: float) -> Any:
        """Add a disc of mass 1; return its handle."""

    def crate(self, position: Pair, velocity: Pair, size: Pair) -> Any:
        """Add a box of mass 1 along the axes; return its handle."""

    def tile(self, position: Pair, size: Pair) -> Any:
        """Add a box along the axes that never moves; return its handle."""

    def remove(self, handle: Any) -> None:
        """Remove a body."""

    def position(self, handle: Any) -> Pair:
        """Return where a body is."""

    def velocity(self, handle: Any) -> Pair:
        """Return how a body moves."""

    def push(self, handle: Any, velocity: Pair) -> None:
        """Give a body another velocity."""

    def step(self) -> None:
        """Take one step."""

    def rays(self, rays: Sequence[tuple[Pair, Pair]]) -> list[float]:
        """Return for each ray (from, to) the part of it before what it meets first, or inf."""
