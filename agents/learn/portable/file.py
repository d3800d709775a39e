"""A trained network as a small file, for the kernel that computes it in browsers.

The file holds, little-endian: 4 bytes, the length of what is next; JSON, see `_header`, with spaces
to a multiple of 8 bytes; and, as `envs.browser.records.Network` has them, the operations and the
weights, float32.
"""

import json
import struct
from typing import Any

import torch

from ....envs.actions import COMMANDS
from ....envs.config import Config
from ...experiment.errors import SettingsError
from ...experiment.runs import ModelFile
from ...experiment.settings import Experiment
from ..model import rebuild_network
from .recording import Numbers, Recording, UnknownOperationError

# Of one decision. A telephone multiplies a billion numbers a second, and agents decide in every
# 4 / 60 of a second.
MOST_PRODUCTS = 50_000_000
# A page has to hold them, with 4 bytes each.
MOST_WEIGHTS = 10_000_000
_LENGTH = struct.Struct("<I")
_WORD = 8  # bytes


class TooLargeError(Exception):
    """A page cannot take the network; the message says why."""


def portable_network(model: ModelFile, experiment: Experiment) -> bytes:
    """Return the file of a saved model.

    Raises `SettingsError` if the file cannot be read, or no browser can play such a network: it is
    too large, or the kernel lacks an operation.
    """
    try:
        return network_file(rebuild_network(model, experiment), experiment)
    except (UnknownOperationError, TooLargeError) as error:
        message = f"{model.path}: no browser can play this network: {error}"
        raise SettingsError(message) from None


def network_file(policy: Any, experiment: Experiment) -> bytes:
    """Return the file of stable-baselines3's policy, which plays an experiment's game.

    Raises:
        UnknownOperationError, TooLargeError: no browser can play such a network.
    """
    recording = Recording()
    with torch.no_grad():
        outputs, value = _record(recording, policy, experiment.config)
    limits = {"products": MOST_PRODUCTS, "weights": MOST_WEIGHTS}
    sizes = {"products": recording.products, "weights": len(recording.weights)}
    for name, most in limits.items():
        if sizes[name] > most:
            raise TooLargeError(f"{sizes[name]:,} {name} are more than a page can take, {most:,}")
    header = _header(experiment, recording, outputs, value)
    operations, weights = recording.operations.tobytes(), recording.weights.tobytes()
    return b"".join([_LENGTH.pack(len(header)), header, operations, weights])


def _record(recording: Recording, policy: Any, config: Config) -> tuple[Numbers, Numbers]:
    """Record what the network does; return logits, or the means of a box, and the value."""
    shape = policy.observation_space.shape
    seen = recording.observe(shape, channels_last=config.observation == "rgb")
    features = policy.features_extractor(seen)
    actor, critic = policy.mlp_extractor(features)
    return policy.action_net(actor), policy.value_net(critic)


def _header(
    experiment: Experiment, recording: Recording, outputs: Numbers, value: Numbers
) -> bytes:
    """Return what the file says of the network: its game, and where its results lie."""
    config = experiment.config
    sees = {"kind": config.observation, "inputs": recording.inputs}
    if config.observation == "rgb":
        height, width = config.picture_size
        channels = 1 if config.grey else 3
        sees |= {"pictures": config.stack, "size": [height, width], "channels": channels}
    header = {
        "name": experiment.name,
        "env_id": experiment.env_id,
        "config": config.plain(),
        "sees": sees,
        "discrete": config.actions in COMMANDS,
        "computed": recording.computed,
        "operations": len(recording.operations),
        "outputs": [outputs.first, *outputs.shape],
        "value": value.first,
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    return text + b" " * (-len(text) % _WORD)
