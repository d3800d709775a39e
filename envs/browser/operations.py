"""The operations that networks consist of: sums of products, and functions of single numbers."""

import math
from typing import Any

import numpy as np

from ...physics.kernels import kernel
from ...physics.kernels.portable import array_at
from ..tensors.playing import FLOAT32

# Functions of one number, two, and three, which are taken number by number.
TANH, RELU, ELU, SILU, ABSOLUTE = range(5)
ADD, SUBTRACT, MULTIPLY, DIVIDE, REMAINDER, LESS, SMALLER, LARGER = range(5, 13)
CHOOSE = 13  # the second number if the first one is not 0, else the third one
# Operations of other forms.
COPY, SMALLEST, PICK, LINEAR, CONVOLUTION = range(14, 19)

# e^x is taken of x / 2^10, where some terms of its series are enough, and squared ten times.
_TERMS = 16
_SQUARINGS = 10
_PART = 1.0 / 1024.0
_SMALLEST = -700.0  # below it, e^x counts as 0
# So many times a float32 number, plus itself, is exact as float64.
_EXACT = 2.0**28


@kernel
def exponential(x: float) -> float:
    """Return e^x of x <= 0, to about 12 digits, by multiplications and additions alone."""
    if x < _SMALLEST:
        return 0.0
    part = x * _PART
    power = 1.0
    for term in range(_TERMS, 0, -1):
        power = 1.0 + power * part / term
    for _ in range(_SQUARINGS):
        power *= power
    return power


@kernel
def remainder(x: float, y: float) -> float:
    """Return x less a whole multiple of y > 0, in [0, y], as torch rounds it.

    Args:
        x, y: float32 numbers; x is at most 2^56 times y.
    """
    rest = abs(x)
    # What is taken off at first is so large a multiple that the second quotient is exact.
    for unit in (y * _EXACT, y):
        rest -= math.floor(rest / unit) * unit
        if rest < 0.0:
            rest += unit
        if rest >= unit:
            rest -= unit
    return y - rest if x < 0.0 and rest > 0.0 else rest


@kernel
def _of_one(kind: int, x: float) -> float:
    """Return a function of one number."""
    if kind == RELU:
        return max(x, 0.0)
    if kind == ELU:
        return x if x > 0.0 else exponential(x) - 1.0
    if kind == ABSOLUTE:
        return abs(x)
    if kind == TANH:
        power = exponential(-2.0 * abs(x))
        size = (1.0 - power) / (1.0 + power)
        return size if x >= 0.0 else -size
    power = exponential(-abs(x))
    return x / (1.0 + power) if x >= 0.0 else x * power / (1.0 + power)


@kernel
def _of_two(kind: int, x: float, y: float) -> float:
    """Return a function of two numbers."""
    if kind == ADD:
        return x + y
    if kind == SUBTRACT:
        return x - y
    if kind == MULTIPLY:
        return x * y
    if kind == DIVIDE:
        return x / y
    if kind == REMAINDER:
        return remainder(x, y)
    if kind == LESS:
        return 1.0 if x < y else 0.0
    return min(x, y) if kind == SMALLER else max(x, y)


@kernel
def function_of(kind: int, x: float, y: float, z: float) -> float:
    """Return a function of one number, two, or three.

    The numbers have 53 bits. Rounded to 24, the result of `ADD` to `REMAINDER` is what an operation
    of float32 numbers gives.
    """
    if kind < ADD:
        return _of_one(kind, x)
    if kind < CHOOSE:
        return _of_two(kind, x, y)
    return y if x != 0.0 else z


@kernel
def operate(weights: int, operation: Any) -> None:
    """Do an `Operation` on the memory of the weights that begin at an address."""
    kind = operation.kind
    if kind == LINEAR:
        _add_products(
            array_at(weights + 4 * operation.operands[0], (operation.sizes[0],), FLOAT32),
            array_at(
                weights + 4 * operation.operands[1],
                (operation.sizes[0] + 1, operation.count),
                FLOAT32,
            ),
            array_at(weights + 4 * operation.target, (operation.count,), FLOAT32),
        )
    elif kind == CONVOLUTION:
        _convolve(weights, operation)
    elif kind == COPY:
        _copy(weights, operation)
    elif kind == SMALLEST:
        _find_smallest(weights, operation)
    elif kind == PICK:
        index = int(array_at(weights + 4 * operation.operands[1], (1,), FLOAT32)[0])
        source = array_at(weights + 4 * (operation.operands[0] + index), (1,), FLOAT32)
        array_at(weights + 4 * operation.target, (1,), FLOAT32)[0] = source[0]
    else:
        _take_each(weights, operation)


