"""Where balls come down to the paddle among the walls alone, from vector observations.

Bricks, enemies and the boss are not looked at. The functions take arrays of NumPy or of torch.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ...envs.rules import (
    BALL_RADIUS,
    BALL_SPEED,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    PADDLE_TOP,
    SPEED_STAGE_MAX,
)

_LANDING_HEIGHT = PADDLE_TOP + BALL_RADIUS
_HIGHEST = FIELD_HEIGHT - BALL_RADIUS
# The parts of an observation that are used; all of them come before the bricks.
PARTS = ("paddle", "ball_in_play", "ball_held", "ball_x", "ball_y", "ball_vx", "ball_vy")


class Landings(NamedTuple):
    """Of all balls of all worlds, [n, balls].

    Attributes:
        there, falls, rises: bool. What neither falls nor rises is held, or is not there.
        x: in brick widths, of a ball that neither falls nor rises where it is.
        time: until then, in ticks times ``speed``; 0 for one that neither falls nor rises.
    """

    there: Any
    falls: Any
    rises: Any
    x: Any
    time: Any


def fastest_ball(speed: float) -> float:
    """Return the speed that is 1 in observations, per tick, for the environment's ``speed``."""
    return BALL_SPEED * speed * (1.0 + 0.25 * SPEED_STAGE_MAX)


def landings(
    observations: Any, layout: Mapping[str, slice], speed: float = 1.0, array: Any = np
) -> Landings:
    """Return where and when the balls come down.

    A rising ball first flies to the ceiling. The balls keep their speed.

    Args:
        observations: [n, k]; those of the game, or their first numbers.
        layout: the slices of `PARTS`.
        speed: that is 1 in the observations; without it, times are in its unit.
        array: the module of the observations, `numpy` or `torch`.
    """
    x = (observations[:, layout["ball_x"]] + 1.0) * (FIELD_WIDTH / 2)
    y = (observations[:, layout["ball_y"]] + 1.0) * (FIELD_HEIGHT / 2)
    vx, vy = observations[:, layout["ball_vx"]] * speed, observations[:, layout["ball_vy"]] * speed
    there = observations[:, layout["ball_in_play"]] > 0.5
    flies = there & (observations[:, layout["ball_held"]] < 0.5)
    # One that is about to leave the field can't come back.
    falls = flies & (vy < 0.0) & (y > BALL_RADIUS)
    rises = flies & (vy > 0.0)
    down = y - _LANDING_HEIGHT
    up_and_down = (_HIGHEST - y) + (_HIGHEST - _LANDING_HEIGHT)
    way = array.where(falls, down, array.where(rises, up_and_down, 0.0 * y))
    time = way / array.where(falls | rises, array.abs(vy), 0.0 * vy + 1.0)
    return Landings(there, falls, rises, between_walls(x + vx * time, array), time)


def between_walls(x: Any, array: Any = np) -> Any:
    """Return the positions of balls that would be at x if the walls did not reflect them."""
    width = FIELD_WIDTH - 2 * BALL_RADIUS
    return BALL_RADIUS + width - array.abs(array.remainder(x - BALL_RADIUS, 2 * width) - width)


def next_ball(observations: Any, layout: Mapping[str, slice]) -> tuple[Any, Any]:
    """Return where the ball that lands next comes down, [n], and whether any ball falls, bool [n].

    If none falls, it is where the first ball of those in play is. The arrays are NumPy's.
    """
    found = landings(observations, layout)
    x = (observations[:, layout["ball_x"]] + 1.0) * (FIELD_WIDTH / 2)
    rows, any_falls = np.arange(len(observations)), found.falls.any(axis=1)
    first = np.where(found.falls, found.time, np.inf).argmin(axis=1)
    ball = np.where(any_falls, first, found.there.argmax(axis=1))
    return np.where(any_falls, found.x[rows, ball], x[rows, ball]), any_falls
