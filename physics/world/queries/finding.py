"""Questions to a world: which bodies overlap a shape, and which one it meets first."""

import math

from ...kernels import inlined, kernel
from ...kernels.borrowed import borrowed
from ...pairs.results import NO_IMPACT
from ...pairs.seams import lies_along
from ...pairs.table import impact_between, may_touch, overlap_between
from ...pairs.touching import margin_along, touch_margins
from ...shapes.records import Edge, Edges, Shape, Shapes
from ..lookup.boxes import fit_shown, is_astray
from ..lookup.grid import find_in_grid
from ..lookup.neighbours import sort_items
from ..lookup.tree import find_leaves
from ..state.courses import shown_place
from ..state.records import Block, Indices, Ray, RayRecord
from ..state.view import (
    WorldView,
    boundless_of,
    entries_of,
    found_of,
    grid_of,
    header_of,
    moving_of,
    near_of,
    open_world,
    stack_of,
    static_nodes_of,
    static_tree_of,
    traits_of,
)
from .borders import meet_border
from .rays import begin_level_walk, begin_tree_walk, find_in_strip, last_of, next_leaf, passes_close

SHAPE_SIZE, EDGE_SIZE, RAY_SIZE = Shape.itemsize, Edge.itemsize, Ray.itemsize


@kernel
def _write_unboxed(world: WorldView, found: Indices) -> int:
    """Write the bodies into ``found`` that neither the tree nor the grid finds; return how many."""
    boundless, moving, traits = boundless_of(world), moving_of(world), traits_of(world)
    count = 0
    for index in range(boundless.shape[0]):
        found[count] = boundless[index]
        count += 1
    has_grid = header_of(world).has_grid
    for slot in range(moving.shape[0]):
        if not traits[moving[slot]].boundless and not (has_grid and not is_astray(world, slot)):
            found[count] = moving[slot]
            count += 1
    return count


