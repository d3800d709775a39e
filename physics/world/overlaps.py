"""Relaxation in a world: bodies that overlap as a step begins are moved apart."""

from typing import Any

from ..kernels import kernel
from ..pairs.response import shares
from ..pairs.table import contact_between
from ..tolerances import NO_DEPTH, RELAX_ROUNDS
from .grid import enter_all, find_near
from .memory import (
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
from .prediction import place


@kernel
def solid_contact(world: Any, a: int, b: int) -> tuple[bool, float, float, float, float, float]:
    """Return the contact of two bodies (found, normal, depth, point), if neither is a sensor."""
    one = traits_of(world)[a]
    other = traits_of(world)[b]
    if one.sensor >= 0 or other.sensor >= 0:
        return False, 0.0, 0.0, 0.0, 0.0, 0.0
    clock = clock_of(world)
    ax, ay, _, _ = place(world, a, clock.time, clock.time_low)
    bx, by, _, _ = place(world, b, clock.time, clock.time_low)
    found, normal_x, normal_y, depth, x, y = contact_between(
        shapes_of(world), edges_of(world), one.collider, other.collider, bx - ax, by - ay
    )
    return found, normal_x, normal_y, depth, ax + x, ay + y


@kernel
def move_apart(world: Any, a: int, b: int, normal_x: float, normal_y: float, depth: float) -> None:
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
def relax_overlaps(world: Any) -> bool:
    """Move apart, pair by pair, what overlaps; return whether anything moved.

    Moving one pair apart may push it into others: so it goes round until nothing overlaps, or, if
    there is not enough room for all, for a number of rounds. What is left is noted as crowded, and
    pushed on in the next step.
    """
    has_moved = False
    for _ in range(RELAX_ROUNDS):
        is_done = True
        for slot in range(plans_of(world).shape[0]):
            body = moving_of(world)[slot]
            for index in range(find_near(world, slot, True)):
                other = near_of(world)[index]
                found, normal_x, normal_y, depth, x, y = solid_contact(world, body, other)
                if found and depth > NO_DEPTH * (abs(x) + abs(y) + depth):
                    move_apart(world, body, other, normal_x, normal_y, depth)
                    is_done = False
        if is_done:
            return has_moved
        has_moved = True
        enter_all(world)
    progress_of(world).crowded = 1
    return has_moved
