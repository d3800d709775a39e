"""A trained network as a small file, for the kernel that computes it in browsers.

The file holds, little-endian: 4 bytes, the length of what is next; JSON, see `_header`, with spaces
to a multiple of 4 bytes; and the weights, float32, as `envs.browser.records.Network` has them.
"""

import json
import struct
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...envs.actions import COMMANDS
from ...envs.browser.records import MAX_LAYERS
from ..experiment.errors import SettingsError
from ..experiment.runs import ModelFile
from ..experiment.settings import Experiment
from .model import rebuild_network

_LENGTH = struct.Struct("<I")
_PARTS = ("policy_net", "value_net")
# The last layer of each part.
_LAST = {"policy_net": "action_net", "value_net": "value_net"}


def portable_network(model: ModelFile, experiment: Experiment) -> bytes:
    """Return the file of a saved model.

    Raises `SettingsError` if the file cannot be read, or the kernel does not know such a network:
    it must see a vector with ``features = "flat"``, and choose among discrete actions.
    """
    _check(model, experiment)
    policy: Any = rebuild_network(model, experiment)
    weights = {name: tensor.numpy() for name, tensor in policy.state_dict().items()}
    layers = {part: _layers(weights, part) for part in _PARTS}
    actor = layers["policy_net"]
    widths = [len(actor[0]) - 1, *(layer.shape[1] for layer in actor)]
    header = _header(experiment, widths, model.run.experiment().network.activation)
    content = [layer.tobytes() for part in _PARTS for layer in layers[part]]
    return b"".join([_LENGTH.pack(len(header)), header, *content])


def _check(model: ModelFile, experiment: Experiment) -> None:
    """Raise `SettingsError` if the kernel does not know such a network."""
    network, config = model.run.experiment().network, experiment.config
    reason = ""
    if config.observation != "vector":
        reason = f"it sees {config.observation!r} and not 'vector'"
    elif network.features != "flat":
        reason = f"'network.features' is {network.features!r} and not 'flat'"
    elif config.actions not in COMMANDS:
        reason = f"its actions are {config.actions!r}, and not discrete"
    elif len(network.hidden) >= MAX_LAYERS:
        reason = f"it has more than {MAX_LAYERS - 1} hidden layers"
    if reason:
        raise SettingsError(f"{model.path}: no browser can play this network: {reason}")


def _layers(weights: dict[str, NDArray[np.float32]], part: str) -> list[NDArray[np.float32]]:
    """Return the layers of the actor or the critic, each float32 [inputs + 1, outputs]."""
    beginning = f"mlp_extractor.{part}."
    names = [name.removesuffix(".weight") for name in weights if name.endswith(".weight")]
    hidden = [name for name in names if name.startswith(beginning)]
    hidden.sort(key=lambda name: int(name.removeprefix(beginning)))
    layers = [
        np.vstack([weights[f"{name}.weight"].T, weights[f"{name}.bias"]]).astype("<f4")
        for name in (*hidden, _LAST[part])
    ]
    for one, other in pairwise(layers):
        assert one.shape[1] + 1 == other.shape[0]
    return layers


def _header(experiment: Experiment, widths: list[int], activation: str) -> bytes:
    """Return what the file says of the network: the game that it plays, widths and activation."""
    header = {
        "name": experiment.name,
        "env_id": experiment.env_id,
        "config": experiment.config.plain(),
        "widths": widths,
        "activation": activation,
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    return text + b" " * (-len(text) % 4)
