"""Which of many plans comes first: a knock-out tournament, of which a change replays one path.

The *seats* are a binary tree in an array. Its second half are the leaves: the slots in order, or
-1, and when their plans are due. Every node has the better of its two children, node 1 the best of
all. Of equal times the lower pair of bodies wins, and then the lower slot, so that the order never
depends on history.
"""

import math

from ...kernels import kernel
from ..state.clock_time import is_earlier
from ..state.records import Plans, Seats


def leaf_count(players: int) -> int:
    """Return the leaves of a tournament: a power of two, at least one."""
    return 1 << max(0, players - 1).bit_length()


@kernel
def _is_later(plans: Plans, one: int, other: int) -> bool:
    """Return whether the plan of one slot comes after that of another one at the same time."""
    if one < 0 or other < 0:
        return False
    left, right = plans[one], plans[other]
    if left.time_low != right.time_low:
        return bool(left.time_low > right.time_low)
    return bool(left.pair > right.pair)


@kernel
def _play(seats: Seats, plans: Plans, node: int) -> None:
    """Let the better of a node's two children have its seat."""
    left, right = seats[2 * node], seats[2 * node + 1]
    # Without a branch, which a processor could not foresee.
    place = 2 * node + (right.time < left.time)
    if right.time == left.time and _is_later(plans, left.slot, right.slot):
        place = 2 * node + 1
    seat, winner = seats[node], seats[place]
    seat.time, seat.slot = winner.time, winner.slot


@kernel
def start_tournament(seats: Seats, plans: Plans) -> None:
    """Play the whole tournament."""
    leaves = seats.shape[0] // 2
    for slot in range(leaves):
        seat = seats[leaves + slot]
        seat.slot = slot if slot < plans.shape[0] else -1
        seat.time = plans[slot].time if slot < plans.shape[0] else math.inf
    for node in range(leaves - 1, 0, -1):
        _play(seats, plans, node)


@kernel
def replay(seats: Seats, plans: Plans, slot: int) -> None:
    """Play those games again in which a changed plan took part, or takes part now."""
    node = seats.shape[0] // 2 + slot
    seats[node].time = plans[slot].time
    node //= 2
    while node > 0:
        before = seats[node].slot
        _play(seats, plans, node)
        if before != slot and seats[node].slot == before:
            break  # It was beaten here by the same as before.
        node //= 2


@kernel
def take_part(seats: Seats, plans: Plans, slot: int) -> None:
    """Let a slot take part, which did not."""
    seats[seats.shape[0] // 2 + slot].slot = slot
    replay(seats, plans, slot)


@kernel
def drop_out(seats: Seats, plans: Plans, slot: int) -> None:
    """Let a slot, the last one, no longer take part."""
    plans[slot].time = math.inf
    seats[seats.shape[0] // 2 + slot].slot = -1
    replay(seats, plans, slot)


@kernel
def is_far_ahead(seats: Seats, slot: int, other: int, time: float) -> bool:
    """Return whether the plans of all but the winner, ``slot``, and another one are later.

    Args:
        seats: the tournament.
        slot: the winner's.
        other: the other one's; -1 for none.
        time: than which they are later.
    """
    leaves = seats.shape[0] // 2
    node = leaves + slot
    while node > 1:
        rival = seats[node ^ 1]
        if rival.time <= time:
            if rival.slot != other:
                return False
            # Those that this one has beaten have not met the winner.
            if not _beats_all(seats, leaves + other, node ^ 1, time):
                return False
        node //= 2
    return True


@kernel
def _beats_all(seats: Seats, node: int, end: int, time: float) -> bool:
    """Return whether all plans that a leaf meets on its way up to a node are later than a time."""
    while node != end:
        if seats[node ^ 1].time <= time:
            return False
        node //= 2
    return True


@kernel
def next_due(seats: Seats, plans: Plans, node: int, time: float, low: float) -> int:
    """Return the next leaf after a node whose plan's time is not later than a time; 0 if none.

    Args:
        seats, plans: the tournament.
        node: a leaf that was returned before; 0 at first.
        time, low: the time.
    """
    leaves = seats.shape[0] // 2
    node = 1 if node == 0 else _node_after(node)
    while node > 0:
        slot = seats[node].slot
        if slot < 0 or is_earlier(time, low, plans[slot].time, plans[slot].time_low):
            node = _node_after(node)
        elif node >= leaves:
            return node
        else:
            node = 2 * node
    return 0


@kernel
def _node_after(node: int) -> int:
    """Return the node to visit next when all below a node has been visited; 0 at the end."""
    while node % 2 == 1:  # a right child, or the root
        node //= 2
    return node + 1 if node > 0 else 0
