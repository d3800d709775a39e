"""Plans that rely on a third body: the part of a moving ground beside the one that is met."""

from ...kernels import kernel
from ..lookup.neighbours import find_near
from ..state.clock_time import elapsed
from ..state.courses import place_at
from ..state.records import MEET
from ..state.view import (
    WorldView,
    motions_of,
    moving_of,
    near_of,
    plans_of,
    stale_of,
    traits_of,
)
from .prediction import comes_close, predict


@kernel
def is_kinematic(world: WorldView, slot: int) -> bool:
    """Return whether a moving body is solid, and has no mass."""
    trait = traits_of(world)[moving_of(world)[slot]]
    return bool(trait.inverse_mass == 0.0 and trait.sensor < 0)


@kernel
def find_on_grounds(world: WorldView, count: int) -> int:
    """Append the bodies to ``stale`` that plan to meet a kinematic body, or are one that does.

    Another one, which was fresh or has gone, may have been the ground beside it. Those are left out
    that are fresh, or plan to meet a fresh body: they plan anew anyway.
    """
    plans, motions, stale = plans_of(world), motions_of(world), stale_of(world)
    for slot in range(plans.shape[0]):
        if plans[slot].kind != MEET or motions[slot].fresh:
            continue
        theirs = traits_of(world)[plans[slot].partner].slot
        if theirs < 0 or motions[theirs].fresh:
            continue
        if is_kinematic(world, slot) or is_kinematic(world, theirs):
            stale[count] = slot
            count += 1
    return count


@kernel
def plan_beside(world: WorldView, slot: int, now: float, now_low: float) -> None:
    """Let those plan anew that may come to a fresh kinematic body before they do what they plan.

    They may meet the ground beside it, which goes on in it.
    """
    plans, motions, near, stale = (
        plans_of(world),
        motions_of(world),
        near_of(world),
        stale_of(world),
    )
    x, y = place_at(motions[slot], now, now_low)
    count = 0
    for index in range(find_near(world, slot, False)):
        trait = traits_of(world)[near[index]]
        if trait.slot < 0 or trait.sensor >= 0 or motions[trait.slot].fresh:
            continue
        plan = plans[trait.slot]
        left = elapsed(plan.time, plan.time_low, now, now_low)
        if comes_close(world, slot, trait, x, y, now, now_low, left):
            stale[count] = trait.slot
            count += 1
    for index in range(count):
        predict(world, stale[index], now, now_low, False)
