"""The list of bodies that each moving body may meet before it leaves its box.

A body is planned for several times before it leaves its box, and looking bodies up costs more than
testing them. So each has a list of those whose boxes touch its own. (Verlet, Computer "Experiments"
on Classical Fluids, Phys. Rev. 159, 1967.) First come the *fixed* ones, in order: static bodies and
those without bounds. Then come moving ones. Of two of these, each is on the other's list, and so
both lists change when one of the two gets another box. A body that may meet too many for its list
is looked up each time.
"""

import math

from ...kernels import kernel
from ..state.view import (
    LINKS,
    WorldView,
    boxes_of,
    found_of,
    header_of,
    links_of,
    moving_of,
    plans_of,
    traits_of,
)
from .grid import enter_grid, find_in_grid, leave_grid, touch
from .neighbours import TOO_MANY, find_fixed, interacts


@kernel
def move_box(
    world: WorldView, slot: int, lower_x: float, lower_y: float, upper_x: float, upper_y: float
) -> None:
    """Give a moving body another box: in the grid, and in all lists."""
    plan, box = plans_of(world)[slot], boxes_of(world)[slot]
    was_linked = plan.is_linked
    if was_linked:
        _unlink(world, slot, lower_x, lower_y, upper_x, upper_y)
        leave_grid(world, slot)
    old_x, old_y, old_upper_x, old_upper_y = box.lower_x, box.lower_y, box.upper_x, box.upper_y
    box.lower_x, box.lower_y, box.upper_x, box.upper_y = lower_x, lower_y, upper_x, upper_y
    _list_fixed(world, slot)
    if not header_of(world).has_grid or traits_of(world)[moving_of(world)[slot]].boundless:
        return
    _link(world, slot, was_linked, old_x, old_y, old_upper_x, old_upper_y)
    plan.is_linked = 1
    enter_grid(world, slot)


@kernel
def leave_lists(world: WorldView, slot: int) -> None:
    """Take a moving body out of the grid, and from all lists."""
    plan = plans_of(world)[slot]
    if plan.is_linked:
        _unlink(world, slot, math.inf, math.inf, -math.inf, -math.inf)  # a box that touches none
        leave_grid(world, slot)
        plan.is_linked = 0
    plan.near = TOO_MANY
    plan.margin = -1.0  # it is in no box


@kernel
def _list_fixed(world: WorldView, slot: int) -> None:
    """Begin a body's list with the fixed bodies that it may meet."""
    plan, links, found = plans_of(world)[slot], links_of(world), found_of(world)
    body = moving_of(world)[slot]
    plan.near = TOO_MANY
    if traits_of(world)[body].boundless:
        return
    count = find_fixed(world, slot, found)
    if count > LINKS:
        return
    for index in range(count):
        links[slot * LINKS + index] = found[index]
    plan.fixed = count
    plan.near = count


@kernel
def _link(
    world: WorldView,
    slot: int,
    was_linked: bool,
    lower_x: float,
    lower_y: float,
    upper_x: float,
    upper_y: float,
) -> None:
    """Write the moving bodies around a body's box on its list, and the body on theirs.

    Those that its last box (lower_x, ...) touched have it on their lists already.
    """
    traits, moving, found, boxes = (
        traits_of(world),
        moving_of(world),
        found_of(world),
        boxes_of(world),
    )
    body = moving[slot]
    trait = traits[body]
    for index in range(_around(world, slot)):
        other = found[index]
        if not interacts(trait, traits[moving[other]]):
            continue
        _append(world, slot, moving[other])
        if not (was_linked and touch(boxes[other], lower_x, lower_y, upper_x, upper_y)):
            _append(world, other, body)


@kernel
def _around(world: WorldView, slot: int) -> int:
    """Write the slots into ``found`` whose boxes touch a body's; return how many."""
    box = boxes_of(world)[slot]
    return find_in_grid(
        world, box.lower_x, box.lower_y, box.upper_x, box.upper_y, found_of(world), 0
    )


@kernel
def _append(world: WorldView, slot: int, body: int) -> None:
    """Write a body on the list of another one, if that has a list."""
    plan = plans_of(world)[slot]
    if plan.near == TOO_MANY:
        return
    if plan.near == LINKS:
        plan.near = TOO_MANY
        return
    links_of(world)[slot * LINKS + plan.near] = body
    plan.near += 1


@kernel
def _unlink(
    world: WorldView, slot: int, lower_x: float, lower_y: float, upper_x: float, upper_y: float
) -> None:
    """Take a body from the lists of those that its next box (lower_x, ...) does not touch."""
    plan, boxes, links = plans_of(world)[slot], boxes_of(world), links_of(world)
    traits, found = traits_of(world), found_of(world)
    body = moving_of(world)[slot]
    if plan.near != TOO_MANY:
        for index in range(slot * LINKS + plan.fixed, slot * LINKS + plan.near):
            other = traits[links[index]].slot
            if not touch(boxes[other], lower_x, lower_y, upper_x, upper_y):
                _take(world, other, body)
        return
    for index in range(_around(world, slot)):
        other = found[index]
        if other != slot and not touch(boxes[other], lower_x, lower_y, upper_x, upper_y):
            _take(world, other, body)


@kernel
def _take(world: WorldView, slot: int, body: int) -> None:
    """Take a body from the list of another one, if it is there."""
    plan, links = plans_of(world)[slot], links_of(world)
    first = slot * LINKS
    for index in range(first + plan.fixed, first + plan.near):
        if links[index] == body:
            plan.near -= 1
            links[index] = links[first + plan.near]
            break
