"""Questions to a world: who overlaps a shape, and what is met first on a straight way."""

import math
from typing import Any

from ..kernels import kernel
from ..pairs.table import impact_between, may_touch, overlap_between
from .memory import motions_of, open_world, traits_of


@kernel
def _position(world: Any, trait: Any) -> tuple[float, float]:
    """Return where a body is between two steps."""
    if trait.slot < 0:
        return trait.home_x, trait.home_y
    motion = motions_of(world)[trait.slot]
    return motion.x, motion.y


@kernel
def find_overlapping(
    state: Any,
    desk: Any,
    shapes: Any,
    edges: Any,
    x: float,
    y: float,
    mask: int,
    found: Any,
) -> int:
    """Write who overlaps the table's last shape at (x, y) into ``found``; return how many.

    Args:
        state, desk: uint8 [bytes], a world's.
        shapes, edges: the world's table with one more shape.
        mask: of the categories that count.
        found: int64 [bodies].
    """
    world = open_world(state, desk)
    own = shapes.shape[0] - 1
    count = 0
    for body in range(traits_of(world).shape[0]):
        trait = traits_of(world)[body]
        if (trait.category & mask) == 0:
            continue
        dx, dy = _position(world, trait)
        dx, dy = dx - x, dy - y
        if not may_touch(shapes, own, trait.collider, dx, dy, 0.0, 0.0, 0.0):
            continue
        if overlap_between(shapes, edges, own, trait.collider, dx, dy):
            found[count] = body
            count += 1
    return count


@kernel
def find_first(
    state: Any,
    desk: Any,
    shapes: Any,
    edges: Any,
    x: float,
    y: float,
    way_x: float,
    way_y: float,
    mask: int,
) -> tuple[int, float, float, float]:
    """Return (body, fraction, normal_x, normal_y) of what the table's last shape meets first.

    It starts at (x, y) and goes the whole way at fraction 1. The normal points to the body, which
    is -1 if there is none.
    """
    world = open_world(state, desk)
    own = shapes.shape[0] - 1
    first, best, normal_x, normal_y = -1, math.inf, 0.0, 0.0
    for body in range(traits_of(world).shape[0]):
        trait = traits_of(world)[body]
        if (trait.category & mask) == 0:
            continue
        dx, dy = _position(world, trait)
        dx, dy = dx - x, dy - y
        reach = min(best, 1.0)
        if not may_touch(shapes, own, trait.collider, dx, dy, -way_x, -way_y, reach):
            continue
        time, out_x, out_y = impact_between(
            shapes, edges, own, trait.collider, dx, dy, -way_x, -way_y, reach
        )
        if time < best:
            first, best, normal_x, normal_y = body, time, out_x, out_y
    return first, best, normal_x, normal_y
