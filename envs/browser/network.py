"""A network of an actor and a critic: what it does and expects in a game that it observes."""

from typing import Any

import numpy as np

from ...physics.kernels import kernel
from ...physics.kernels.borrowed import BYTE
from ...physics.kernels.portable import array_at
from ..tensors.playing import FLOAT32, FLOAT64
from .operations import exponential, operate
from .records import Operation

_WHITE = np.float32(255)


@kernel
def think(network: Any) -> None:
    """Write what a `Network` says of the observation that it sees."""
    _see(network)
    operations = array_at(network.operations, (network.num_operations,), Operation)
    for index in range(network.num_operations):
        operate(network.weights, operations[index])
    network.value = array_at(network.weights + 4 * network.worth, (1,), FLOAT32)[0]
    _choose(network)


@kernel
def _see(network: Any) -> None:
    """Copy the observation before the weights. Pixels become [pixels, pictures * channels]."""
    inputs = network.inputs
    seen = array_at(network.weights - 4 * inputs, (inputs,), FLOAT32)
    if network.pictures == 0:
        numbers = array_at(network.observation, (inputs,), FLOAT32)
        for index in range(inputs):
            seen[index] = numbers[index]
        return
    pictures, channels = network.pictures, network.channels
    pixels = inputs // (pictures * channels)
    bytes_seen = array_at(network.observation, (pictures, pixels, channels), BYTE)
    for picture in range(pictures):
        for pixel in range(pixels):
            for channel in range(channels):
                place = (pixel * pictures + picture) * channels + channel
                seen[place] = np.float32(bytes_seen[picture, pixel, channel]) / _WHITE


@kernel
def _choose(network: Any) -> None:
    """Write the likeliest action, and the probabilities of all of them."""
    actions = network.num_outputs
    logits = array_at(network.weights + 4 * network.outputs, (actions,), FLOAT32)
    best = 0
    for action in range(1, actions):
        if logits[action] > logits[best]:
            best = action
    network.action = best
    probabilities = array_at(network.probabilities, (actions,), FLOAT64)
    total = 0.0
    for action in range(actions):
        probabilities[action] = exponential(np.float64(logits[action]) - np.float64(logits[best]))
        total += probabilities[action]
    for action in range(actions):
        probabilities[action] /= total
