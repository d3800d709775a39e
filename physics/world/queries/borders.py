"""Rays along the border of two bodies: what lies between the two is inside of both together.

Each of the two bodies alone is only grazed. So a ray meets the border where it comes along both: a
side of one body, and one of another body on the other side of the ray, see `pairs.seams`.
"""

import math

from ...kernels import kernel
from ...pairs.results import NO_IMPACT
from ...pairs.seams import next_end, next_stretch
from ...pairs.touching import margin_along, touch_margins
from ...shapes.records import Edges, Shapes
from ...shapes.vectors import unit_vector
from ..lookup.ground import find_at
from ..state.courses import shown_place
from ..state.records import RayRecord
from ..state.view import WorldView, traits_of
from .rays import last_of

# The other body is looked for near to where a side begins, because there are others farther along;
# but not too near, because it may begin with a sharp corner. So at several fractions of the side.
LOOKS = 6
NEARER = 2.0**-8


@kernel
def meet_border(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    ray: RayRecord,
    mask: int,
    body: int,
    unboxed: int,
    used: int,
    enters: bool,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y): where a ray meets the border of a body and another one.

    Args:
        world, ray, body: see above.
        shapes, edges: the world's shapes, and the ray's, which is a point, at the end.
        mask: the categories that count.
        unboxed, used: as of `find_at`.
        enters: whether the ray enters the body, at a corner. If it only grazes the corner, what
            another body covers beside it tells nothing about the ray.
    """
    time, normal_x, normal_y = _meet_along(world, shapes, edges, ray, mask, body, unboxed, used)
    if time < math.inf or not enters:
        return time, normal_x, normal_y
    own, other = shapes.shape[0] - 1, traits_of(world)[body].collider
    x, y = shown_place(world, traits_of(world)[body])
    margin_x, margin_y = touch_margins(shapes, edges, own, other, ray.x, ray.y, x, y)
    dx, dy, vx, vy = x - ray.x, y - ray.y, -ray.way_x, -ray.way_y
    last = last_of(ray, margin_x, margin_y)
    tried, number = 0, 0
    while number >= 0:
        tried, number, time, beyond_x, beyond_y = next_end(
            shapes, edges, own, other, tried, dx, dy, vx, vy, last, margin_x, margin_y
        )
        if number < 0:
            break
        face_x, face_y = edges[number].normal_x, edges[number].normal_y
        # What does not sink in by more than rounding may hide runs along the face.
        sinks = face_x * vx + face_y * vy > margin_along(face_x, face_y, margin_x, margin_y)
        place_x, place_y = x + beyond_x, y + beyond_y
        if (
            sinks
            and find_at(world, shapes, edges, mask, body, place_x, place_y, unboxed, used) >= 0
        ):
            return min(time, 1.0), -face_x, -face_y
    return NO_IMPACT


@kernel
def _meet_along(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    ray: RayRecord,
    mask: int,
    body: int,
    unboxed: int,
    used: int,
) -> tuple[float, float, float]:
    """Return the same, of a ray that comes along a side of the body and one of another body.

    The normal points along the ray, or out of the side if the ray begins between the two.
    """
    best, best_x, best_y = NO_IMPACT
    tried, number = 0, 0
    while number >= 0:
        tried, number, first, last, room = _next_along(world, shapes, edges, ray, body, tried)
        if number < 0:
            break
        normal_x, normal_y = edges[number].normal_x, edges[number].normal_y
        ahead = 0.5 * (last - first)
        for _ in range(LOOKS):
            if ahead * (abs(ray.way_x) + abs(ray.way_y)) <= 4.0 * room:
                break  # Two bodies that share a corner are no border.
            at = first + ahead
            other = find_at(
                world,
                shapes,
                edges,
                mask,
                body,
                ray.x + at * ray.way_x + 2.0 * room * normal_x,
                ray.y + at * ray.way_y + 2.0 * room * normal_y,
                unboxed,
                used,
            )
            ahead *= NEARER
            if other < 0:
                continue
            begin = max(first, _begins_along(world, shapes, edges, ray, other, normal_x, normal_y))
            if begin < best:
                best, best_x, best_y = begin, -normal_x, -normal_y
    if 0.0 < best < math.inf:
        best_x, best_y, _ = unit_vector(ray.way_x, ray.way_y)
    return best, best_x, best_y


@kernel
def _next_along(
    world: WorldView, shapes: Shapes, edges: Edges, ray: RayRecord, body: int, tried: int
) -> tuple[int, int, float, float, float]:
    """Return what `next_stretch` does of a body and a ray, and what margin they have."""
    own, shape = shapes.shape[0] - 1, traits_of(world)[body].collider
    x, y = shown_place(world, traits_of(world)[body])
    margin_x, margin_y = touch_margins(shapes, edges, own, shape, ray.x, ray.y, x, y)
    tried, number, first, last = next_stretch(
        shapes,
        edges,
        shape,
        tried,
        x - ray.x,
        y - ray.y,
        ray.way_x,
        ray.way_y,
        margin_x,
        margin_y,
    )
    return tried, number, first, last, margin_x + margin_y


@kernel
def _begins_along(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    ray: RayRecord,
    body: int,
    normal_x: float,
    normal_y: float,
) -> float:
    """Return where a ray comes along a side of a body that faces a normal; inf if it does not."""
    tried, number = 0, 0
    while number >= 0:
        tried, number, first, _, _ = _next_along(world, shapes, edges, ray, body, tried)
        if number >= 0:
            edge = edges[number]
            if edge.normal_x * normal_x + edge.normal_y * normal_y < 0.0:
                return first
    return math.inf
