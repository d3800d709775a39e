"""The collision engine. It knows no game.

A collider is a shape. A body, or any object with a collider and a position, is a shape at a
position. `detect`, `contact` and `time_of_impact` answer questions about a pair of bodies; `relax`,
`bounce`, `resolve` and `collide` change them. A `World` steps many bodies from impact to impact, a
`WorldBatch` many worlds.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .body import Body
    from .errors import HitLimitWarning, InseparableError, NoBodyError
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
    from .world.queries.answers import RayHit, RayHits
    from .world.state.records import BEGIN, END, HIT, Hit
    from .world.world import World

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
    "NoBodyError",
    "Particle",
    "RayHit",
    "RayHits",
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

_NAMES = {
    "body": "Body",
    "errors": "HitLimitWarning InseparableError NoBodyError",
    "operations": "Contact Impact bounce collide contact detect relax resolve time_of_impact",
    "protocols": "Collidable Dynamic Moving",
    "shapes.colliders": "AxisAlignedHalfPlane AxisAlignedRectangle Collider Convex HalfPlane "
    "Particle Rectangle",
    "world.batch": "WorldBatch",
    "world.state.records": "BEGIN END HIT Hit",
    "world.queries.answers": "RayHit RayHits",
    "world.world": "World",
}
_MODULES = {name: module for module, names in _NAMES.items() for name in names.split()}

if not TYPE_CHECKING:  # a checker would take any name for one of these

    def __getattr__(name: str) -> Any:
        # Imported on demand: the game needs only some of the kernels.
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f".{_MODULES[name]}", __name__), name)
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        return [*globals(), *__all__]
