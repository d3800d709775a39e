"""Questions to a world: which bodies overlap a shape, and which one it meets first."""

import math

from ..kernels import kernel
from ..pairs.table import impact_between, may_touch, overlap_between
from ..pairs.touching import touch_margins
from ..shapes.records import Edges, Shapes
from .records import Block, Indices, TraitRecord
from .view import WorldView, motions_of, open_world, traits_of


@kernel
def _position(world: WorldView, trait: TraitRecord) -> tuple[float, float]:
    """Return the position of a body between two steps."""
    if trait.slot < 0:
        return trait.home_x, trait.home_y
    motion = motions_of(world)[trait.slot]
    return motion.x, motion.y


@kernel
def find_overlapping(
    state: Block,
    workspace: Block,
    shapes: Shapes,
    edges: Edges,
    x: float,
    y: float,
    mask: int,
    found: Indices,
) -> int:
    """Write the bodies that overlap the last shape, at (x, y), into ``found``; return how many.

    Args:
        state, workspace: of the world.
        shapes, edges: the world's shapes, and one more at the end.
        x, y: position of the last shape.
        mask: the categories that count.
        found: int64 [bodies].
    """
    world = open_world(state, workspace)
    own = shapes.shape[0] - 1
    count = 0
    for body in range(traits_of(world).shape[0]):
        trait = traits_of(world)[body]
        if (trait.category & mask) == 0:
            continue
        their_x, their_y = _position(world, trait)
        dx, dy = their_x - x, their_y - y
        if not may_touch(shapes, own, trait.collider, dx, dy, 0.0, 0.0, 0.0):
            continue
        margin_x, margin_y = touch_margins(
            shapes, edges, own, trait.collider, x, y, their_x, their_y
        )
        if overlap_between(shapes, edges, own, trait.collider, dx, dy, margin_x, margin_y):
            found[count] = body
            count += 1
    return count


@kernel
def find_first(
    state: Block,
    workspace: Block,
    shapes: Shapes,
    edges: Edges,
    x: float,
    y: float,
    way_x: float,
    way_y: float,
    mask: int,
) -> tuple[int, float, float, float]:
    """Return (body, fraction, normal_x, normal_y) of the body that the last shape meets first.

    The shape moves from (x, y), fraction 0, by (way_x, way_y), fraction 1. The normal points to
    the body, which is -1 if it meets none. Arguments are as for `find_overlapping`.
    """
    world = open_world(state, workspace)
    own = shapes.shape[0] - 1
    first, best, normal_x, normal_y = -1, math.inf, 0.0, 0.0
    for body in range(traits_of(world).shape[0]):
        trait = traits_of(world)[body]
        if (trait.category & mask) == 0:
            continue
        their_x, their_y = _position(world, trait)
        dx, dy = their_x - x, their_y - y
        reach = min(best, 1.0)
        if not may_touch(shapes, own, trait.collider, dx, dy, -way_x, -way_y, reach):
            continue
        margin_x, margin_y = touch_margins(
            shapes, edges, own, trait.collider, x, y, their_x, their_y
        )
        time, out_x, out_y = impact_between(
            shapes,
            edges,
            own,
            trait.collider,
            dx,
            dy,
            -way_x,
            -way_y,
            reach,
            margin_x,
            margin_y,
        )
        if time < best:
            first, best, normal_x, normal_y = body, time, out_x, out_y
    return first, best, normal_x, normal_y
