"""Bodies that leave the broad phase and enter it, and who around them has to look again."""

import math

from ...kernels import kernel
from ..groups.touches import clear_group
from ..lookup.boxes import enter_static
from ..lookup.grid import find_in_grid
from ..lookup.links import leave_lists
from ..lookup.neighbours import interacts
from ..lookup.tree import NO_ONE, remove_leaf
from ..plans.prediction import plan_all
from ..plans.suitors import forget_partner
from ..plans.tournament import replay
from ..state.records import (
    FRESH,
    GROUND_GONE,
    MEET,
    PLANNED,
    UNPLANNED,
)
from ..state.view import (
    WorldView,
    boundless_of,
    clock_of,
    found_of,
    grid_of,
    header_of,
    motions_of,
    moving_of,
    plans_of,
    static_nodes_of,
    static_tree_of,
    traits_of,
    winners_of,
)


@kernel
def make_ready(world: WorldView) -> None:
    """Let plans and boxes hold as an edit begins, so that it can find who is around a body.

    They only have to be made after a restore, or if there was no more room. In a new world all
    bodies are fresh, and nobody has to be found.
    """
    clear_group(world)
    if header_of(world).continuous and clock_of(world).planned == UNPLANNED:
        plan_all(world)
        clock_of(world).planned = PLANNED
    if not is_planned(world):
        grid_of(world).ready = 0  # Nobody keeps it up to date.


@kernel
def is_planned(world: WorldView) -> bool:
    """Return whether there are plans and boxes that an edit has to keep up to date."""
    return bool(header_of(world).continuous and clock_of(world).planned == PLANNED)


@kernel
def freshen(world: WorldView, slot: int) -> None:
    """Let a moving body plan again in the next step, which also relaxes its overlaps."""
    motions_of(world)[slot].fresh = 1
    clock_of(world).fresh = max(clock_of(world).fresh, FRESH)


@kernel
def take_out(world: WorldView, body: int) -> None:
    """Take a body out of the broad phase. Those that may meet it look again."""
    trait = traits_of(world)[body]
    if trait.boundless:
        _forget_boundless(world, body)
    if trait.slot == NO_ONE:
        _stir(world, body)
        if not trait.boundless:
            remove_leaf(static_tree_of(world), static_nodes_of(world), body)
        return
    freshen(world, trait.slot)
    if trait.inverse_mass == 0.0 and trait.sensor < 0:
        clock_of(world).fresh = GROUND_GONE
    if not is_planned(world):
        return
    if trait.boundless:
        _stir(world, body)
    plans = plans_of(world)
    suitor = plans[trait.slot].suitor
    while suitor != NO_ONE:
        following = plans[suitor].next_suitor
        # Its plan ends here: the body that it names may be another one by the next step.
        _plan_nothing(world, suitor)
        suitor = following
    _plan_nothing(world, trait.slot)
    leave_lists(world, trait.slot)


@kernel
def _plan_nothing(world: WorldView, slot: int) -> None:
    """Let a moving body have no plan until the next step."""
    plans = plans_of(world)
    forget_partner(world, slot)
    plans[slot].time = math.inf
    plans[slot].time_low = 0.0
    plans[slot].tied = 0
    replay(winners_of(world), plans, slot)
    freshen(world, slot)


@kernel
def put_in(world: WorldView, body: int) -> None:
    """Put a body into the broad phase. Those that may meet it look again."""
    trait = traits_of(world)[body]
    if trait.boundless:
        header_of(world).boundless += 1
        boundless = boundless_of(world)
        boundless[boundless.shape[0] - 1] = body
    if trait.slot == NO_ONE:
        if not trait.boundless:
            enter_static(world, body)
        _stir(world, body)
        return
    # Its box is made as the next step begins. Then it looks around itself, too.
    freshen(world, trait.slot)
    if trait.boundless:
        _stir(world, body)


@kernel
def _forget_boundless(world: WorldView, body: int) -> None:
    """Take a body from the list of those without bounds."""
    boundless = boundless_of(world)
    last = boundless.shape[0] - 1
    for index in range(last):
        if boundless[index] == body:
            boundless[index] = boundless[last]
            break
    header_of(world).boundless = last


@kernel
def _stir(world: WorldView, body: int) -> None:
    """Let all look again that may meet a body before they leave their boxes.

    The body is static or without bounds. What is without bounds may meet everybody.
    """
    if not is_planned(world):
        return
    if traits_of(world)[body].boundless or not header_of(world).has_grid:
        for slot in range(moving_of(world).shape[0]):
            _stir_one(world, body, slot)
        return
    boundless, found, traits = boundless_of(world), found_of(world), traits_of(world)
    for index in range(boundless.shape[0]):
        if traits[boundless[index]].slot != NO_ONE:
            _stir_one(world, body, traits[boundless[index]].slot)
    node = static_nodes_of(world)[body]
    count = find_in_grid(world, node.lower_x, node.lower_y, node.upper_x, node.upper_y, found, 0)
    for index in range(count):
        _stir_one(world, body, found[index])


@kernel
def _stir_one(world: WorldView, body: int, slot: int) -> None:
    """Let a moving body look again if it may meet another one."""
    traits = traits_of(world)
    if slot == traits[body].slot or not interacts(traits[body], traits[moving_of(world)[slot]]):
        return
    plan = plans_of(world)[slot]
    if plan.kind == MEET and plan.partner == body:
        _plan_nothing(world, slot)
    freshen(world, slot)
