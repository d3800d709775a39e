"""The collision engine. It knows no game.

Colliders are shapes, bodies (or any objects that have a collider and a position) are shapes
somewhere. `detect`, `contact`, `relax`, `bounce`, `resolve`, `collide` and `time_of_impact` answer
and act on a pair of them.
"""

from .body import Body
from .colliders import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
)
from .errors import InseparableError
from .operations import (
    Contact,
    Impact,
    bounce,
    collide,
    contact,
    detect,
    relax,
    resolve,
    time_of_impact,
)
from .protocols import Collidable, Dynamic, Moving

__all__ = [
    "AxisAlignedHalfPlane",
    "AxisAlignedRectangle",
    "Body",
    "Collidable",
    "Collider",
    "Contact",
    "Convex",
    "Dynamic",
    "HalfPlane",
    "Impact",
    "InseparableError",
    "Moving",
    "Particle",
    "Rectangle",
    "bounce",
    "collide",
    "contact",
    "detect",
    "relax",
    "resolve",
    "time_of_impact",
]
