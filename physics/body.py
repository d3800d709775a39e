"""The ready-made item: a collider with position, velocity, mass and restitution."""

from typing import Any

import numpy as np
import numpy.typing as npt

from .arguments import inverse_mass, not_negative, vector
from .shapes.colliders import Collider

FloatArray = npt.NDArray[np.float64]


class Body:
    """A collider somewhere, perhaps moving, perhaps with a mass.

    Args:
        collider: the shape, in body coordinates.
        position: (x, y) of the collider's origin.
        velocity: (x, y), the change of position in one unit of time.
        mass: greater than 0; None for a static body, which collisions never move. (It may still
            move by its own velocity, which bounces take into account.)
        restitution: the share of the approaching speed that a bounce gives back, multiplied by
            the other body's; not negative.

    Position and velocity are float64 [2]; assigned values are checked and copied.
    The operations of this package change a body in place.
    """

    __slots__ = ("_collider", "_mass", "_position", "_restitution", "_velocity")

    def __init__(
        self,
        collider: Collider,
        position: npt.ArrayLike = (0.0, 0.0),
        velocity: npt.ArrayLike = (0.0, 0.0),
        mass: float | None = None,
        restitution: float = 1.0,
    ) -> None:
        self.collider = collider
        self._position = np.array(vector("position", position))
        self._velocity = np.array(vector("velocity", velocity))
        self.mass = mass
        self.restitution = restitution

    @property
    def collider(self) -> Collider:
        """The shape, in body coordinates."""
        return self._collider

    @collider.setter
    def collider(self, value: Collider) -> None:
        if not isinstance(value, Collider):
            raise TypeError(f"collider must be a collider such as Particle(1.0), but is {value!r}")
        self._collider = value

    @property
    def position(self) -> FloatArray:
        """(x, y) of the collider's origin."""
        return self._position

    @position.setter
    def position(self, value: Any) -> None:
        self._position = np.array(vector("position", value))

    @property
    def velocity(self) -> FloatArray:
        """(x, y), the change of position in one unit of time."""
        return self._velocity

    @velocity.setter
    def velocity(self, value: Any) -> None:
        self._velocity = np.array(vector("velocity", value))

    @property
    def mass(self) -> float | None:
        """The mass; None for a static body."""
        return self._mass

    @mass.setter
    def mass(self, value: float | None) -> None:
        inverse_mass("mass", value)
        self._mass = None if value is None else float(value)

    @property
    def restitution(self) -> float:
        """The share of the approaching speed that a bounce gives back."""
        return self._restitution

    @restitution.setter
    def restitution(self, value: float) -> None:
        self._restitution = not_negative("restitution", value)

    def __repr__(self) -> str:
        position = tuple(self._position.tolist())
        velocity = tuple(self._velocity.tolist())
        return (
            f"Body({self._collider!r}, position={position}, velocity={velocity}, "
            f"mass={self._mass}, restitution={self._restitution})"
        )
