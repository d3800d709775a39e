"""Which bodies are inside which sensors: one list per body and per sensor.

The lists are in a block of their own, which grows with what is inside: an `Inside` record, where
the list of each body or sensor begins, and the `Pair` records of all lists, with a list of unused
ones. A body's list is in the order of the sensors, so that it never depends on history. A sensor's
list is in no order: it only serves to find whom a sensor contains when it is taken away.
"""

import numpy as np
import numpy.typing as npt

from ...kernels import kernel
from ..state.records import Block, Inside, Pair
from ..state.view import WorldView, first_inside_of, header_of, inside_of, pairs_of
from .tree import NO_ONE

FEW_PAIRS = 8  # that there is room for at first


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
    pairs[place].moved = 0
    pairs[place].previous_guest = NO_ONE
    pairs[place].next_guest = firsts[sensor]
    if firsts[sensor] != NO_ONE:
        pairs[firsts[sensor]].previous_guest = place
    firsts[sensor] = place
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
    following, previous = pairs[place].next_guest, pairs[place].previous_guest
    if following != NO_ONE:
        pairs[following].previous_guest = previous
    if previous != NO_ONE:
        pairs[previous].next_guest = following
    else:
        firsts[sensor] = following
    pairs[place].sensor = NO_ONE
    pairs[place].next = inside.free
    inside.free = place
    inside.count -= 1


@kernel
def has_free_pair(world: WorldView) -> bool:
    """Return whether there is room for another pair, or there are no sensors."""
    return bool(header_of(world).sensors == 0 or inside_of(world).free != NO_ONE)


def inside_block(own: npt.NDArray[np.int64], heads: int, spare: int) -> npt.NDArray[np.uint8]:
    """Return the block of a world, uint8 [bytes].

    Args:
        own: int64 [pairs, 3]: sensor, body, and whether one of them was moved; sorted by body and
            sensor.
        heads: bodies that there is room for, or 0 if there was never a sensor.
        spare: how many more pairs there is room for.
    """
    number = len(own)
    room = number + spare if heads else 0
    block = np.zeros(Inside.itemsize + 8 * heads + Pair.itemsize * room, np.uint8)
    inside = block[: Inside.itemsize].view(Inside)
    firsts = block[Inside.itemsize : Inside.itemsize + 8 * heads].view(np.int64)
    pairs = block[Inside.itemsize + 8 * heads :].view(Pair)
    firsts[:] = NO_ONE
    pairs["sensor"] = NO_ONE
    pairs["next"] = np.arange(1, room + 1)
    pairs["next"][-1:] = NO_ONE
    inside["count"], inside["room"] = number, room
    inside["free"] = number if number < room else NO_ONE
    if number:
        used = pairs[:number]
        used["sensor"], used["body"], used["moved"] = own.T
        places = np.arange(number)
        firsts[own[::-1, 1]] = places[::-1]
        is_last = np.append(own[1:, 1] != own[:-1, 1], True)
        used["next"] = np.where(is_last, NO_ONE, places + 1)
        by_sensor = np.argsort(own[:, 0], kind="stable")
        firsts[own[by_sensor[::-1], 0]] = by_sensor[::-1]
        ends = np.diff(own[by_sensor, 0]) != 0
        used["next_guest"][by_sensor] = np.append(np.where(ends, NO_ONE, by_sensor[1:]), NO_ONE)
        used["previous_guest"][by_sensor] = np.insert(
            np.where(ends, NO_ONE, by_sensor[:-1]), 0, NO_ONE
        )
    return block


def pairs_inside(block: Block) -> npt.NDArray[np.int64]:
    """Return the pairs of a world's block, as `inside_block` takes them."""
    room = int(block[: Inside.itemsize].view(Inside)["room"][0])
    pairs = block[len(block) - Pair.itemsize * room :].view(Pair)
    pairs = pairs[pairs["sensor"] != NO_ONE]
    pairs = pairs[np.lexsort((pairs["sensor"], pairs["body"]))]
    return np.column_stack([pairs["sensor"], pairs["body"], pairs["moved"]])
