"""What a network does, as a list of operations: it is called with `Numbers`, which note it.

Numbers lie in a memory, whose places count from the first weight on. What is computed lies before
it, so its places are negative.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import torch
import torch.nn.functional as functions
from numpy.typing import NDArray

from ....envs.browser import operations as kinds
from ....envs.browser.records import Operation

Shape = tuple[int, ...]
_AXES = 3  # of an operation that copies


class UnknownOperationError(Exception):
    """The network does something that no operation does."""

    def __init__(self, name: str) -> None:
        super().__init__(f"its operation {name!r} is not known there")


class Recording:
    """What a network does with an observation.

    Attributes:
        inputs: how many numbers are observed; they lie right before the weights.
        computed: how many numbers lie before the weights, with these.
        products: how many numbers are multiplied or copied, which tells how long it takes.
    """

    def __init__(self) -> None:
        self.inputs = 0
        self.computed = 0
        self.products = 0
        self._operations: list[Any] = []
        self._weights: list[NDArray[np.float32]] = []
        self._num_weights = 0
        self._constants: dict[float, int] = {}

    def observe(self, shape: Shape, channels_last: bool = False) -> "Numbers":
        """Return the observation, a picture [channels, rows, columns] or a vector.

        Args:
            channels_last: whether a picture's channels lie side by side.
        """
        assert self.computed == 0
        self.inputs = self.products = math.prod(shape)
        steps = _picture_steps(shape) if channels_last else _plain_steps(shape)
        return Numbers(self, self.reserve(self.inputs), shape, steps)

    @property
    def operations(self) -> NDArray[Any]:
        """The `Operation` records, in turn."""
        return np.array(self._operations, Operation)

    @property
    def weights(self) -> NDArray[np.float32]:
        """All weights, float32 [n]."""
        return np.concatenate(self._weights)

    def keep(self, *arrays: NDArray[Any]) -> int:
        """Put weights side by side; return the place of the first one."""
        place = self._num_weights
        for array in arrays:
            self._weights.append(array.astype("<f4").ravel())
            self._num_weights += array.size
        return place

    def constant(self, value: float) -> "Numbers":
        """Return a number that is always the same."""
        if value not in self._constants:
            self._constants[value] = self.keep(np.array([value]))
        return Numbers(self, self._constants[value], (), ())

    def note(
        self,
        kind: int,
        results: Shape,
        operands: Sequence[int],
        layout: Shape | None = None,
        products: int = 0,
        target: int | None = None,
        **fields: int | Sequence[int],
    ) -> "Numbers":
        """Note an operation, and return its results.

        Args:
            kind: one of those of `envs.browser.operations`.
            results: their shape; layout: their steps, otherwise those of torch.
            operands: the places of what it reads.
            products: numbers that are multiplied, if there are more than results.
            target: where the results lie; otherwise in memory of their own.
            fields: further ones of `Operation`.
        """
        size = math.prod(results)
        first = self.reserve(size) if target is None else target
        self.products += max(products, size)
        operation = np.zeros((), Operation)
        fields = {"count": size, **fields, "operands": operands}
        for name, value in {**fields, "kind": kind, "target": first}.items():
            if isinstance(value, int):
                operation[name] = value
            else:
                operation[name][: len(value)] = value
        self._operations.append(operation)
        return Numbers(self, first, results, layout or _plain_steps(results))

    def reserve(self, size: int) -> int:
        """Return the first place of memory for results."""
        self.computed += size
        return -self.computed


class Numbers:
    """Numbers that a network computes, in place of a tensor [1, ...] of torch.

    Attributes:
        first: the place of the first one.
        shape: without the axis of the batch; steps: from one to the next along each axis.
    """

    dtype = torch.float32

    def __init__(self, recording: Recording, first: int, shape: Shape, steps: Shape) -> None:
        self.recording = recording
        self.first = first
        self.shape = shape
        self.steps = steps

    @classmethod
    def __torch_function__(
        cls,
        function: Callable[..., Any],
        types: Sequence[type],
        arguments: Sequence[Any] = (),
        keywords: Mapping[str, Any] | None = None,
    ) -> "Numbers":
        """Note what a function of torch does."""
        known = _FUNCTIONS.get(function)
        if known is None:
            raise UnknownOperationError(getattr(function, "__name__", str(function)))
        return known(*arguments, **(keywords or {}))

    def __getattr__(self, name: str) -> Any:
        raise UnknownOperationError(name)

    def __getitem__(self, places: tuple[slice, int | slice]) -> "Numbers":
        """Return a part of a vector, or a single number of it."""
        _, chosen = places
        (length,), (step,) = self.shape, self.steps
        if isinstance(chosen, int):
            return Numbers(self.recording, self.first + chosen * step, (), ())
        start, stop, _ = chosen.indices(length)
        return Numbers(self.recording, self.first + start * step, (stop - start,), (step,))

    def to(self, dtype: torch.dtype) -> "Numbers":
        """Return the numbers; what is true or false is 1 or 0 already."""
        assert dtype == torch.float32
        return self

    def unsqueeze(self, axis: int) -> "Numbers":
        """Return a single number as a vector."""
        assert axis == 1
        assert self.shape == ()
        return Numbers(self.recording, self.first, (1,), (0,))

    def clamp(self, least: float, most: float) -> "Numbers":
        """Return the numbers, moved to the nearest bound."""
        return _pairs(kinds.SMALLER, _pairs(kinds.LARGER, self, least), most)

    def argmin(self, axis: int, keepdim: bool) -> "Numbers":
        """Return the index of a vector's smallest number."""
        assert axis == 1
        assert keepdim
        numbers = _in_order(self)
        (length,) = self.shape
        return self.recording.note(kinds.SMALLEST, (1,), (numbers.first,), sizes=(length,))

    def gather(self, axis: int, index: "Numbers") -> "Numbers":
        """Return the number of a vector that an index names."""
        assert axis == 1
        assert index.shape == (1,)
        numbers = _in_order(self)
        return self.recording.note(kinds.PICK, (1,), (numbers.first, index.first))

    def flatten(self, first: int, last: int) -> "Numbers":
        """Return the numbers as a vector, in the order of torch."""
        assert (first, last) == (1, -1)
        size = math.prod(self.shape)
        return Numbers(self.recording, _in_order(self).first, (size,), (1,))

    def unflatten(self, axis: int, shape: Shape) -> "Numbers":
        """Return a vector as a picture."""
        assert axis == 1
        return Numbers(self.recording, _in_order(self).first, shape, _plain_steps(shape))

    def __add__(self, other: "Numbers | float") -> "Numbers":
        return _pairs(kinds.ADD, self, other)

    def __sub__(self, other: "Numbers | float") -> "Numbers":
        return _pairs(kinds.SUBTRACT, self, other)

    def __rsub__(self, other: float) -> "Numbers":
        return _pairs(kinds.SUBTRACT, other, self)

    def __mul__(self, other: "Numbers | float") -> "Numbers":
        return _pairs(kinds.MULTIPLY, self, other)

    def __truediv__(self, other: "Numbers | float") -> "Numbers":
        return _pairs(kinds.DIVIDE, self, other)

    def __lt__(self, other: "Numbers | float") -> "Numbers":
        return _pairs(kinds.LESS, self, other)

    def __gt__(self, other: "Numbers | float") -> "Numbers":
        return _pairs(kinds.LESS, other, self)

    def __and__(self, other: "Numbers") -> "Numbers":
        return _pairs(kinds.SMALLER, self, other)

    def __or__(self, other: "Numbers") -> "Numbers":
        return _pairs(kinds.LARGER, self, other)

    __radd__ = __add__
    __rmul__ = __mul__


