"""Entries for tests: they work on float64 [4] or int64 [4] at their address."""

import math

import numpy as np
from arkanoid.physics.kernels import accessor, kernel
from arkanoid.physics.kernels.portable import array_at, on_stack

FLOAT64 = np.dtype(np.float64)
INT64 = np.dtype(np.int64)
TABLE = np.array([3.0, 0.5, 0.25, 7.0])


@kernel
def roots(index: int, address: int) -> None:
    """Use roots, and constants that the module holds."""
    numbers = array_at(address, (4,), FLOAT64)
    numbers[index] = math.sqrt(numbers[index]) * TABLE[index] + 0.1


@kernel
def integers(index: int, address: int) -> None:
    """Use the stack, and roundings to integers."""
    numbers = array_at(address, (4,), INT64)
    memory = on_stack(16)
    for place in range(16):
        memory[place] = place + index
    numbers[0] = 0
    for place in range(16):
        numbers[0] += memory[place]
    numbers[1] = math.floor(-0.5 * numbers[3]) // 7
    numbers[2] = round(0.5 * numbers[3])


@accessor
def parts(numbers, at):
    """Return two views and a number."""
    return numbers[:at], numbers[at:], at


@kernel
def turn(index: int, address: int) -> None:
    """Use arrays that a function returns: in memory, with pointers."""
    numbers = array_at(address, (4,), FLOAT64)
    head, tail, count = parts(numbers, index)
    first = head[0]
    head[0] = tail[0] + count
    tail[0] = first
