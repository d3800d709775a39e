"""What happens, written down: the events that users get, each of two bodies."""

from ...kernels import kernel
from ...pairs.touching_point import touching_point
from ..lookup.inside import has_free_pair
from ..state.courses import motion_at
from ..state.records import Hits
from ..state.view import (
    WorldView,
    edges_of,
    entries_of,
    inside_of,
    progress_of,
    shapes_of,
    traits_of,
)


@kernel
def has_room(world: WorldView, hits: Hits, count: int) -> bool:
    """Return whether there is room for all that one event may cause; note it if not."""
    # A hit, and all that is inside sensors may leave; or one more is inside.
    if hits.shape[0] - count > inside_of(world).count and has_free_pair(world):
        return True
    progress_of(world).full = 1
    return False


@kernel
def write_event(
    world: WorldView,
    hits: Hits,
    count: int,
    world_index: int,
    kind: int,
    time: float,
    a: int,
    b: int,
    normal_x: float,
    normal_y: float,
    point_x: float,
    point_y: float,
    impulse: float,
) -> int:
    """Write an event of two bodies; return how many events there are now."""
    if a > b:
        a, b, normal_x, normal_y = b, a, -normal_x, -normal_y
    hit, entries = hits[count], entries_of(world)
    hit.world = world_index
    hit.kind = kind
    hit.time = time
    hit.a = entries[a].handle
    hit.b = entries[b].handle
    # The sum turns -0 into 0: no bit tells which of the two was first.
    hit.normal[0] = normal_x + 0.0
    hit.normal[1] = normal_y + 0.0
    hit.point[0] = point_x
    hit.point[1] = point_y
    hit.impulse = impulse
    return count + 1


@kernel
def contact_point(
    world: WorldView, a: int, b: int, now: float, now_low: float, normal_x: float, normal_y: float
) -> tuple[float, float]:
    """Return the point at which two bodies touch along the normal from a to b."""
    if a > b:
        a, b, normal_x, normal_y = b, a, -normal_x, -normal_y
    ax, ay, _, _ = motion_at(world, a, now, now_low)
    bx, by, _, _ = motion_at(world, b, now, now_low)
    x, y = touching_point(
        shapes_of(world),
        edges_of(world),
        traits_of(world)[a].collider,
        traits_of(world)[b].collider,
        bx - ax,
        by - ay,
        normal_x,
        normal_y,
    )
    return ax + x, ay + y