def _pairs(kind: int, *operands: Numbers | float) -> Numbers:
    """Note a function of two or three numbers, taken of vectors and single numbers."""
    recording = next(each.recording for each in operands if isinstance(each, Numbers))
    known = [
        each if isinstance(each, Numbers) else recording.constant(float(each)) for each in operands
    ]
    shape = np.broadcast_shapes(*(each.shape for each in known))
    assert len(shape) <= 1
    # A single number is read again and again.
    steps = [each.steps[0] if each.shape == shape != () else 0 for each in known]
    return recording.note(kind, shape, [each.first for each in known], steps=steps)


def _each(kind: int) -> Callable[..., Numbers]:
    """Return what notes a function of single numbers."""

    def note(numbers: Numbers, **_: Any) -> Numbers:
        numbers = _side_by_side(numbers)
        operands, layout = (numbers.first,), numbers.steps
        return numbers.recording.note(kind, numbers.shape, operands, layout, steps=(1,))

    return note


def _elu(numbers: Numbers, alpha: float = 1.0, **_: Any) -> Numbers:
    if alpha != 1.0:
        raise UnknownOperationError(f"elu with alpha={alpha}")
    return _each(kinds.ELU)(numbers)


def _cat(parts: Sequence[Numbers], dim: int = 0) -> Numbers:
    """Note that vectors are put side by side."""
    assert dim == 1
    recording = parts[0].recording
    size = sum(math.prod(part.shape) for part in parts)
    whole = recording.reserve(size)
    target = whole
    for part in parts:
        target += math.prod(_copy(part, (0,), target).shape)
    return Numbers(recording, whole, (size,), (1,))


