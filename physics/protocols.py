"""What an object needs to take part. It need not inherit or register anything.

Positions and velocities are two numbers: a tuple, a list or an array. The engine reads them, and
where it changes one it assigns a new value of the same type: a float64 array for an array, a list
for a list, a tuple of floats for anything else. It never writes into the old value.
"""

from typing import Any, Protocol, runtime_checkable

from .shapes.colliders import Collider


@runtime_checkable
class Collidable(Protocol):
    """It has a shape and a position, and can be detected."""

    @property
    def collider(self) -> Collider:
        """The shape, in body coordinates."""
        ...

    @property
    def position(self) -> Any:
        """(x, y): where the collider's origin is."""


@runtime_checkable
class Moving(Collidable, Protocol):
    """It has a velocity, too: it can bounce, and have a time of impact.

    An optional ``restitution`` says how much of the approaching speed a bounce gives back; all of
    it, 1, if it is missing.
    """

    @property
    def velocity(self) -> Any:
        """(x, y): the change of position in one unit of time."""


@runtime_checkable
class Dynamic(Moving, Protocol):
    """It has a mass, too: collisions change its position and velocity, if the mass is not None."""

    @property
    def mass(self) -> float | None:
        """Greater than 0; None for a static object, which collisions never move."""
