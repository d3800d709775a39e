"""How far bodies have used up their hits of a step: so a step ends, whatever the numbers are."""

from ...kernels import kernel
from ...tolerances import HITS_FOR_NOTHING, LONGEST_SERIES, MOST_RESTS
from ..state.records import FREE, HELD, INERT
from ..state.view import (
    WorldView,
    clock_of,
    header_of,
    motions_of,
    plans_of,
    progress_of,
    traits_of,
)


@kernel
def stage_of(world: WorldView, slot: int) -> int:
    """Return how far a body has used up its hits of this step: FREE for a static one (-1)."""
    return FREE if slot < 0 else int(plans_of(world)[slot].stage)


@kernel
def inverse_mass_of(world: WorldView, body: int) -> float:
    """Return a body's inverse mass for hits: 0 also if it is held where it is."""
    trait = traits_of(world)[body]
    return 0.0 if stage_of(world, trait.slot) >= HELD else float(trait.inverse_mass)


@kernel
def has_reached(world: WorldView, a: int, b: int, stage: int) -> bool:
    """Return whether those of two bodies that have a mass have all reached a stage."""
    traits = traits_of(world)
    for body in (a, b):
        if traits[body].inverse_mass > 0.0 and stage_of(world, traits[body].slot) < stage:
            return False
    return True


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
    plan.series += 1
    if plan.series >= LONGEST_SERIES:
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
