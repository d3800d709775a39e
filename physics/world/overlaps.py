"""Bodies that overlap: relaxation as a step begins, and the lecture's procedure for a whole step.

The lecture on collisions in games has three parts: detection, relaxation, bounce.
"""

from ..kernels import kernel
from ..pairs.response import shares
from ..pairs.results import NO_CONTACT
from ..pairs.table import contact_between
from ..pairs.touching import touch_margins
from ..tolerances import RELAX_ROUNDS
from .events import enter_sensor, has_room, write_event
from .grid import enter_all, find_near
from .impacts import bounce_pair
from .prediction import is_inside, motion_at
from .records import HIT, Hits
from .view import (
    WorldView,
    clock_of,
    edges_of,
    motions_of,
    moving_of,
    near_of,
    plans_of,
    progress_of,
    shapes_of,
    traits_of,
)


@kernel
def relax_overlaps(world: WorldView) -> bool:
    """Move overlapping bodies apart, pair by pair; return whether anything moved.

    Moving one pair apart may push it into others. So this repeats until no pair overlaps, or, where
    there is not enough room for all, for a limited number of rounds. The overlaps that remain are
    noted in the progress as crowded, and the next step continues with them.
    """
    has_moved = False
    for _ in range(RELAX_ROUNDS):
        is_done = True
        for slot in range(plans_of(world).shape[0]):
            body = moving_of(world)[slot]
            for index in range(find_near(world, slot, True)):
                other = near_of(world)[index]
                found, normal_x, normal_y, depth, _, _ = _solid_contact(world, body, other)
                if found:
                    _move_apart(world, body, other, normal_x, normal_y, depth)
                    is_done = False
        if is_done:
            return has_moved
        has_moved = True
        enter_all(world)
    progress_of(world).crowded = 1
    return has_moved


@kernel
def _solid_contact(
    world: WorldView, a: int, b: int
) -> tuple[bool, float, float, float, float, float]:
    """Return (found, normal_x, normal_y, depth, x, y) of two bodies, if neither is a sensor."""
    one = traits_of(world)[a]
    other = traits_of(world)[b]
    if one.sensor >= 0 or other.sensor >= 0:
        return NO_CONTACT
    return _contact_at(world, a, b, clock_of(world).time, clock_of(world).time_low)


@kernel
def _contact_at(
    world: WorldView, a: int, b: int, now: float, now_low: float
) -> tuple[bool, float, float, float, float, float]:
    """Return the contact of two bodies at a time, with the point in the world's coordinates."""
    ax, ay, _, _ = motion_at(world, a, now, now_low)
    bx, by, _, _ = motion_at(world, b, now, now_low)
    shapes, edges = shapes_of(world), edges_of(world)
    first, second = traits_of(world)[a].collider, traits_of(world)[b].collider
    margin_x, margin_y = touch_margins(shapes, edges, first, second, ax, ay, bx, by)
    found, normal_x, normal_y, depth, x, y = contact_between(
        shapes, edges, first, second, bx - ax, by - ay, margin_x, margin_y
    )
    return found, normal_x, normal_y, depth, ax + x, ay + y


@kernel
def _move_apart(
    world: WorldView, a: int, b: int, normal_x: float, normal_y: float, depth: float
) -> None:
    """Move two bodies apart along the normal from a to b, in shares reciprocal to mass."""
    one = traits_of(world)[a]
    other = traits_of(world)[b]
    share_a, share_b = shares(one.inverse_mass, other.inverse_mass)
    if share_a > 0.0:
        motion = motions_of(world)[one.slot]
        motion.x -= depth * share_a * normal_x
        motion.y -= depth * share_a * normal_y
    if share_b > 0.0:
        motion = motions_of(world)[other.slot]
        motion.x += depth * share_b * normal_x
        motion.y += depth * share_b * normal_y


@kernel
def resolve_overlaps(world: WorldView, hits: Hits, count: int, world_index: int) -> int:
    """After all bodies have moved, detect, relax and bounce pair by pair; return the hits.

    This is the lecture's procedure. It has no times of impact, so that a fast body may pass through
    a thin one. It stops early if there is no room for more hits, and can be called again.
    """
    progress = progress_of(world)
    while progress.next_slot < plans_of(world).shape[0]:
        body = moving_of(world)[progress.next_slot]
        near = find_near(world, progress.next_slot, True)
        while progress.next_near < near:
            if not has_room(world, hits, count):
                return count
            other = near_of(world)[progress.next_near]
            count = _resolve_pair(world, hits, count, world_index, body, other)
            progress.next_near += 1
        progress.next_near = 0
        progress.next_slot += 1
    return count


@kernel
def _resolve_pair(
    world: WorldView, hits: Hits, count: int, world_index: int, a: int, b: int
) -> int:
    """Relax and bounce two bodies if they overlap; return how many hits there are."""
    one, other = traits_of(world)[a], traits_of(world)[b]
    now, now_low = progress_of(world).end, progress_of(world).end_low
    found, normal_x, normal_y, depth, x, y = _contact_at(world, a, b, now, now_low)
    if not found:
        return count
    if one.sensor >= 0 or other.sensor >= 0:
        if is_inside(world, one, a, other, b):
            return count
        return enter_sensor(world, hits, count, world_index, a, b, now, now_low, normal_x, normal_y)
    _move_apart(world, a, b, normal_x, normal_y, depth)
    impulse = bounce_pair(world, a, b, normal_x, normal_y)
    return write_event(
        world, hits, count, world_index, HIT, now, a, b, normal_x, normal_y, x, y, impulse
    )
