"""Feature extractors: what comes before the layers of the policy and of the value function."""

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from gymnasium import spaces
from stable_baselines3.common.torch_layers import (
    BaseFeaturesExtractor,
    FlattenExtractor,
    NatureCNN,
)
from torch import nn

from ...envs.config import Config
from ...envs.rules import COLUMNS, ROWS
from ..experiment.settings import Network
from ..measure.landing import PARTS, fastest_ball
from .landing import LandingExtractor

ACTIVATIONS: dict[str, type[nn.Module]] = {
    "tanh": nn.Tanh,
    "relu": nn.ReLU,
    "elu": nn.ELU,
    "silu": nn.SiLU,
}


class LatticeExtractor(BaseFeaturesExtractor):
    """Sees the bricks of a `vector` observation as a picture.

    The bricks go through convolutions as a plane [18, 11]; the features are the convolutions'
    result and all other numbers of the observation.

    Args:
        observation_space: of the vectors.
        bricks: first and last index (exclusive) of the lattice's cells, row by row.
        channels: of the convolutions, each of which halves the picture.
        embedding: how many features the convolutions return.
        activation: between the layers.
    """

    def __init__(
        self,
        observation_space: spaces.Box,
        bricks: tuple[int, int],
        channels: Sequence[int],
        embedding: int,
        activation: str,
    ) -> None:
        (length,) = observation_space.shape
        self._start, self._stop = bricks
        cells = self._stop - self._start
        if cells != ROWS * COLUMNS:
            raise ValueError(f"the lattice has {ROWS * COLUMNS} cells; the slice has {cells}")
        super().__init__(observation_space, length - cells + embedding)
        self.lattice = nn.Sequential(
            nn.Unflatten(1, (1, ROWS, COLUMNS)),
            *convolutions((1, ROWS, COLUMNS), channels, embedding, activation),
        )

    def forward(self, observations: torch.Tensor) -> torch.Tensor:
        """Return features [n, size] of observations [n, length]."""
        bricks = observations[:, self._start : self._stop]
        others = (observations[:, : self._start], observations[:, self._stop :])
        return torch.cat((*others, self.lattice(bricks)), dim=1)


class PlanesExtractor(BaseFeaturesExtractor):
    """Convolutions over the planes of a `grid` or the channels of an `rgb` observation."""

    def __init__(
        self,
        observation_space: spaces.Box,
        channels: Sequence[int],
        embedding: int,
        activation: str,
    ) -> None:
        super().__init__(observation_space, embedding)
        shape = observation_space.shape
        self.planes = nn.Sequential(*convolutions(shape, channels, embedding, activation))

    def forward(self, observations: torch.Tensor) -> torch.Tensor:
        """Return features [n, size] of observations [n, planes, rows, columns]."""
        features: torch.Tensor = self.planes(observations)
        return features


def convolutions(
    shape: tuple[int, ...], channels: Sequence[int], embedding: int, activation: str
) -> list[nn.Module]:
    """Return layers from pictures [channels, rows, columns] to ``embedding`` numbers."""
    depth, rows, columns = shape
    layers: list[nn.Module] = []
    for width in channels:
        layers += [nn.Conv2d(depth, width, 3, stride=2, padding=1), ACTIVATIONS[activation]()]
        depth, rows, columns = width, (rows + 1) // 2, (columns + 1) // 2
    flat = depth * rows * columns
    return [*layers, nn.Flatten(), nn.Linear(flat, embedding), ACTIVATIONS[activation]()]


def extractor_arguments(
    network: Network, config: Config, layout: Mapping[str, slice]
) -> dict[str, Any]:
    """Return the part of stable-baselines3's ``policy_kwargs`` that makes the features.

    Args:
        network: the settings.
        config: the environment's; its observation is ``"vector"``, ``"grid"`` or ``"rgb"``.
        layout: the observation's named slices.
    """
    chosen: str = network.features
    if chosen == "auto":
        chosen = {"vector": "lattice", "grid": "planes", "rgb": "nature"}[config.observation]
    common = {
        "channels": tuple(network.channels),
        "embedding": network.embedding,
        "activation": network.activation,
    }
    if chosen == "landing":
        where = {name: (layout[name].start, layout[name].stop) for name in PARTS}
        return {
            "features_extractor_class": LandingExtractor,
            "features_extractor_kwargs": {"layout": where, "speed": fastest_ball(config.speed)},
        }
    if chosen == "lattice":
        bricks = layout["bricks"]
        return {
            "features_extractor_class": LatticeExtractor,
            "features_extractor_kwargs": {"bricks": (bricks.start, bricks.stop), **common},
        }
    if chosen == "planes":
        return {
            "features_extractor_class": PlanesExtractor,
            "features_extractor_kwargs": common,
        }
    if chosen == "nature":
        return {
            "features_extractor_class": NatureCNN,
            "features_extractor_kwargs": {"features_dim": network.embedding},
        }
    return {"features_extractor_class": FlattenExtractor}
