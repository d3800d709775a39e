"""The broad phase: the bodies that a moving body may meet before it leaves its box."""

from ...kernels import kernel
from ..records import Indices, TraitRecord
from ..view import (
    WorldView,
    boundless_of,
    boxes_of,
    header_of,
    moving_of,
    near_of,
    stack_of,
    static_nodes_of,
    static_tree_of,
    traits_of,
)
from .grid import find_in_grid
from .tree import find_leaves


@kernel
def interacts(one: TraitRecord, other: TraitRecord) -> bool:
    """Return whether two bodies may meet: their masks allow it, and one of them has a mass.

    A sensor meets every body that is no sensor, also one without a mass.
    """
    if (one.category & other.mask) == 0 or (other.category & one.mask) == 0:
        return False
    if one.sensor >= 0 or other.sensor >= 0:
        return bool(one.sensor < 0 or other.sensor < 0)
    return bool(one.inverse_mass + other.inverse_mass > 0.0)


@kernel
def find_near(world: WorldView, slot: int, only_later: bool) -> int:
    """Write the bodies that a moving body may meet into ``near``; return how many.

    Static bodies and those without bounds come first, in order; the order of the others depends on
    history.

    Args:
        world, slot: the moving body.
        only_later: of the moving bodies, write only those with later slots, so that going through
            all slots gives every pair once.
    """
    moving, near, traits = moving_of(world), near_of(world), traits_of(world)
    trait, box = traits[moving[slot]], boxes_of(world)[slot]
    least = slot + 1 if only_later else 0
    count = _append_boundless(world, trait, slot, least)
    if header_of(world).static_nodes > 0:
        first = count
        found = find_leaves(
            static_tree_of(world), static_nodes_of(world), box, stack_of(world), near, count
        )
        for index in range(first, found):
            near[count] = near[index]
            count += interacts(trait, traits[near[index]])
    sort_items(near, count)
    if header_of(world).has_grid:
        first = count
        found = find_in_grid(world, box, near, count)
        for index in range(first, found):
            other = near[index]
            if other >= least and other != slot:
                near[count] = moving[other]
                count += interacts(trait, traits[moving[other]])
    else:
        for other in range(least, moving.shape[0]):
            if other != slot:
                near[count] = moving[other]
                count += interacts(trait, traits[moving[other]])
    return count


@kernel
def _append_boundless(world: WorldView, trait: TraitRecord, slot: int, least: int) -> int:
    """Append bodies without bounds; return how many there are."""
    traits, boundless, near = traits_of(world), boundless_of(world), near_of(world)
    has_grid = header_of(world).has_grid
    count = 0
    for index in range(boundless.shape[0]):
        theirs = traits[boundless[index]].slot
        # Without a grid of moving bodies, all of them are tested anyway.
        if theirs < 0 or (has_grid and theirs >= least and theirs != slot):
            near[count] = boundless[index]
            count += interacts(trait, traits[boundless[index]])
    return count


@kernel
def sort_items(items: Indices, count: int) -> None:
    """Sort the first items (Shell's sort)."""
    gap = 1
    while gap < count // 3:
        gap = 3 * gap + 1
    while gap > 0:
        for index in range(gap, count):
            item = items[index]
            place = index
            while place >= gap and items[place - gap] > item:
                items[place] = items[place - gap]
                place -= gap
            items[place] = item
        gap //= 3
