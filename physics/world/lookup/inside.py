"""Which bodies are inside which sensors: one list per body, as long as what is inside.

The lists are in a block of their own, which grows with what is inside: an `Inside` record, where
the list of each body begins, and the `Pair` records of all lists, with a list of unused ones. Each
list is in the order of the sensors, so that it never depends on history.
"""

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from ...kernels import kernel
from ..records import Blocks, Inside, Pair
from ..view import WorldView, first_inside_of, header_of, inside_of, pairs_of
from .tree import NO_ONE

FEW_PAIRS = 8


@kernel
def find_inside(world: WorldView, sensor: int, body: int) -> int:
    """Return the place of a pair of a sensor and a body inside it; -1 if the body is outside."""
    pairs = pairs_of(world)
    place = first_inside_of(world)[body]
    while place != NO_ONE:
        if pairs[place].sensor >= sensor:
            break
        place = pairs[place].next
    if place != NO_ONE and pairs[place].sensor != sensor:
        return NO_ONE
    return int(place)


@kernel
def put_inside(world: WorldView, sensor: int, body: int) -> None:
    """Note that a body is inside a sensor; there is room for it."""
    inside, firsts, pairs = inside_of(world), first_inside_of(world), pairs_of(world)
    previous, following = NO_ONE, firsts[body]
    while following != NO_ONE:
        if pairs[following].sensor >= sensor:
            break
        previous, following = following, pairs[following].next
    if following != NO_ONE and pairs[following].sensor == sensor:
        return
    place = inside.free
    inside.free = pairs[place].next
    inside.count += 1
    pairs[place].sensor = sensor
    pairs[place].body = body
    pairs[place].next = following
    if previous == NO_ONE:
        firsts[body] = place
    else:
        pairs[previous].next = place


@kernel
def take_outside(world: WorldView, sensor: int, body: int) -> None:
    """Note that a body is no longer inside a sensor."""
    inside, firsts, pairs = inside_of(world), first_inside_of(world), pairs_of(world)
    place = find_inside(world, sensor, body)
    if place == NO_ONE:
        return
    if firsts[body] == place:
        firsts[body] = pairs[place].next
    else:
        previous = firsts[body]
        while pairs[previous].next != place:
            previous = pairs[previous].next
        pairs[previous].next = pairs[place].next
    pairs[place].sensor = NO_ONE
    pairs[place].next = inside.free
    inside.free = place
    inside.count -= 1


@kernel
def has_free_pair(world: WorldView) -> bool:
    """Return whether there is room for another pair, or there are no sensors."""
    return bool(header_of(world).sensors == 0 or inside_of(world).free != NO_ONE)


def inside_blocks(
    worlds: Iterable[npt.NDArray[np.int64]], bodies: int, has_sensors: bool
) -> npt.NDArray[np.uint8]:
    """Return the blocks of some worlds, uint8 [worlds, bytes].

    Args:
        worlds: int64 [pairs, 2] of each, sensor and body, sorted by body and sensor.
        bodies: how many there are.
        has_sensors: if not, the blocks are as good as empty.
    """
    lists = list(worlds)
    most = max(map(len, lists), default=0)
    room = FEW_PAIRS + 2 * most if has_sensors else 0
    heads = bodies if has_sensors else 0
    size = Inside.itemsize + 8 * heads + Pair.itemsize * room
    blocks = np.zeros((len(lists), size), np.uint8)
    for block, own in zip(blocks, lists, strict=True):
        inside = block[: Inside.itemsize].view(Inside)
        firsts = block[Inside.itemsize : Inside.itemsize + 8 * heads].view(np.int64)
        pairs = block[Inside.itemsize + 8 * heads :].view(Pair)
        firsts[:] = NO_ONE
        pairs["sensor"] = NO_ONE
        pairs["next"] = np.arange(1, room + 1)
        pairs["next"][-1:] = NO_ONE
        inside["count"], inside["free"] = len(own), len(own) if has_sensors else NO_ONE
        inside["room"] = room
        if not len(own):
            continue
        number = len(own)
        pairs["sensor"][:number], pairs["body"][:number] = own.T
        is_last = np.append(own[1:, 1] != own[:-1, 1], True)
        pairs["next"][:number][is_last] = NO_ONE
        is_first = np.insert(own[1:, 1] != own[:-1, 1], 0, True)
        firsts[own[is_first, 1]] = np.flatnonzero(is_first)
    return blocks


def pairs_inside(blocks: Blocks) -> list[npt.NDArray[np.int64]]:
    """Return the pairs of some worlds' blocks, int64 [pairs, 2], sorted by body and sensor."""
    lists = []
    for block in blocks:
        room = int(block[: Inside.itemsize].view(Inside)["room"][0])
        pairs = block[len(block) - Pair.itemsize * room :].view(Pair)
        pairs = pairs[pairs["sensor"] != NO_ONE]
        pairs = pairs[np.lexsort((pairs["sensor"], pairs["body"]))]
        lists.append(np.column_stack([pairs["sensor"], pairs["body"]]))
    return lists