def _linear(numbers: Numbers, weight: torch.Tensor, bias: torch.Tensor) -> Numbers:
    recording, numbers = numbers.recording, _in_order(numbers)
    outputs, inputs = weight.shape
    place = recording.keep(weight.detach().numpy().T, bias.detach().numpy())
    operands = numbers.first, place
    products = inputs * outputs
    return recording.note(kinds.LINEAR, (outputs,), operands, products=products, sizes=(inputs,))


def _conv2d(
    numbers: Numbers,
    weight: torch.Tensor,
    bias: torch.Tensor,
    stride: Sequence[int],
    padding: Sequence[int],
    dilation: Sequence[int],
    groups: int,
) -> Numbers:
    channels, depth, window, width = weight.shape
    square = window == width and len(set(stride)) == len(set(padding)) == 1
    if not square or groups != 1 or set(dilation) != {1}:
        raise UnknownOperationError("convolution of this form")
    recording, numbers = numbers.recording, _with_channels_last(numbers)
    place = recording.keep(weight.detach().numpy().transpose(2, 3, 1, 0), bias.detach().numpy())
    _, rows, columns = numbers.shape
    sizes = [(size + 2 * padding[0] - window) // stride[0] + 1 for size in (rows, columns)]
    shape = channels, sizes[0], sizes[1]
    return recording.note(
        kinds.CONVOLUTION,
        shape,
        (numbers.first, place),
        _picture_steps(shape),
        products=math.prod(shape) * depth * window * window,
        count=channels,
        sizes=(rows, columns, depth),
        window=window,
        stride=stride[0],
        padding=padding[0],
    )


_FUNCTIONS: dict[Any, Callable[..., Numbers]] = {
    torch.tanh: _each(kinds.TANH),
    torch.abs: _each(kinds.ABSOLUTE),
    functions.relu: _each(kinds.RELU),
    functions.silu: _each(kinds.SILU),
    functions.elu: _elu,
    functions.linear: _linear,
    functions.conv2d: _conv2d,
    torch.remainder: lambda x, y: _pairs(kinds.REMAINDER, x, y),
    torch.where: lambda x, y, z: _pairs(kinds.CHOOSE, x, y, z),
    torch.cat: _cat,
}


def _plain_steps(shape: Shape) -> Shape:
    """Return the steps of an array of torch."""
    return tuple(math.prod(shape[axis + 1 :]) for axis in range(len(shape)))


def _picture_steps(shape: Shape) -> Shape:
    """Return the steps of a picture [channels, rows, columns] whose channels lie side by side."""
    channels, _, columns = shape
    return 1, columns * channels, channels


def _lies(numbers: Numbers, steps: Shape) -> bool:
    """Return whether numbers have these steps along all axes that are longer than 1."""
    return all(
        length == 1 or one == other
        for length, one, other in zip(numbers.shape, numbers.steps, steps, strict=True)
    )


def _in_order(numbers: Numbers) -> Numbers:
    """Return the numbers as torch would have them in memory."""
    if _lies(numbers, _plain_steps(numbers.shape)):
        return numbers
    copied = _copy(numbers, tuple(range(len(numbers.shape))))
    return Numbers(copied.recording, copied.first, numbers.shape, _plain_steps(numbers.shape))


def _with_channels_last(picture: Numbers) -> Numbers:
    """Return a picture as convolutions read it."""
    steps = _picture_steps(picture.shape)
    if _lies(picture, steps):
        return picture
    return Numbers(picture.recording, _copy(picture, (1, 2, 0)).first, picture.shape, steps)


def _side_by_side(numbers: Numbers) -> Numbers:
    """Return the numbers without gaps, in any order."""
    if len(numbers.shape) == _AXES and _lies(numbers, _picture_steps(numbers.shape)):
        return numbers
    return _in_order(numbers)


def _copy(numbers: Numbers, axes: Sequence[int], target: int | None = None) -> Numbers:
    """Return a copy as a vector, in the order of some axes, the last one first.

    Args:
        target: where it lies; otherwise in memory of its own.
    """
    more = _AXES - len(axes)
    sizes = [1] * more + [numbers.shape[axis] for axis in axes]
    steps = [0] * more + [numbers.steps[axis] for axis in axes]
    return numbers.recording.note(
        kinds.COPY,
        (math.prod(sizes),),
        (numbers.first,),
        target=target,
        sizes=sizes,
        steps=steps,
    )
