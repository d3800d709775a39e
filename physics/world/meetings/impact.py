"""When two bodies of a world meet: as two shapes do, but for the seams of grounds.

A ground is of static bodies, or of kinematic ones that move with one velocity.
"""

import math

from ...kernels import kernel
from ...pairs.results import NO_IMPACT
from ...pairs.seams import lies_along, next_end
from ...pairs.table import impact_between, may_touch
from ..lookup.ground import is_ground
from ..state.view import WorldView, edges_of, shapes_of, traits_of


@kernel
def may_meet(
    world: WorldView, a: int, b: int, dx: float, dy: float, ux: float, uy: float, duration: float
) -> bool:
    """Return False only if `impact_of` finds no impact of the same bodies; at a low cost."""
    traits = traits_of(world)
    if may_touch(
        shapes_of(world), traits[a].collider, traits[b].collider, dx, dy, ux, uy, duration
    ):
        return True
    # A point on the border of two bodies touches both, whatever rounding says.
    return _may_have_seams(world, a, b) and (_is_point(world, a) or _is_point(world, b))


@kernel
def impact_of(
    world: WorldView,
    a: int,
    b: int,
    dx: float,
    dy: float,
    ux: float,
    uy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) of the impact of body a, which moves, and body b.

    Args:
        world: the world.
        a, b: the bodies; b is at (dx, dy) from a and moves with (ux, uy).
        duration, margin_x, margin_y: as of `impact_between`.
    """
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    one, other = traits[a].collider, traits[b].collider
    time, normal_x, normal_y = impact_between(
        shapes, edges, one, other, dx, dy, ux, uy, duration, margin_x, margin_y
    )
    if not _may_have_seams(world, a, b):
        return time, normal_x, normal_y
    if traits[a].inverse_mass > 0.0:
        return _on_ground(
            world, a, b, dx, dy, ux, uy, duration, margin_x, margin_y, time, normal_x, normal_y
        )
    time, normal_x, normal_y = _on_ground(
        world, b, a, -dx, -dy, -ux, -uy, duration, margin_x, margin_y, time, -normal_x, -normal_y
    )
    return time, -normal_x, -normal_y


@kernel
def _on_ground(
    world: WorldView,
    a: int,
    b: int,
    dx: float,
    dy: float,
    ux: float,
    uy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
    time: float,
    normal_x: float,
    normal_y: float,
) -> tuple[float, float, float]:
    """Return the impact of body a and body b, which has no mass, if they meet at a seam of b.

    Otherwise it is (time, normal_x, normal_y), as of two shapes; the other arguments are those of
    `impact_of`.
    """
    if time == math.inf:
        if not _is_point(world, a):
            return time, normal_x, normal_y
    elif lies_along(
        shapes_of(world), edges_of(world), traits_of(world)[b].collider, normal_x, normal_y
    ):
        return time, normal_x, normal_y
    at_seam, seam_x, seam_y = _meet_seam(world, a, b, dx, dy, ux, uy, duration, margin_x, margin_y)
    if at_seam < math.inf:
        return at_seam, seam_x, seam_y
    return time, normal_x, normal_y


@kernel
def _may_have_seams(world: WorldView, a: int, b: int) -> bool:
    """Return whether one of two bodies has no mass, and both are solid."""
    one, other = traits_of(world)[a], traits_of(world)[b]
    has_ground = one.inverse_mass == 0.0 or other.inverse_mass == 0.0
    return bool(has_ground and one.sensor < 0 and other.sensor < 0)


@kernel
def _is_point(world: WorldView, body: int) -> bool:
    """Return whether a body is a point."""
    shape = shapes_of(world)[traits_of(world)[body].collider]
    return bool(shape.count == 0 and shape.radius == 0.0)


@kernel
def _meet_seam(
    world: WorldView,
    a: int,
    b: int,
    dx: float,
    dy: float,
    ux: float,
    uy: float,
    duration: float,
    margin_x: float,
    margin_y: float,
) -> tuple[float, float, float]:
    """Return the impact of two bodies at a seam of b, or inf for the time if there is none there.

    The arguments are those of `impact_of`.
    """
    shapes, edges = shapes_of(world), edges_of(world)
    own, trait = traits_of(world)[a], traits_of(world)[b]
    one, other = own.collider, trait.collider
    tried, number = 0, 0
    while number >= 0:
        tried, number, time, x, y = next_end(
            shapes, edges, one, other, tried, dx, dy, ux, uy, duration, margin_x, margin_y
        )
        if number >= 0 and is_ground(world, own, b, x, y):
            return time, -edges[number].normal_x, -edges[number].normal_y
    return NO_IMPACT
