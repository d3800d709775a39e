"""The collision engine. It knows no game.

A collider is a shape. A body, or any object with a collider and a position, is a shape at a
position. `detect`, `contact` and `time_of_impact` answer questions about a pair of bodies; `relax`,
`bounce`, `resolve` and `collide` change them. A `World` steps many bodies from impact to impact, a
`WorldBatch` many worlds.
"""

from .body import Body
from .errors import HitLimitWarning, InseparableError
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
from .shapes.colliders import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
)
from .world.batch import WorldBatch
from .world.records import BEGIN, END, HIT, Hit
from .world.world import RayHit, World

__all__ = [
    "BEGIN",
    "END",
    "HIT",
    "AxisAlignedHalfPlane",
    "AxisAlignedRectangle",
    "Body",
    "Collidable",
    "Collider",
    "Contact",
    "Convex",
    "Dynamic",
    "HalfPlane",
    "Hit",
    "HitLimitWarning",
    "Impact",
    "InseparableError",
    "Moving",
    "Particle",
    "RayHit",
    "Rectangle",
    "World",
    "WorldBatch",
    "bounce",
    "collide",
    "contact",
    "detect",
    "relax",
    "resolve",
    "time_of_impact",
]
