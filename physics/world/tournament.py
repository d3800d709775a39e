"""Which of many plans comes first: a knock-out tournament, of which a change replays one path.

``winners`` is a binary tree in an array. Its second half are the leaves: the slots in order, or -1.
Every node holds the winner of its two children, node 1 the winner of all. Of equal times the lower
pair of bodies wins, and then the lower slot, so that the order never depends on history.
"""

from ..kernels import kernel
from .clock_time import is_earlier
from .records import Indices, Plans


def leaf_count(players: int) -> int:
    """Return the leaves of a tournament: a power of two, at least one."""
    return 1 << max(0, players - 1).bit_length()


@kernel
def better(plans: Plans, one: int, other: int) -> int:
    """Return the slot whose plan comes first."""
    if other < 0:
        return one
    left = plans[one]
    right = plans[other]
    if is_earlier(right.time, right.time_low, left.time, left.time_low):
        return other
    if right.time == left.time and right.time_low == left.time_low and right.pair < left.pair:
        return other
    return one


@kernel
def start_tournament(winners: Indices, plans: Plans) -> None:
    """Play the whole tournament."""
    leaves = winners.shape[0] // 2
    for slot in range(leaves):
        winners[leaves + slot] = slot if slot < plans.shape[0] else -1
    for node in range(leaves - 1, 0, -1):
        winners[node] = better(plans, winners[2 * node], winners[2 * node + 1])


@kernel
def replay(winners: Indices, plans: Plans, slot: int) -> None:
    """Play those games again in which a changed plan took part, or takes part now."""
    node = (winners.shape[0] // 2 + slot) // 2
    while node > 0:
        before = winners[node]
        winners[node] = better(plans, winners[2 * node], winners[2 * node + 1])
        if before != slot and winners[node] == before:
            break  # It was beaten here by the same as before.
        node //= 2


@kernel
def drop_out(winners: Indices, plans: Plans, slot: int) -> None:
    """Let a slot, the last one, no longer take part."""
    winners[winners.shape[0] // 2 + slot] = -1
    replay(winners, plans, slot)


@kernel
def is_far_ahead(winners: Indices, plans: Plans, slot: int, other: int, time: float) -> bool:
    """Return whether the plans of all but the winner, ``slot``, and another one are later.

    Args:
        winners, plans: the tournament.
        slot: the winner's.
        other: the other one's; -1 for none.
        time: than which they are later.
    """
    leaves = winners.shape[0] // 2
    node = leaves + slot
    while node > 1:
        rival = winners[node ^ 1]
        if rival >= 0 and plans[rival].time <= time:
            if rival != other:
                return False
            # Those that this one has beaten have not met the winner.
            if not _beats_all(winners, plans, leaves + other, node ^ 1, time):
                return False
        node //= 2
    return True


@kernel
def _beats_all(winners: Indices, plans: Plans, node: int, end: int, time: float) -> bool:
    """Return whether all plans that a leaf meets on its way up to a node are later than a time."""
    while node != end:
        rival = winners[node ^ 1]
        if rival >= 0 and plans[rival].time <= time:
            return False
        node //= 2
    return True


@kernel
def next_due(winners: Indices, plans: Plans, node: int, time: float, low: float) -> int:
    """Return the next leaf after a node whose plan's time is not later than a time; 0 if none.

    Args:
        winners, plans: the tournament.
        node: a leaf that was returned before; 0 at first.
        time, low: the time.
    """
    leaves = winners.shape[0] // 2
    node = 1 if node == 0 else _node_after(node)
    while node > 0:
        slot = winners[node]
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
