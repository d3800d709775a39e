"""The operations on a pair of objects: detection, contact, relaxation, bounce, time of impact.

Each works on any objects that have what it needs (see `protocols`). It calls the same kernels as
the simulation, and assigns what has changed.
"""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .arguments import duration as checked_duration
from .arguments import inverse_mass, not_negative, vector
from .body import FloatArray
from .errors import InseparableError
from .pairs.response import bounce_velocities, shares
from .pairs.table import contact_between, impact_between, overlap_between
from .pairs.touching import touch_margins
from .protocols import Collidable, Dynamic, Moving
from .shapes.colliders import Collider
from .shapes.table import ShapeTable, shape_table


class Contact(NamedTuple):
    """How two regions overlap.

    Attributes:
        normal: unit vector from a to b, along the shortest translation that separates them.
        depth: the length of that translation, inf if no finite one separates.
        point: halfway between the surfaces that separate along the normal: a's surface is
            ``depth / 2`` ahead of it along the normal, b's ``depth / 2`` behind.
    """

    normal: FloatArray
    depth: float
    point: FloatArray


class Impact(NamedTuple):
    """When two regions touch.

    Attributes:
        time: from now, in the unit of time of the velocities.
        normal: unit vector from a to b.
    """

    time: float
    normal: FloatArray


def detect(a: Collidable, b: Collidable) -> bool:
    """Return whether the interiors of a and b overlap. Touching is not overlapping.

    They touch up to an overlap of 1e-12 of their coordinates and sizes, which rounding may hide.
    """
    shapes, edges, dx, dy, margin_x, margin_y = _pair(a, b)
    return bool(overlap_between(shapes, edges, 0, 1, dx, dy, margin_x, margin_y))


def contact(a: Collidable, b: Collidable) -> Contact | None:
    """Return how a and b overlap, None if they do not.

    Moving a by ``-normal * depth`` or b by ``normal * depth`` separates them, and no shorter
    translation does.
    """
    shapes, edges, dx, dy, margin_x, margin_y = _pair(a, b)
    found, normal_x, normal_y, depth, x, y = contact_between(
        shapes, edges, 0, 1, dx, dy, margin_x, margin_y
    )
    if not found:
        return None
    origin_x, origin_y = a.position
    point = (origin_x + x, origin_y + y)
    return Contact(np.array((normal_x, normal_y)), float(depth), np.array(point, np.float64))


def time_of_impact(a: Collidable, b: Collidable, duration: float = math.inf) -> Impact | None:
    """Return when and how a and b, moving with their velocities, begin to overlap.

    Args:
        a: an object; without a velocity it does not move.
        b: the other object.
        duration: how long to look ahead, perhaps infinitely.

    Returns:
        The first touch. None if there is none within the duration, or if the two merely slide along
        each other, graze, or separate. If they overlap already, the time is 0, and the normal is
        the contact's.
    """
    horizon = checked_duration("duration", duration)
    shapes, edges, dx, dy, margin_x, margin_y = _pair(a, b)
    velocity_ax, velocity_ay = _velocity(a)
    velocity_bx, velocity_by = _velocity(b)
    time, normal_x, normal_y = impact_between(
        shapes,
        edges,
        0,
        1,
        dx,
        dy,
        velocity_bx - velocity_ax,
        velocity_by - velocity_ay,
        horizon,
        margin_x,
        margin_y,
    )
    if time == math.inf:
        return None
    return Impact(float(time), np.array((normal_x, normal_y)))


def relax(a: Collidable, b: Collidable, contact: Contact) -> None:
    """Move a and b apart along a contact's normal, by its depth, in shares reciprocal to mass.

    An object without mass does not move.

    Raises:
        InseparableError: if the contact's depth is infinite.
    """
    if contact.depth == math.inf:
        raise InseparableError(a, b)
    share_a, share_b = shares(_inverse_mass("a", a), _inverse_mass("b", b))
    x, y = contact.normal
    if share_a:
        _shift(a, -contact.depth * share_a, x, y)
    if share_b:
        _shift(b, contact.depth * share_b, x, y)


