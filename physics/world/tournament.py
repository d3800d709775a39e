"""Which of many plans comes first: a knock-out tournament, of which a change replays one path.

``winners`` is a binary tree in an array. Its second half are the leaves: the slots in order, or -1.
Every node holds the winner of its two children, node 1 the winner of all. Of equal times the lower
slot wins, so that the order never depends on history.
"""

from ..kernels import kernel
from .clock_time import is_earlier
from .records import Indices, Plans


def leaf_count(players: int) -> int:
    """Return the leaves of a tournament: a power of two, at least one."""
    return 1 << max(0, players - 1).bit_length()


@kernel
def better(plans: Plans, one: int, other: int) -> int:
    """Return the slot whose plan comes first; the left one if the times are equal."""
    if other < 0:
        return one
    left = plans[one]
    right = plans[other]
    if is_earlier(right.time, right.time_low, left.time, left.time_low):
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
