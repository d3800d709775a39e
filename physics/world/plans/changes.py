"""New plans for bodies that have met, and for those that had planned to meet them."""

from ...kernels import kernel
from ..lookup.boxes import fit_here, margin_after_hit
from ..state.view import WorldView, plans_of, stale_of, traits_of
from .prediction import predict
from .suitors import find_stale, forget_partner


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
