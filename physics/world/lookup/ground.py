"""Which places bodies cover."""

from ...kernels import kernel
from ...pairs.seams import covers
from ...shapes.records import Edges, Shapes
from ..state.courses import place_at, shown_place, velocity_of
from ..state.records import TraitRecord
from ..state.view import (
    WorldView,
    boundless_of,
    boxes_of,
    edges_of,
    grid_of,
    header_of,
    heads_of,
    motions_of,
    moving_of,
    near_of,
    shapes_of,
    stack_of,
    static_nodes_of,
    static_tree_of,
    traits_of,
)
from .grid import bucket_of, cell_size, number_of
from .neighbours import interacts
from .tree import NO_ONE


@kernel
def is_ground(world: WorldView, own: TraitRecord, other: int, x: float, y: float) -> bool:
    """Return whether a ground goes on in another body, for a body with these traits.

    Args:
        world, own: see above.
        other: a body of the ground, without mass.
        x, y: a place, relative to it.
    """
    trait = traits_of(world)[other]
    if trait.slot < 0:
        return _is_static_at(world, own, other, trait.home_x + x, trait.home_y + y)
    motion = motions_of(world)[trait.slot]
    stands = motion.vx == 0.0 and motion.vy == 0.0
    if stands and _is_static_at(world, own, other, motion.x + x, motion.y + y):
        return True
    return _goes_along(world, own, other, x, y)


@kernel
def move_as_one(world: WorldView, a: int, b: int) -> bool:
    """Return whether two bodies have no mass, and one velocity: they may be one ground."""
    one, other = traits_of(world)[a], traits_of(world)[b]
    if one.inverse_mass > 0.0 or other.inverse_mass > 0.0:
        return False
    vx, vy = velocity_of(world, one.slot)
    their_vx, their_vy = velocity_of(world, other.slot)
    return bool(vx == their_vx and vy == their_vy)


@kernel
def _goes_along(world: WorldView, own: TraitRecord, other: int, x: float, y: float) -> bool:
    """Return whether a kinematic body that moves with another one covers a place beside it.

    It looks at all moving bodies: this is asked so seldom that it need not know where they are.
    """
    traits, motions, moving = traits_of(world), motions_of(world), moving_of(world)
    motion = motions[traits[other].slot]
    for slot in range(moving.shape[0]):
        body = moving[slot]
        trait = traits[body]
        if body == other or trait.sensor >= 0 or not move_as_one(world, other, body):
            continue
        their_x, their_y = place_at(motions[slot], motion.at, motion.at_low)
        away_x, away_y = x - (their_x - motion.x), y - (their_y - motion.y)
        if interacts(own, trait) and covers(
            shapes_of(world), edges_of(world), trait.collider, away_x, away_y
        ):
            return True
    return False


@kernel
def _is_static_at(world: WorldView, own: TraitRecord, other: int, x: float, y: float) -> bool:
    """Return whether a static body, other than one, covers a place for a body with its traits."""
    boundless = boundless_of(world)
    for index in range(boundless.shape[0]):
        if _stands_at(world, own, other, boundless[index], x, y):
            return True
    waiting = _begin_walk(world, 0)
    while waiting > 0:
        body, waiting = _next_leaf_at(world, x, y, 0, waiting)
        if body >= 0 and _stands_at(world, own, other, body, x, y):
            return True
    return False


@kernel
def _stands_at(
    world: WorldView, own: TraitRecord, other: int, body: int, x: float, y: float
) -> bool:
    """Return whether a body is static and solid, is not the other one, and covers a place."""
    trait = traits_of(world)[body]
    if body == other or trait.slot >= 0 or trait.sensor >= 0 or not interacts(own, trait):
        return False
    return covers(
        shapes_of(world), edges_of(world), trait.collider, x - trait.home_x, y - trait.home_y
    )


@kernel
def find_at(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    mask: int,
    other: int,
    x: float,
    y: float,
    unboxed: int,
    used: int,
) -> int:
    """Return a body, other than one, that covers a place between two steps; -1 if there is none.

    Args:
        world, shapes, edges: the world and its shapes.
        mask: the categories that count.
        other: see above.
        x, y: the place.
        unboxed: how many bodies the first ones in ``near`` are that no box finds.
        used: how much of the stack is in use.
    """
    near = near_of(world)
    for index in range(unboxed):
        if _is_at(world, shapes, edges, mask, other, near[index], x, y):
            return int(near[index])
    waiting = _begin_walk(world, used)
    while waiting > 0:
        body, waiting = _next_leaf_at(world, x, y, used, waiting)
        if body >= 0 and _is_at(world, shapes, edges, mask, other, body, x, y):
            return body
    if header_of(world).has_grid:
        for level in range(grid_of(world).lowest, grid_of(world).highest + 1):
            body = _find_on_level(world, shapes, edges, mask, other, x, y, level)
            if body >= 0:
                return body
    return NO_ONE


@kernel
def _find_on_level(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    mask: int,
    other: int,
    x: float,
    y: float,
    level: int,
) -> int:
    """Return a body on a level of the grid that covers a place, or -1; arguments as above."""
    boxes, heads, moving = boxes_of(world), heads_of(world), moving_of(world)
    size = cell_size(world, level)
    # The middle of a box with the place inside is at most half a cell away.
    left, right = number_of(x - 0.5 * size, size), number_of(x + 0.5 * size, size)
    low, high = number_of(y - 0.5 * size, size), number_of(y + 0.5 * size, size)
    for column in range(left, right + 1):
        for row in range(low, high + 1):
            slot = heads[bucket_of(level, column, row, heads.shape[0])]
            while slot != NO_ONE:
                if _is_at(world, shapes, edges, mask, other, moving[slot], x, y):
                    return int(moving[slot])
                slot = boxes[slot].next
    return NO_ONE


@kernel
def _is_at(
    world: WorldView,
    shapes: Shapes,
    edges: Edges,
    mask: int,
    other: int,
    body: int,
    x: float,
    y: float,
) -> bool:
    """Return whether a body is not the other one, counts, and covers a place."""
    trait = traits_of(world)[body]
    if body == other or (trait.category & mask) == 0:
        return False
    their_x, their_y = shown_place(world, trait)
    return covers(shapes, edges, trait.collider, x - their_x, y - their_y)


@kernel
def _begin_walk(world: WorldView, used: int) -> int:
    """Begin a walk to the static bodies at a place; return how many nodes are waiting.

    They are in the stack behind what is used of it.
    """
    if header_of(world).static_nodes == 0 or static_tree_of(world).root == NO_ONE:
        return 0
    stack_of(world)[used] = static_tree_of(world).root
    return 1


@kernel
def _next_leaf_at(world: WorldView, x: float, y: float, used: int, waiting: int) -> tuple[int, int]:
    """Return (body, waiting): the next static body with a place in its box, or -1."""
    nodes, stack = static_nodes_of(world), stack_of(world)
    while waiting > 0:
        waiting -= 1
        index = stack[used + waiting]
        node = nodes[index]
        if node.lower_x <= x <= node.upper_x and node.lower_y <= y <= node.upper_y:
            if node.left == NO_ONE:
                return index, waiting
            stack[used + waiting] = node.left
            stack[used + waiting + 1] = node.right
            waiting += 2
    return NO_ONE, 0
