"""Rays along the border of two bodies: what lies between the two is inside of both together.

Each of the two bodies alone is only grazed. So a ray meets the one whose side it comes to where the
border begins, if another one covers the place on the border's other side, see `pairs.seams`.
"""

from ...kernels import kernel
from ...pairs.results import NO_IMPACT
from ...pairs.seams import next_end, next_side
from ...pairs.touching import margin_along, touch_margins
from ...shapes.records import Edges, Shapes
from ..records import RayRecord
from ..view import WorldView, traits_of
from .ground import is_filled


@kernel
def meet_border(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    ray: RayRecord,
    mask: int,
    body: int,
    x: float,
    y: float,
    unboxed: int,
    used: int,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y): where a ray meets the border of a body and another one.

    Args:
        world, ray, body: see above.
        shapes, edges: the world's shapes, and the ray's, which is a point, at the end.
        mask: the categories that count.
        x, y: the body's place.
        unboxed, used: as of `is_filled`.
    """
    other, dx, dy = traits_of(world)[body].collider, x - ray.x, y - ray.y
    own = shapes.shape[0] - 1
    margin_x, margin_y = touch_margins(shapes, edges, own, other, ray.x, ray.y, x, y)
    tried, number = 0, 0
    while number >= 0:
        tried, number, beyond_x, beyond_y = next_side(
            shapes, edges, other, tried, dx, dy, margin_x, margin_y
        )
        if number >= 0 and is_filled(
            world, shapes, edges, mask, body, x + beyond_x, y + beyond_y, unboxed, used
        ):
            return 0.0, -edges[number].normal_x, -edges[number].normal_y
    vx, vy = -ray.way_x, -ray.way_y
    tried, number = 0, 0
    while number >= 0:
        tried, number, time, beyond_x, beyond_y = next_end(
            shapes, edges, own, other, tried, dx, dy, vx, vy, 1.0, margin_x, margin_y
        )
        if number < 0:
            break
        normal_x, normal_y = edges[number].normal_x, edges[number].normal_y
        # What does not sink in by more than rounding may hide runs along the face.
        way = normal_x * vx + normal_y * vy
        if way > margin_along(normal_x, normal_y, margin_x, margin_y) and is_filled(
            world, shapes, edges, mask, body, x + beyond_x, y + beyond_y, unboxed, used
        ):
            return time, -normal_x, -normal_y
    return NO_IMPACT
