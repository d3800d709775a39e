"""The broad phase: the bodies that a moving body may meet before it leaves its box."""

from ...kernels import kernel
from ..state.records import Indices, TraitRecord
from ..state.view import (
    LINKS,
    WorldView,
    boundless_of,
    boxes_of,
    header_of,
    links_of,
    moving_of,
    near_of,
    plans_of,
    stack_of,
    static_nodes_of,
    static_tree_of,
    traits_of,
)
from .grid import find_in_grid
from .tree import find_leaves

TOO_MANY = -1  # instead of the length of a list, see `links`


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
def has_list(world: WorldView, slot: int) -> bool:
    """Return whether a body's list has all that it may meet before it leaves its box."""
    header = header_of(world)
    # Without a grid, moving bodies are on no list.
    return bool((header.has_grid or header.movers == 1) and plans_of(world)[slot].near != TOO_MANY)


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
    plan, links, near, traits = (
        plans_of(world)[slot],
        links_of(world),
        near_of(world),
        traits_of(world),
    )
    if plan.near == TOO_MANY:
        return _look_up(world, slot, only_later)
    least = slot + 1 if only_later else 0
    count = 0
    for index in range(slot * LINKS, slot * LINKS + plan.near):
        near[count] = links[index]
        theirs = traits[near[count]].slot
        count += theirs < 0 or theirs >= least
    if not header_of(world).has_grid:
        count = _append_moving(world, slot, least, count)
    return count


@kernel
def _look_up(world: WorldView, slot: int, only_later: bool) -> int:
    """Do the same for a body without a list."""
    moving, near, traits = moving_of(world), near_of(world), traits_of(world)
    trait = traits[moving[slot]]
    least = slot + 1 if only_later else 0
    count = find_fixed(world, slot, near)
    if only_later:
        first, count = count, 0
        for index in range(first):
            theirs = traits[near[index]].slot
            near[count] = near[index]
            count += theirs < 0 or theirs >= least
    if not header_of(world).has_grid or trait.boundless:
        return _append_moving(world, slot, least, count)
    first, box = count, boxes_of(world)[slot]
    found = find_in_grid(world, box.lower_x, box.lower_y, box.upper_x, box.upper_y, near, count)
    for index in range(first, found):
        other = near[index]
        if other >= least and other != slot:
            near[count] = moving[other]
            count += interacts(trait, traits[moving[other]])
    return count


@kernel
def _append_moving(world: WorldView, slot: int, least: int, count: int) -> int:
    """Append all moving bodies from slot ``least`` on that a body may meet; return the count.

    With a grid, those without bounds are there already.
    """
    moving, near, traits = moving_of(world), near_of(world), traits_of(world)
    trait = traits[moving[slot]]
    has_grid = header_of(world).has_grid
    for other in range(least, moving.shape[0]):
        theirs = traits[moving[other]]
        if other != slot and not (has_grid and theirs.boundless):
            near[count] = moving[other]
            count += interacts(trait, theirs)
    return count


@kernel
def find_fixed(world: WorldView, slot: int, found: Indices) -> int:
    """Write those fixed bodies into ``found`` that a moving body may meet; return how many.

    These are the static bodies and, if there is a grid of moving ones, those that it does not have
    because they are without bounds. They are in order.
    """
    traits, boundless = traits_of(world), boundless_of(world)
    trait = traits[moving_of(world)[slot]]
    has_grid = header_of(world).has_grid
    count = 0
    for index in range(boundless.shape[0]):
        theirs = traits[boundless[index]].slot
        # Without a grid, all moving bodies are tested anyway.
        if theirs < 0 or (has_grid and theirs != slot):
            found[count] = boundless[index]
            count += interacts(trait, traits[boundless[index]])
    if header_of(world).static_nodes > 0:
        first = count
        box = boxes_of(world)[slot]
        last = find_leaves(
            static_tree_of(world),
            static_nodes_of(world),
            box.lower_x,
            box.lower_y,
            box.upper_x,
            box.upper_y,
            stack_of(world),
            found,
            count,
        )
        for index in range(first, last):
            found[count] = found[index]
            count += interacts(trait, traits[found[count]])
    sort_items(found, count)
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
