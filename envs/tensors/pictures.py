"""Stacks of pictures, which move by one place in each step: a thread moves one word of each."""

from typing import Any

from ...physics.kernels import kernel
from ...physics.kernels.borrowed import BYTE, INDEX
from ...physics.kernels.portable import array_at
from .playing import BEGUN, ENDED, STAYED


@kernel
def slide_pictures(index: int, arrays: Any) -> None:
    """Move a word of a world's pictures by one place, and put that of the newest one behind them.

    The last pictures of an episode are kept apart, too.
    """
    size = arrays.channels * arrays.height * arrays.width
    if size % 8 == 0:
        _slide(index, size // 8, arrays, INDEX)
    else:
        _slide(index, size, arrays, BYTE)


@kernel
def fill_pictures(index: int, arrays: Any) -> None:
    """Fill all places with the first picture of an episode that a step has begun after another."""
    size = arrays.channels * arrays.height * arrays.width
    if size % 8 == 0:
        _fill(index, size // 8, arrays, INDEX)
    else:
        _fill(index, size, arrays, BYTE)


@kernel
def _slide(index: int, size: int, arrays: Any, word_type: Any) -> None:
    world, word = index // size, index % size
    move = array_at(arrays.moves, (arrays.count,), BYTE)[world]
    if move == STAYED:
        return
    shape = (arrays.count, arrays.stack, size)
    places = array_at(arrays.pictures, shape, word_type)[world]
    newest = array_at(arrays.canvas, (arrays.count, size), word_type)[world, word]
    for place in range(arrays.stack - 1):
        places[place, word] = newest if move == BEGUN else places[place + 1, word]
    places[arrays.stack - 1, word] = newest
    if move == ENDED:
        finals = array_at(arrays.final_pictures, shape, word_type)[world]
        for place in range(arrays.stack):
            finals[place, word] = places[place, word]


@kernel
def _fill(index: int, size: int, arrays: Any, word_type: Any) -> None:
    world, word = index // size, index % size
    if array_at(arrays.moves, (arrays.count,), BYTE)[world] == ENDED:
        shape = (arrays.count, arrays.stack, size)
        places = array_at(arrays.pictures, shape, word_type)[world]
        newest = array_at(arrays.canvas, (arrays.count, size), word_type)[world, word]
        for place in range(arrays.stack):
            places[place, word] = newest