def bounce(
    a: Moving, b: Collidable, normal: npt.ArrayLike, restitution: float | None = None
) -> float:
    """Exchange momentum along the normal, if a and b approach each other along it.

    Args:
        a: the body from which the normal points; at least one of the two should have a mass.
        b: the body to which it points; without a velocity it does not move.
        normal: (x, y), of any length but 0.
        restitution: e, not negative; if None, the product of the two bodies' values.

    Returns:
        The impulse ``J = -(e + 1) (v1 - v2) / (1/m1 + 1/m2)`` with speeds along the normal: a's
        velocity changes by ``J / m1`` along it, b's by ``-J / m2``. 0 if they do not approach or
        neither has a mass.
    """
    normal_x, normal_y = vector("normal", normal)
    length = math.hypot(normal_x, normal_y)
    if length == 0.0:
        raise ValueError(f"normal must have a direction, but is {normal!r}")
    if restitution is None:
        e = _restitution(a) * _restitution(b)
    else:
        e = not_negative("restitution", restitution)
    inverse_a = _inverse_mass("a", a)
    inverse_b = _inverse_mass("b", b)
    for item, inverse in ((a, inverse_a), (b, inverse_b)):
        if inverse and not hasattr(item, "velocity"):
            raise TypeError(f"to bounce, an object with a mass needs a velocity; {item!r} has none")
    vx_a, vy_a = _velocity(a)
    vx_b, vy_b = _velocity(b)
    vx_a, vy_a, vx_b, vy_b, impulse = bounce_velocities(
        vx_a,
        vy_a,
        vx_b,
        vy_b,
        inverse_a,
        inverse_b,
        normal_x / length,
        normal_y / length,
        e,
    )
    if impulse != 0.0:
        if inverse_a:
            _assign("velocity", a, vx_a, vy_a)
        if inverse_b:
            _assign("velocity", b, vx_b, vy_b)
    return float(impulse)


def resolve(a: Dynamic, b: Collidable, restitution: float | None = None) -> float:
    """Relax and bounce a and b if they overlap; return the bounce's impulse, 0 if there was none.

    Raises:
        InseparableError: if no finite translation separates them.
    """
    overlap = contact(a, b)
    if overlap is None:
        return 0.0
    relax(a, b, overlap)
    return bounce(a, b, overlap.normal, restitution)


def collide(a: Dynamic, b: Collidable) -> bool:
    """Detect whether a and b overlap, and resolve it if they do. Return whether they did.

    Raises:
        InseparableError: if no finite translation separates them.
    """
    if not detect(a, b):
        return False
    resolve(a, b)
    return True


@lru_cache(maxsize=4096)
def _pair_table(a: Collider, b: Collider) -> ShapeTable:
    """Return the records of two colliders."""
    return shape_table((a, b))


def _pair(a: Any, b: Any) -> tuple[Any, Any, float, float, float, float]:
    """Return (shapes, edges, dx, dy, margin_x, margin_y) of two objects.

    These are their records, b's position from a, and up to which gap they touch.
    """
    try:
        shapes, edges = _pair_table(a.collider, b.collider)
        ax, ay = a.position
        bx, by = b.position
        dx = float(bx - ax)
        dy = float(by - ay)
    except (AttributeError, TypeError, ValueError):
        _check(a)
        _check(b)
        raise
    except OverflowError:  # of integers
        _check(a)
        _check(b)
        raise ValueError("the positions are too far apart for a float") from None
    if not (math.isfinite(dx) and math.isfinite(dy)):
        raise ValueError(f"positions must be finite, but are ({ax}, {ay}) and ({bx}, {by})")
    margin_x, margin_y = touch_margins(
        shapes, edges, 0, 1, float(ax), float(ay), float(bx), float(by)
    )
    return shapes, edges, dx, dy, margin_x, margin_y


def _check(item: Any) -> None:
    """Raise an error that says what an object lacks to be detected, if it lacks anything."""
    for name in ("collider", "position"):
        if not hasattr(item, name):
            raise TypeError(f"to collide, an object needs a {name}; {item!r} has none")
    if not isinstance(item.collider, Collider):
        raise TypeError(f"a collider is needed, such as Particle(1.0), not {item.collider!r}")
    vector("position", item.position)


def _velocity(item: Any) -> tuple[float, float]:
    """Return an object's velocity, zero if it has none."""
    velocity = getattr(item, "velocity", None)
    if velocity is None:
        return 0.0, 0.0
    return vector("velocity", velocity)


def _inverse_mass(name: str, item: Any) -> float:
    """Return 1 / mass, 0 for an object that has none."""
    return inverse_mass(f"the mass of {name}", getattr(item, "mass", None))


def _restitution(item: Any) -> float:
    """Return an object's restitution, 1 if it has none."""
    return not_negative("restitution", getattr(item, "restitution", 1.0))


def _shift(item: Any, distance: float, x: float, y: float) -> None:
    """Move an object along a unit vector."""
    old_x, old_y = item.position
    try:
        new_x, new_y = old_x + distance * x, old_y + distance * y
    except OverflowError:  # of integers
        vector("position", item.position)
        raise
    _assign("position", item, new_x, new_y)


def _assign(name: str, item: Any, x: float, y: float) -> None:
    """Assign a position or velocity of the same type as before: array, list, or else tuple."""
    old = getattr(item, name)
    if isinstance(old, np.ndarray):
        setattr(item, name, np.array((x, y), np.float64))
    elif isinstance(old, list):
        setattr(item, name, [float(x), float(y)])
    else:
        setattr(item, name, (float(x), float(y)))
