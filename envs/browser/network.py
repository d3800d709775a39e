"""A network of an actor and a critic: what it does and expects in a game that it observes."""

from typing import Any

from ...physics.kernels import inlined, kernel
from ...physics.kernels.portable import array_at
from ..tensors.playing import FLOAT32, FLOAT64

TANH, RELU, ELU, SILU = range(4)
ACTIVATIONS = {"tanh": TANH, "relu": RELU, "elu": ELU, "silu": SILU}

# e^x is taken of x / 2^10, where some terms of its series are enough, and squared ten times.
_TERMS = 16
_SQUARINGS = 10
_PART = 1.0 / 1024.0
_SMALLEST = -700.0  # below it, e^x counts as 0


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
def activate(x: float, activation: int) -> float:
    """Return the function between layers, one of `ACTIVATIONS`."""
    if activation == RELU:
        return max(x, 0.0)
    if activation == ELU:
        return x if x > 0.0 else exponential(x) - 1.0
    if activation == TANH:
        power = exponential(-2.0 * abs(x))
        size = (1.0 - power) / (1.0 + power)
        return size if x >= 0.0 else -size
    power = exponential(-abs(x))
    return x / (1.0 + power) if x >= 0.0 else x * power / (1.0 + power)


@kernel
def _layer(inputs: Any, weights: Any, outputs: Any) -> None:
    """Write the sums of a layer; weights: float32 [inputs + 1, outputs]."""
    count = inputs.shape[0]
    for place in range(outputs.shape[0]):
        outputs[place] = weights[count, place]
    for index in range(count):
        number = inputs[index]
        # Most numbers of an observation are 0.
        if number != 0.0:
            for place in range(outputs.shape[0]):
                outputs[place] += number * weights[index, place]


@inlined
def _run(network: Any, weights: int, last: int, outputs: Any) -> int:
    """Write the outputs of an actor or a critic; return where its weights end.

    Args:
        weights: where they begin; last: the width of its last layer; outputs: float32 [last].
    """
    widest = 0
    for layer in range(network.layers):
        widest = max(widest, network.widths[layer])
    inputs = array_at(network.observation, (network.widths[0],), FLOAT32)
    for layer in range(network.layers):
        begins, ends = network.widths[layer], network.widths[layer + 1]
        is_last = layer == network.layers - 1
        if is_last:
            ends = last
        matrix = array_at(weights, (begins + 1, ends), FLOAT32)
        if is_last:
            _layer(inputs, matrix, outputs)
        else:
            hidden = array_at(network.scratch + 4 * widest * (layer % 2), (ends,), FLOAT32)
            _layer(inputs, matrix, hidden)
            for place in range(ends):
                hidden[place] = activate(float(hidden[place]), network.activation)
            inputs = hidden
        weights += 4 * (begins + 1) * ends
    return weights


@kernel
def think(network: Any) -> None:
    """Write what a `Network` says of the observation that it sees."""
    actions = network.widths[network.layers]
    logits = array_at(network.outputs, (actions,), FLOAT32)
    critic = _run(network, network.weights, actions, logits)
    # The critic's value passes through the place of the first probability.
    value = array_at(network.probabilities, (1,), FLOAT32)
    _run(network, critic, 1, value)
    network.value = value[0]
    best = 0
    for action in range(1, actions):
        if logits[action] > logits[best]:
            best = action
    network.action = best
    probabilities = array_at(network.probabilities, (actions,), FLOAT64)
    total = 0.0
    for action in range(actions):
        probabilities[action] = exponential(float(logits[action]) - float(logits[best]))
        total += probabilities[action]
    for action in range(actions):
        probabilities[action] /= total
