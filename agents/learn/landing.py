"""A features extractor that tells a network where the balls will land."""

from collections.abc import Mapping

import torch
from gymnasium import spaces
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor

from ...envs.rules import FIELD_WIDTH, MAX_BALLS
from ..measure.landing import PARTS, landings

# A time of 1 in ticks, and the largest one.
TICKS = 100.0
LATEST = 3.0
_LATER = 1e30
# The place, the paddle's way there, and the time: of each ball, and of the one that is next.
EXTRA = 3 * (MAX_BALLS + 1)


class LandingExtractor(BaseFeaturesExtractor):
    """The numbers of a `vector` observation, and where and when its balls come down.

    The features are the observation and `EXTRA` more numbers: first of the ball that comes down
    next, then of all balls: x, x less the paddle's, and ticks / 100, at most 3. x is on the
    field's scale. The balls fly among the walls alone. A held ball is there already; numbers of
    balls that are absent are 0.

    Args:
        observation_space: of the vectors.
        layout: first and last index (exclusive) of the parts `measure.landing.PARTS`.
        speed: of a ball whose velocity is 1 in the observations, per tick.
    """

    def __init__(
        self, observation_space: spaces.Box, layout: Mapping[str, tuple[int, int]], speed: float
    ) -> None:
        (length,) = observation_space.shape
        super().__init__(observation_space, length + EXTRA)
        self._layout = {name: slice(*layout[name]) for name in PARTS}
        self._speed = speed

    def extra(self, observations: torch.Tensor) -> torch.Tensor:
        """Return the additional features [n, `EXTRA`] of observations [n, k].

        The numbers before the bricks are enough.
        """
        found = landings(observations, self._layout, self._speed, torch)
        there = found.there.to(observations.dtype)
        x = (found.x * (2.0 / FIELD_WIDTH) - 1.0) * there
        paddle = observations[:, self._layout["paddle"].start].unsqueeze(1)
        ways = (x - paddle) * there
        times = (found.time / TICKS).clamp(-LATEST, LATEST)
        # Balls that fly come before those that are held.
        waits = torch.where(found.there, _LATER, torch.inf)
        order = torch.where(found.falls | found.rises, found.time, waits)
        following = order.argmin(1, keepdim=True)
        parts = (x, ways, times)
        return torch.cat([*(part.gather(1, following) for part in parts), *parts], dim=1)

    def forward(self, observations: torch.Tensor) -> torch.Tensor:
        """Return features [n, length + `EXTRA`] of observations [n, length]."""
        return torch.cat([observations, self.extra(observations)], dim=1)