@kernel
def find_overlapping(
    state: Block,
    workspace: Block,
    shape_block: Block,
    edge_block: Block,
    x: float,
    y: float,
    mask: int,
    found: Indices,
) -> int:
    """Write the handles of the bodies into ``found`` that overlap the last shape; return how many.

    Args:
        state, workspace: of the world.
        shape_block, edge_block: the world's shapes, and one more at the end: uint8 [bytes], which
            Python passes in half the time.
        x, y: position of the last shape.
        mask: the categories that count.
        found: int64 [bodies].
    """
    world = open_world(state, state, workspace)
    shapes = borrowed(shape_block, 0, shape_block.shape[0] // SHAPE_SIZE, Shape)
    edges = borrowed(edge_block, 0, edge_block.shape[0] // EDGE_SIZE, Edge)
    fit_shown(world)
    traits, moving = traits_of(world), moving_of(world)
    own = shapes.shape[0] - 1
    shape = shapes[own]
    lower_x, upper_x = x + shape.lower_x, x + shape.upper_x
    lower_y, upper_y = y + shape.lower_y, y + shape.upper_y
    last = _write_unboxed(world, found)
    if header_of(world).static_nodes > 0:
        tree, nodes, stack = static_tree_of(world), static_nodes_of(world), stack_of(world)
        last = find_leaves(tree, nodes, lower_x, lower_y, upper_x, upper_y, stack, found, last)
    if header_of(world).has_grid:
        around = found_of(world)
        for index in range(find_in_grid(world, lower_x, lower_y, upper_x, upper_y, around, 0)):
            if not is_astray(world, around[index]):
                found[last] = moving[around[index]]
                last += 1
    sort_items(found, last)
    count = 0
    for index in range(last):
        body = found[index]
        trait = traits[body]
        if (trait.category & mask) == 0:
            continue
        their_x, their_y = shown_place(world, trait)
        dx, dy = their_x - x, their_y - y
        if not may_touch(shapes, own, trait.collider, dx, dy, 0.0, 0.0, 0.0):
            continue
        margin_x, margin_y = touch_margins(
            shapes, edges, own, trait.collider, x, y, their_x, their_y
        )
        if overlap_between(shapes, edges, own, trait.collider, dx, dy, margin_x, margin_y):
            found[count] = entries_of(world)[body].handle
            count += 1
    return count


@kernel
def find_first(
    state: Block,
    workspace: Block,
    shape_block: Block,
    edge_block: Block,
    ray_block: Block,
    mask: int,
) -> None:
    """Write into each ray which body the last shape meets first that moves along it, if any.

    Of two bodies that are met at the same time it is the one with the lower index. Arguments are as
    for `find_overlapping`, and ``ray_block`` holds the `Ray` records, uint8 [bytes].
    """
    world = open_world(state, state, workspace)
    shapes = borrowed(shape_block, 0, shape_block.shape[0] // SHAPE_SIZE, Shape)
    edges = borrowed(edge_block, 0, edge_block.shape[0] // EDGE_SIZE, Edge)
    rays = borrowed(ray_block, 0, ray_block.shape[0] // RAY_SIZE, Ray)
    fit_shown(world)
    unboxed = near_of(world)
    count = _write_unboxed(world, unboxed)
    for index in range(rays.shape[0]):
        ray = rays[index]
        ray.body = -1
        ray.fraction = math.inf
        for number in range(count):
            _try(world, shapes, edges, ray, mask, unboxed[number], count, 0)
        waiting = begin_tree_walk(world)
        while waiting > 0:
            body, waiting = next_leaf(world, ray, waiting)
            if body >= 0:
                _try(world, shapes, edges, ray, mask, body, count, waiting)
        if header_of(world).has_grid:
            for level in range(grid_of(world).lowest, grid_of(world).highest + 1):
                _try_level(world, shapes, edges, ray, mask, level, count)
        if ray.body >= 0:
            ray.body = entries_of(world)[ray.body].handle


@kernel
def _try_level(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    ray: RayRecord,
    mask: int,
    level: int,
    unboxed: int,
) -> None:
    """Let a ray meet the moving bodies on a level of the grid."""
    found, moving = found_of(world), moving_of(world)
    strips = begin_level_walk(world, ray, level)
    for strip in range(min(strips, 0), max(strips, 0)):
        count, is_over = find_in_strip(world, ray, level, strip, found)
        if is_over:
            break
        for index in range(count):
            if not is_astray(world, found[index]):
                _try(world, shapes, edges, ray, mask, moving[found[index]], unboxed, 0)


@kernel
def _try(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    ray: RayRecord,
    mask: int,
    body: int,
    unboxed: int,
    used: int,
) -> None:
    """Let a ray meet a body, if it does so before all others.

    ``unboxed`` and ``used`` are as of `find_at`.
    """
    trait = traits_of(world)[body]
    if (trait.category & mask) == 0:
        return
    x, y = shown_place(world, trait)
    shape = shapes[trait.collider]
    time, normal_x, normal_y = _meet(shapes, edges, ray, trait.collider, x, y)
    is_side = time < math.inf and lies_along(shapes, edges, trait.collider, normal_x, normal_y)
    may_graze = ray.room == 0.0 and shape.count > 0
    if may_graze and not is_side and passes_close(ray, shape, x, y):
        at_border, border_x, border_y = meet_border(
            world, shapes, edges, ray, mask, body, unboxed, used, time < math.inf
        )
        if at_border < math.inf:
            time, normal_x, normal_y = at_border, border_x, border_y
    if time < ray.fraction or (time == ray.fraction and time < math.inf and body < ray.body):
        ray.body, ray.fraction = body, time
        ray.normal_x, ray.normal_y = normal_x, normal_y


@inlined
def _meet(
    shapes: Shapes, edges: Edges, ray: RayRecord, other: int, x: float, y: float
) -> tuple[float, float, float]:
    """Return the impact (time, normal_x, normal_y) of a ray and a shape at (x, y).

    It is that of the whole way, not of what is left of it: so the order of bodies has no influence.
    """
    own, dx, dy, vx, vy = shapes.shape[0] - 1, x - ray.x, y - ray.y, -ray.way_x, -ray.way_y
    if not passes_close(ray, shapes[other], x, y):
        return NO_IMPACT
    margin_x, margin_y = touch_margins(shapes, edges, own, other, ray.x, ray.y, x, y)
    time, normal_x, normal_y = impact_between(
        shapes,
        edges,
        own,
        other,
        dx,
        dy,
        vx,
        vy,
        last_of(ray, margin_x, margin_y),
        margin_x,
        margin_y,
    )
    if 1.0 < time < math.inf:
        time = 1.0
    sinks = -(vx * normal_x + vy * normal_y) > margin_along(normal_x, normal_y, margin_x, margin_y)
    if sinks or (
        time == 0.0 and overlap_between(shapes, edges, own, other, dx, dy, margin_x, margin_y)
    ):
        return time, normal_x, normal_y
    # What does not sink in by more than rounding may hide runs along a side.
    return NO_IMPACT
