"""The order of a group: by its bodies, so that no bit depends on who planned what before."""

from ...kernels import kernel
from ..lookup.neighbours import sort_items
from ..state.progress import TouchRecord
from ..state.view import (
    WorldView,
    members_of,
    places_of,
    progress_of,
    stale_of,
    touches_of,
    traits_of,
)
from .touches import add_member, list_touch


@kernel
def sort_group(world: WorldView) -> None:
    """Sort the members of a group that has not been resolved yet, and their touches."""
    _sort_members(world)
    _sort_touches(world)
    traits, places, touches = traits_of(world), places_of(world), touches_of(world)
    for index in range(progress_of(world).touches):
        touch = touches[index]
        touch.one = places[traits[touch.a].slot] - 1
        if touch.other >= 0:
            touch.other = places[traits[touch.b].slot] - 1
        list_touch(world, index)


@kernel
def _sort_members(world: WorldView) -> None:
    """Let the members join again, in the order of their bodies."""
    progress, members, bodies = progress_of(world), members_of(world), stale_of(world)
    traits, count = traits_of(world), progress.members
    for index in range(count):
        body = members[index].body
        bodies[index] = 2 * body + members[index].due
        places_of(world)[traits[body].slot] = 0
    sort_items(bodies, count)
    progress.members = 0
    for index in range(count):
        member = members[add_member(world, traits[bodies[index] // 2].slot)]
        member.due = bodies[index] % 2
        # All have been tested with the velocities that they have.
        member.seen = 1
        member.seen_vx, member.seen_vy = member.vx, member.vy


@kernel
def _sort_touches(world: WorldView) -> None:
    """Sort the touches by their bodies (Shell's sort); the last record is spare."""
    touches, count = touches_of(world), progress_of(world).touches
    spare = touches.shape[0] - 1
    gap = 1
    while gap < count // 3:
        gap = 3 * gap + 1
    while gap > 0:
        for index in range(gap, count):
            touches[spare] = touches[index]
            place = index
            while place >= gap and _is_before(touches[spare], touches[place - gap]):
                touches[place] = touches[place - gap]
                place -= gap
            touches[place] = touches[spare]
        gap //= 3


@kernel
def _is_before(one: TouchRecord, other: TouchRecord) -> bool:
    """Return whether a touch comes before another one."""
    low, other_low = min(one.a, one.b), min(other.a, other.b)
    if low != other_low:
        return bool(low < other_low)
    return bool(max(one.a, one.b) < max(other.a, other.b))
