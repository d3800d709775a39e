"""Whether two bodies that touch and approach hit each other, or rest or slide on each other."""

from ...kernels import kernel
from ...tolerances import MOST_RESTS, NO_APPROACH, SLIDE
from ..state.records import CRUSHED
from ..state.view import WorldView, motions_of, plans_of, progress_of, traits_of
from .stages import has_reached


@kernel
def slowest_hit(world: WorldView, a: int, b: int) -> float:
    """Return the speed of approach that rounding could make of the speeds of two bodies so far."""
    speed = 0.0
    for body in (a, b):
        slot = traits_of(world)[body].slot
        if slot >= 0:
            speed += motions_of(world)[slot].speed
    return NO_APPROACH * speed


@kernel
def passes_by(world: WorldView, a: int, b: int, closing: float) -> bool:
    """Return whether two solid bodies that touch and approach do not hit each other.

    They rest if they approach more slowly than rounding can tell. They slide by if they have come
    to rest again and again, and are slow. And what has no room moves into what presses it, until
    the step ends.

    Args:
        world, a, b: the bodies.
        closing: the speed at which they approach, along the normal.
    """
    least = slowest_hit(world, a, b)
    if closing <= least:
        return True
    if not progress_of(world).inert:
        return False
    if has_reached(world, a, b, CRUSHED):
        return True
    return bool(closing <= SLIDE / NO_APPROACH * least and _are_sliding(world, a, b))


@kernel
def _are_sliding(world: WorldView, a: int, b: int) -> bool:
    """Return whether those of two bodies that have a mass have come to rest again and again."""
    traits = traits_of(world)
    for body in (a, b):
        slot = traits[body].slot
        if traits[body].inverse_mass > 0.0 and plans_of(world)[slot].rests < MOST_RESTS:
            return False
    return True
