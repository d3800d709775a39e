"""Which of many plans comes first: a knock-out tournament, replayed along one path per change.

``winners`` is a binary tree in an array: its second half are the leaves, the slots in order (or
-1), and every node holds the better one of its two children; node 1 the winner of all. Equal times
go to the lower slot, so that the order never depends on history.
"""

from typing import Any

from ..kernels import kernel
from .clock_time import is_earlier


def leaf_count(players: int) -> int:
    """Return the leaves of a tournament: a power of two, at least one."""
    return 1 << max(0, players - 1).bit_length()


@kernel
def _better(plans: Any, one: int, other: int) -> int:
    """Return the slot whose plan comes first; the left one if both come at once."""
    if other < 0:
        return one
    left = plans[one]
    right = plans[other]
    if is_earlier(right.time, right.time_low, left.time, left.time_low):
        return other
    return one


@kernel
def start_tournament(winners: Any, plans: Any) -> None:
    """Play it from scratch."""
    leaves = winners.shape[0] // 2
    for slot in range(leaves):
        winners[leaves + slot] = slot if slot < plans.shape[0] else -1
    for node in range(leaves - 1, 0, -1):
        winners[node] = _better(plans, winners[2 * node], winners[2 * node + 1])


@kernel
def replay(winners: Any, plans: Any, slot: int) -> None:
    """Play again what a changed plan took part in."""
    node = (winners.shape[0] // 2 + slot) // 2
    while node > 0:
        winners[node] = _better(plans, winners[2 * node], winners[2 * node + 1])
        node //= 2
