"""Arrays at addresses and on the stack, compiled and interpreted."""

import numpy as np
import pytest
from arkanoid.physics.kernels import kernel
from arkanoid.physics.kernels.portable import addresses, array_at, on_stack
from helpers.processes import INTERPRETED, run_program

INT64 = np.dtype(np.int64)
PAIR = np.dtype([("first", np.float64), ("second", np.int64)])


@kernel
def change(address: int, rows: int) -> int:
    array = array_at(address, (rows, 2), INT64)
    array[rows - 1, 0] = 7
    return array.shape[0] * 10 + array.shape[1]


@kernel
def second_of(address: int, index: int) -> int:
    return array_at(address, (index + 1,), PAIR)[index].second


@kernel
def sum_on_stack(number: int) -> int:
    memory = on_stack(16)
    for index in range(16):
        memory[index] = number
    total = 0
    for index in range(16):
        total += memory[index]
    return total * 100 + memory.size


def test_an_array_lies_where_its_address_says():
    array = np.zeros((3, 2), np.int64)
    assert change(array.ctypes.data, 3) == 32
    assert array.tolist() == [[0, 0], [0, 0], [7, 0]]
    assert second_of(np.array([(0.5, 3), (1.5, 4)], PAIR).ctypes.data, 1) == 4


def test_bytes_on_the_stack_belong_to_a_call():
    assert sum_on_stack(2) == 3216
    assert sum_on_stack(3) == 4816


@pytest.mark.parametrize("dtype", [INT64, PAIR])
def test_interpreted_arrays_are_views_as_well(dtype):
    array = np.ones(4, dtype)
    # As kernels find it: a number of NumPy's was refused.
    view = addresses._numpy_array(np.int64(array.ctypes.data), (np.int64(2), 2), dtype)
    assert np.shares_memory(view, array)
    view[...] = np.zeros(1, dtype)[0]
    assert (array == np.zeros(4, dtype)).all()


def test_interpreted():
    run_program(
        """
import numpy as np
from arkanoid.physics.kernels.portable import array_at, on_stack
array = np.zeros((3, 2), np.int64)
array_at(array.ctypes.data, (3, 2), array.dtype)[2, 0] = 7
assert array[2, 0] == 7
memory = on_stack(16)
assert memory.dtype == np.uint8 and memory.shape == (16,)
""",
        changes=INTERPRETED,
    )
