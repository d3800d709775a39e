"""The bodies that a ray, or a disc that is cast along it, may meet: cell by cell, box by box.

The cells of the grid are walked through in the order in which the ray meets them (Amanatides and
Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, Eurographics 1987), until a body is met
before the next ones. A body's box may reach out of its cell, and so the cells beside the ray count.
"""

import math

from ...kernels import kernel
from ...shapes.records import ShapeRecord
from ..lookup.grid import bucket_of, cell_size, number_of
from ..lookup.tree import NO_ONE
from ..state.records import BoxRecord, Indices, RayRecord
from ..state.view import (
    WorldView,
    boxes_of,
    header_of,
    heads_of,
    level_counts_of,
    plans_of,
    stack_of,
    static_nodes_of,
    static_tree_of,
)

# What a ray passes at so small a fraction of all numbers is looked at, because of rounding.
SPARE = 1e-9


@kernel
def entry(ray: RayRecord, box: BoxRecord) -> float:
    """Return the fraction of a ray at which it enters a box (or a node), inf if it does not.

    It is not after what the ray has met so far. It is never too late, in spite of rounding.
    """
    return _entry(ray, box.lower_x, box.lower_y, box.upper_x, box.upper_y)


@kernel
def passes_close(ray: RayRecord, shape: ShapeRecord, x: float, y: float) -> bool:
    """Return whether a ray enters or grazes the bounding box of a shape at (x, y)."""
    first = _entry(ray, x + shape.lower_x, y + shape.lower_y, x + shape.upper_x, y + shape.upper_y)
    return first < math.inf


@kernel
def _entry(ray: RayRecord, lower_x: float, lower_y: float, upper_x: float, upper_y: float) -> float:
    """Return what `entry` does, of a box that is given by its sides."""
    room = ray.room + SPARE * (abs(lower_x) + abs(lower_y))
    first_x, last_x = _passage(ray.x, ray.way_x, lower_x - room, upper_x + room)
    first_y, last_y = _passage(ray.y, ray.way_y, lower_y - room, upper_y + room)
    first = max(0.0, max(first_x, first_y))
    last = min(limit(ray), min(last_x, last_y))
    return first if first <= last else math.inf


@kernel
def limit(ray: RayRecord) -> float:
    """Return the fraction of a ray after which nothing counts."""
    return float(min(1.0, ray.fraction)) * (1.0 + SPARE)


@kernel
def last_of(ray: RayRecord, margin_x: float, margin_y: float) -> float:
    """Return the fraction at which a ray ends for a body: what it touches at its end, it meets.

    The margins are as of `touching`: rounding may hide such a gap.
    """
    length = abs(ray.way_x) + abs(ray.way_y)
    return 1.0 + (margin_x + margin_y) / length if length > 0.0 else 1.0


@kernel
def _passage(start: float, way: float, lower: float, upper: float) -> tuple[float, float]:
    """Return the fractions of a way at which it enters and leaves an interval."""
    if way > 0.0:
        return (lower - start) / way, (upper - start) / way
    if way < 0.0:
        return (upper - start) / way, (lower - start) / way
    if lower <= start <= upper:
        return -math.inf, math.inf
    return math.inf, -math.inf


@kernel
def begin_tree_walk(world: WorldView) -> int:
    """Begin a walk through the tree of static bodies; return how many nodes are waiting."""
    if header_of(world).static_nodes == 0 or static_tree_of(world).root == NO_ONE:
        return 0
    stack_of(world)[0] = static_tree_of(world).root
    return 1


@kernel
def next_leaf(world: WorldView, ray: RayRecord, waiting: int) -> tuple[int, int]:
    """Return (body, waiting): the next static body that a ray may meet, or -1; near ones first."""
    nodes, stack = static_nodes_of(world), stack_of(world)
    while waiting > 0:
        waiting -= 1
        index = stack[waiting]
        node = nodes[index]
        # It was met, but the ray may have met something before it since then.
        if ray.fraction < math.inf and _node_entry(ray, node) == math.inf:
            continue
        if node.left == NO_ONE:
            return index, waiting
        first, second = _node_entry(ray, nodes[node.left]), _node_entry(ray, nodes[node.right])
        is_left_first = first <= second
        stack[waiting] = node.right if is_left_first else node.left
        waiting += max(first, second) < math.inf
        stack[waiting] = node.left if is_left_first else node.right
        waiting += min(first, second) < math.inf
    return NO_ONE, 0


