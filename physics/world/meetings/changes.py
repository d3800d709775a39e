"""New plans for bodies that have met, and for those that had planned to meet them."""

from ...kernels import kernel
from ...tolerances import HITS_FOR_NOTHING, MOST_AT_ONCE, MOST_RESTS
from ..lookup.boxes import fit_here, margin_after_hit
from ..prediction import find_stale, forget_partner, predict
from ..records import FREE, HELD, INERT
from ..view import (
    WorldView,
    clock_of,
    header_of,
    motions_of,
    plans_of,
    progress_of,
    stale_of,
    traits_of,
)


@kernel
def count_hit(world: WorldView, slot: int, is_short: bool) -> None:
    """Count a hit of a body; after `max_hits` it is inert, after as many again it is held.

    Some hits count for several: those that go nowhere, those of a body that bounces no more, and
    those that the world can no longer afford, since it has had `max_hits` in this step.

    Args:
        world, slot: the body.
        is_short: nobody has gone far to this hit, see `is_short_way`.
    """
    plan, progress, max_hits = plans_of(world)[slot], progress_of(world), header_of(world).max_hits
    plan.instant += 1
    if plan.instant >= MOST_AT_ONCE:
        progress.inert = 1
    progress.hits += 1
    is_one = plan.stage == FREE and not is_short and progress.hits <= max_hits
    # With a low limit, it does not end the next stages at once.
    plan.hits += 1 if is_one else min(HITS_FOR_NOTHING, 1 + max_hits // 100)
    if plan.hits >= max_hits and plan.stage < HELD:
        reach_stage(world, slot, INERT if plan.stage == FREE else HELD)


@kernel
def count_rest(world: WorldView, slot: int) -> None:
    """Count that a body came to rest on something; after some times it slides, see `is_sliding`."""
    plan = plans_of(world)[slot]
    plan.rests += 1
    if plan.rests >= MOST_RESTS:
        progress_of(world).inert = 1


@kernel
def reach_stage(world: WorldView, slot: int, stage: int) -> None:
    """Let a body reach a later stage of this step."""
    plan = plans_of(world)[slot]
    if plan.stage == FREE:
        clock_of(world).capped += 1
        progress_of(world).inert = 1
    plan.stage = stage
    plan.hits = 0
    if stage == HELD:
        motions_of(world)[slot].vx = 0.0
        motions_of(world)[slot].vy = 0.0


@kernel
def plan_after_hit(world: WorldView, a: int, b: int, now: float, now_low: float) -> None:
    """Make new plans for two bodies that have bounced, and for all that planned to meet them."""
    traits = traits_of(world)
    for body in (a, b):
        if traits[body].slot >= 0:
            forget_partner(world, traits[body].slot)  # each would be planned for twice
    count = 0
    for body in (a, b):
        # A body of infinite mass keeps its course: plans to meet it still hold.
        if traits[body].inverse_mass > 0.0:
            count = find_stale(world, traits[body].slot, count)
            shrink_box(world, traits[body].slot, now, now_low)
    for body in (a, b):
        if traits[body].slot >= 0:
            predict(world, traits[body].slot, now, now_low, False)
    predict_stale(world, count, now, now_low)


@kernel
def shrink_box(world: WorldView, slot: int, now: float, now_low: float) -> None:
    """Let a body that was hit have a smaller box, if it is in a crowd."""
    margin = margin_after_hit(world, slot)
    if margin < plans_of(world)[slot].margin:
        fit_here(world, slot, now, now_low, margin)


@kernel
def predict_stale(world: WorldView, count: int, now: float, now_low: float) -> None:
    """Make new plans for the first bodies in ``stale``."""
    for index in range(count):
        predict(world, stale_of(world)[index], now, now_low, False)
