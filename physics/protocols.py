"""What an object needs to take part. Nothing is inherited or registered: having it is enough.

Positions and velocities are two numbers: a tuple, a list or an array. The engine reads them, and
where it changes one it assigns a new value of the same type (an array stays an array, of float64;
a list a list; anything else becomes a tuple of floats). It never writes into the old value.
"""

from typing import Any, Protocol, runtime_checkable

from .shapes.colliders import Collider


@runtime_checkable
class Collidable(Protocol):
    """Can be detected: it has a shape and a place. Without a ``mass`` it is never moved."""

    @property
    def collider(self) -> Collider:
        """The shape, in body coordinates."""
        ...

    @property
    def position(self) -> Any:
        """(x, y): where the collider's origin is."""


@runtime_checkable
class Moving(Collidable, Protocol):
    """Can be bounced off, and its time of impact found: it moves.

    An optional ``restitution`` says how much of the approaching speed a bounce gives back (1 if it
    is missing, all of it).
    """

    @property
    def velocity(self) -> Any:
        """(x, y): the change of position in one unit of time."""


@runtime_checkable
class Dynamic(Moving, Protocol):
    """Can be pushed: collisions change its position and velocity, if its mass is not None."""

    @property
    def mass(self) -> float | None:
        """Greater than 0. None means static: it never gives way."""