@kernel
def _node_entry(ray: RayRecord, node: BoxRecord) -> float:
    """Return what `entry` does, of a node of the tree: without branches, and without divisions."""
    room = ray.room + SPARE * (abs(node.lower_x) + abs(node.lower_y))
    one_x = (node.lower_x - room - ray.x) * ray.inverse_x
    other_x = (node.upper_x + room - ray.x) * ray.inverse_x
    one_y = (node.lower_y - room - ray.y) * ray.inverse_y
    other_y = (node.upper_y + room - ray.y) * ray.inverse_y
    first = max(0.0, max(min(one_x, other_x), min(one_y, other_y)))
    last = min(limit(ray), min(max(one_x, other_x), max(one_y, other_y)))
    return first if first <= last else math.inf


@kernel
def begin_level_walk(world: WorldView, ray: RayRecord, level: int) -> int:
    """Return how many strips of cells of a level a ray meets; -1: more cells than bodies."""
    size = cell_size(world, level)
    if level_counts_of(world)[level] == 0:
        return 0
    reach = _reach(ray, size)
    strips = (max(abs(ray.way_x), abs(ray.way_y)) + 2.0 * reach) / size + 2.0
    width = (2.0 * size + 4.0 * reach) / size + 2.0
    if not strips * width <= max(16.0, plans_of(world).shape[0]):
        return -1
    first, last, _ = _strips(ray, size)
    return last - first + 1


@kernel
def _reach(ray: RayRecord, size: float) -> float:
    """Return how far from a ray the middle of a box may be that it meets, in cells of a size."""
    return float((0.5 * size) * (1.0 + SPARE) + ray.room)


@kernel
def _strips(ray: RayRecord, size: float) -> tuple[int, int, bool]:
    """Return the first and the last strip of cells of a size, and whether they are columns."""
    reach = _reach(ray, size)
    is_flat = abs(ray.way_x) >= abs(ray.way_y)
    start, way = (ray.x, ray.way_x) if is_flat else (ray.y, ray.way_y)
    first = number_of(min(start, start + way) - reach, size)
    return first, number_of(max(start, start + way) + reach, size), is_flat


@kernel
def find_in_strip(
    world: WorldView, ray: RayRecord, level: int, index: int, found: Indices
) -> tuple[int, bool]:
    """Write the slots into ``found`` that a ray may meet in one of its strips of cells.

    Args:
        world, ray, level: see above.
        index: of the strip, in the order in which the ray meets them; -1: all bodies of the level.
        found: int64 [movers].

    Returns:
        (count, is_over): whether what the ray has met so far is before this strip.
    """
    boxes = boxes_of(world)
    count = 0
    if index < 0:
        for slot in range(boxes.shape[0]):
            if plans_of(world)[slot].is_linked and boxes[slot].level == level:
                found[count] = slot
                count += entry(ray, boxes[slot]) < math.inf
        return count, False
    size = cell_size(world, level)
    reach = _reach(ray, size)
    first, last, is_flat = _strips(ray, size)
    way = ray.way_x if is_flat else ray.way_y
    strip = first + index if way >= 0.0 else last - index
    begin, end = 0.0, 1.0
    if size < math.inf:
        begin, end = _passage(
            ray.x if is_flat else ray.y, way, strip * size - reach, (strip + 1) * size + reach
        )
        begin, end = max(0.0, begin), min(1.0, end)
    if begin > limit(ray):
        return 0, True
    if begin > end:
        return 0, False
    start, across = (ray.y, ray.way_y) if is_flat else (ray.x, ray.way_x)
    one, other = start + across * begin, start + across * end
    low = number_of(min(one, other) - reach, size)
    high = number_of(max(one, other) + reach, size)
    heads = heads_of(world)
    for cell in range(low, high + 1):
        column, row = (strip, cell) if is_flat else (cell, strip)
        slot = heads[bucket_of(level, column, row, heads.shape[0])]
        while slot != NO_ONE:
            box = boxes[slot]
            if box.column == column and box.row == row and box.level == level:
                found[count] = slot
                count += entry(ray, box) < math.inf
            slot = box.next
    return count, False
