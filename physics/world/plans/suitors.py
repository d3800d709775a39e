"""Who plans to meet whom: each moving body has a list of those that plan to meet it."""

from ...kernels import kernel
from ..lookup.tree import NO_ONE
from ..state.records import MEET, NOTHING
from ..state.view import WorldView, plans_of, stale_of, traits_of


@kernel
def join_suitors(world: WorldView, slot: int) -> None:
    """Put a body into the list of those that plan to meet its partner, if the partner moves."""
    plans = plans_of(world)
    plan = plans[slot]
    theirs = traits_of(world)[plan.partner].slot
    if theirs < 0:
        return
    partner = plans[theirs]
    plan.previous_suitor = NO_ONE
    plan.next_suitor = partner.suitor
    if partner.suitor != NO_ONE:
        plans[partner.suitor].previous_suitor = slot
    partner.suitor = slot


@kernel
def forget_partner(world: WorldView, slot: int) -> None:
    """Let a body plan nothing, and take it out of the list in which it is."""
    plans = plans_of(world)
    plan = plans[slot]
    if plan.kind == MEET:
        theirs = traits_of(world)[plan.partner].slot
        if theirs >= 0:
            if plan.next_suitor != NO_ONE:
                plans[plan.next_suitor].previous_suitor = plan.previous_suitor
            if plan.previous_suitor != NO_ONE:
                plans[plan.previous_suitor].next_suitor = plan.next_suitor
            else:
                plans[theirs].suitor = plan.next_suitor
    plan.kind = NOTHING


@kernel
def find_stale(world: WorldView, slot: int, count: int) -> int:
    """Append the bodies to ``stale`` that plan to meet one whose course has changed."""
    plans, stale = plans_of(world), stale_of(world)
    suitor = plans[slot].suitor
    while suitor != NO_ONE:
        stale[count] = suitor
        count += 1
        suitor = plans[suitor].next_suitor
    return count
