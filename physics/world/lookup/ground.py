"""Which places the static bodies cover."""

from ...kernels import kernel
from ...pairs.seams import covers
from ..records import TraitRecord
from ..view import (
    WorldView,
    boundless_of,
    edges_of,
    header_of,
    shapes_of,
    stack_of,
    static_nodes_of,
    static_tree_of,
    traits_of,
)
from .neighbours import interacts
from .tree import NO_ONE


@kernel
def is_ground(world: WorldView, own: TraitRecord, other: int, x: float, y: float) -> bool:
    """Return whether a static body, other than one, covers a place for a body with its traits."""
    boundless = boundless_of(world)
    for index in range(boundless.shape[0]):
        if _stands_at(world, own, other, boundless[index], x, y):
            return True
    if header_of(world).static_nodes == 0 or static_tree_of(world).root == NO_ONE:
        return False
    nodes, stack = static_nodes_of(world), stack_of(world)
    stack[0] = static_tree_of(world).root
    waiting = 1
    while waiting > 0:
        waiting -= 1
        index = stack[waiting]
        node = nodes[index]
        if node.lower_x <= x <= node.upper_x and node.lower_y <= y <= node.upper_y:
            if node.left == NO_ONE:
                if _stands_at(world, own, other, index, x, y):
                    return True
            else:
                stack[waiting] = node.left
                stack[waiting + 1] = node.right
                waiting += 2
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