@kernel
def _add_products(numbers: Any, matrix: Any, sums: Any) -> None:
    """Write the sums of a layer.

    Args:
        numbers: float32 [n].
        matrix: float32 [n + 1, sums]; the last row is the bias.
        sums: float32 [sums], written.
    """
    count = numbers.shape[0]
    for place in range(sums.shape[0]):
        sums[place] = matrix[count, place]
    for index in range(count):
        number = numbers[index]
        # Most numbers of an observation are 0.
        if number != 0.0:
            for place in range(sums.shape[0]):
                sums[place] += number * matrix[index, place]


@kernel
def _convolve(weights: int, operation: Any) -> None:
    """Write a picture's convolution: float32 [rows, columns, channels], as all pictures.

    The weights are [window, window, channels of what is read, channels], and the biases.
    """
    window, stride, padding = operation.window, operation.stride, operation.padding
    height, width, depth = operation.sizes[0], operation.sizes[1], operation.sizes[2]
    rows = (height + 2 * padding - window) // stride + 1
    columns = (width + 2 * padding - window) // stride + 1
    seen = array_at(weights + 4 * operation.operands[0], (height, width, depth), FLOAT32)
    first, count = weights + 4 * operation.operands[1], operation.count
    matrix = array_at(first, (window, window, depth, count), FLOAT32)
    bias = array_at(first + 4 * window * window * depth * count, (count,), FLOAT32)
    results = array_at(weights + 4 * operation.target, (rows, columns, count), FLOAT32)
    for row in range(rows):
        top = row * stride - padding
        for column in range(columns):
            left = column * stride - padding
            sums = results[row, column]
            for place in range(count):
                sums[place] = bias[place]
            for down in range(max(0, -top), min(window, height - top)):
                for right in range(max(0, -left), min(window, width - left)):
                    for channel in range(depth):
                        number = seen[top + down, left + right, channel]
                        if number != 0.0:
                            for place in range(count):
                                sums[place] += number * matrix[down, right, channel, place]


@kernel
def _copy(weights: int, operation: Any) -> None:
    """Write numbers that lie apart side by side, those of the last axis first."""
    rows, columns, count = operation.sizes[0], operation.sizes[1], operation.sizes[2]
    results = array_at(weights + 4 * operation.target, (rows, columns, count), FLOAT32)
    for row in range(rows):
        for column in range(columns):
            for index in range(count):
                place = row * operation.steps[0] + column * operation.steps[1]
                place += operation.operands[0] + index * operation.steps[2]
                results[row, column, index] = array_at(weights + 4 * place, (1,), FLOAT32)[0]


@kernel
def _find_smallest(weights: int, operation: Any) -> None:
    """Write the index of the smallest number; of the first one among equals."""
    count = operation.sizes[0]
    numbers = array_at(weights + 4 * operation.operands[0], (count,), FLOAT32)
    smallest = 0
    for index in range(1, count):
        if numbers[index] < numbers[smallest]:
            smallest = index
    array_at(weights + 4 * operation.target, (1,), FLOAT32)[0] = np.float32(smallest)


@kernel
def _take_each(weights: int, operation: Any) -> None:
    """Write a function of single numbers, or of pairs or triples of them."""
    kind, count = operation.kind, operation.count
    results = array_at(weights + 4 * operation.target, (count,), FLOAT32)
    for index in range(count):
        x = _number(weights, operation, 0, index)
        y = _number(weights, operation, 1, index)
        z = _number(weights, operation, 2, index)
        results[index] = np.float32(function_of(kind, x, y, z))


@kernel
def _number(weights: int, operation: Any, operand: int, index: int) -> float:
    """Return a number of an operand."""
    place = operation.operands[operand] + index * operation.steps[operand]
    return np.float64(array_at(weights + 4 * place, (1,), FLOAT32)[0])
