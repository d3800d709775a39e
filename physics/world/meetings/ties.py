"""Which of two bodies is met, if a third one meets both at the same time, within rounding."""

from ...kernels import kernel
from ...pairs.touching_point import shared_stretch
from ...shapes.records import Edges, ShapeRecord
from ..state.courses import motion_at
from ..state.view import WorldView, edges_of, shapes_of, traits_of


@kernel
def _skewness(shape: ShapeRecord, edges: Edges, x: float, y: float) -> float:
    """Return the sine of the angle between the unit vector (x, y) and the nearest edge's normal."""
    least = 1.0
    for index in range(shape.first, shape.first + shape.count):
        edge = edges[index]
        least = min(least, abs(edge.normal_x * y - edge.normal_y * x))
    return least


@kernel
def _facing_length(
    world: WorldView,
    a: int,
    b: int,
    when: float,
    when_low: float,
    normal_x: float,
    normal_y: float,
) -> float:
    """Return along which length two bodies face each other at a time, when they meet."""
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    x, y, _, _ = motion_at(world, a, when, when_low)
    their_x, their_y, _, _ = motion_at(world, b, when, when_low)
    dx, dy = their_x - x, their_y - y
    one, other = traits[a].collider, traits[b].collider
    _, low, high = shared_stretch(shapes, edges, one, other, dx, dy, normal_x, normal_y)
    return high - low


@kernel
def is_straighter(
    world: WorldView,
    body: int,
    other: int,
    normal_x: float,
    normal_y: float,
    best: int,
    best_x: float,
    best_y: float,
    when: float,
    when_low: float,
) -> bool:
    """Return whether a body meets another one more along a face than a third one, the best so far.

    This decides between two bodies that are met at the same time, within rounding. A disc that
    lands on the seam of two boxes meets the face of one and not the corner of the other. A box that
    lands there meets the one on which it lies, and not the other's side.

    Args:
        world, body: the body.
        other, normal_x, normal_y: the other one, and the normal at which it is met.
        best, best_x, best_y: the third one, and its normal.
        when, when_low: the time.
    """
    shapes, edges, traits = shapes_of(world), edges_of(world), traits_of(world)
    rank = _skewness(shapes[traits[other].collider], edges, normal_x, normal_y)
    best_rank = _skewness(shapes[traits[best].collider], edges, best_x, best_y)
    if rank == best_rank:
        rank = -_facing_length(world, body, other, when, when_low, normal_x, normal_y)
        best_rank = -_facing_length(world, body, best, when, when_low, best_x, best_y)
    return bool(rank < best_rank or (rank == best_rank and other < best))
