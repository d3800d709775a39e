"""Bodies that are no longer inside a sensor because one of the two was taken away, or changed."""

from ...kernels import kernel
from ..lookup.inside import take_outside
from ..lookup.neighbours import interacts
from ..lookup.tree import NO_ONE
from ..meetings.events import write_event
from ..state.records import END, FRESH, Hits
from ..state.view import WorldView, clock_of, first_inside_of, header_of, pairs_of, traits_of
from .slots import place_of


@kernel
def end_pairs(world: WorldView, body: int, is_gone: bool, ends: Hits, count: int) -> int:
    """End the pairs of a body and a sensor, in either order, that are no longer.

    It returns how many events there are.

    Args:
        world, body: the body, or the sensor.
        is_gone: all its pairs end; else only those that do not notice each other any more.
        ends: an `END` of each is written here.
        count: of the events that are there already.
    """
    if header_of(world).sensors == 0:
        return count
    pairs, now = pairs_of(world), clock_of(world).time
    place = first_inside_of(world)[body]
    while place != NO_ONE:
        sensor, guest = pairs[place].sensor, pairs[place].body
        place = pairs[place].next if guest == body else pairs[place].next_guest
        if is_gone or not _notices(world, sensor, guest):
            take_outside(world, sensor, guest)
            x, y, _, _ = place_of(world, guest)
            count = write_event(world, ends, count, 0, END, now, sensor, guest, 0.0, 0.0, x, y, 0.0)
    return count


@kernel
def _notices(world: WorldView, sensor: int, guest: int) -> bool:
    """Return whether a sensor notices a body: one of the two moves, and their masks allow it."""
    one, other = traits_of(world)[sensor], traits_of(world)[guest]
    return interacts(one, other) and (one.slot != NO_ONE or other.slot != NO_ONE)


@kernel
def note_moved(world: WorldView, body: int) -> None:
    """Note that a body without a plan was placed elsewhere: the next step asks whom it contains."""
    clock_of(world).fresh = max(clock_of(world).fresh, FRESH)
    if header_of(world).sensors == 0:
        return
    pairs = pairs_of(world)
    place = first_inside_of(world)[body]
    while place != NO_ONE:
        pairs[place].moved = 1
        place = pairs[place].next if pairs[place].body == body else pairs[place].next_guest
