"""Every knob of the environment, validated: what `gym.make`'s keywords become."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from difflib import get_close_matches
from typing import Any

import numpy as np

from .rules import DEFLECTIONS, REWARDS

ACTIONS = ("discrete6", "discrete3")
OBSERVATIONS = ("vector",)


@dataclass(frozen=True)
class Config:
    """The configuration of an environment; every field is a keyword of `gym.make`.

    Args:
        observation: ``"vector"``.
        actions: ``"discrete6"``, (no-op, left, right) × (fire), or ``"discrete3"``, without fire.
        reward: ``"progress"`` (each needed hit pays 1 / needed hits of the round, clearing pays 1),
            ``"score"`` (points / 1000) or ``"sparse"`` (1 for clearing a round).
        frame_skip: ticks a decision lasts; the reward is summed.
        sticky_action: probability that a decision repeats the one before.
        lives: balls one may lose before the episode terminates.
        life_penalty: what the loss of a life costs.
        levels: names of packaged rounds or paths of level files, played in turn.
        speed: factor on the ball's speed.
        paddle: factor on the paddle's width.
        deflection: ``"angle"`` (by where on the paddle the ball lands), ``"zones6"`` (six fixed
            directions) or ``"physical"`` (the pure bounce from the paddle's shape).
        max_decisions: decisions after which an episode is truncated.

    Raises:
        ValueError: a value is out of range; the message says which and what is legal.
        TypeError: a value is of the wrong type.
    """

    observation: str = "vector"
    actions: str = "discrete6"
    reward: str = "progress"
    frame_skip: int = 4
    sticky_action: float = 0.0
    lives: int = 3
    life_penalty: float = 0.0
    levels: Sequence[str] = ("ripple",)
    speed: float = 1.0
    paddle: float = 1.0
    deflection: str = "angle"
    max_decisions: int = 27_000

    def __post_init__(self) -> None:
        _choice("observation", self.observation, OBSERVATIONS)
        _choice("actions", self.actions, ACTIONS)
        _choice("reward", self.reward, tuple(REWARDS))
        _choice("deflection", self.deflection, tuple(DEFLECTIONS))
        _integer("frame_skip", self.frame_skip, 1, 1000)
        _integer("lives", self.lives, 1, 1000)
        _integer("max_decisions", self.max_decisions, 1, 10**12)
        _number("sticky_action", self.sticky_action, 0.0, 1.0)
        _number("life_penalty", self.life_penalty, 0.0, 1e9)
        _number("speed", self.speed, 1e-3, 1e6)
        _number("paddle", self.paddle, 0.25, 5.0)
        _strings("levels", self.levels)

    @classmethod
    def from_keywords(cls, keywords: dict[str, Any]) -> "Config":
        """Return the configuration; an unknown keyword is a TypeError naming the nearest one."""
        known = [field.name for field in fields(cls)]
        for name in keywords:
            if name not in known:
                near = get_close_matches(name, known, 1)
                hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}."
                raise TypeError(f"unknown environment keyword {name!r}; {hint}")
        return cls(**keywords)


def _choice(name: str, value: object, legal: tuple[str, ...]) -> None:
    if value not in legal:
        raise ValueError(f"{name} must be one of {', '.join(map(repr, legal))}; got {value!r}")


def _integer(name: str, value: object, low: int, high: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(f"{name} must be an integer; got {value!r}")
    if not low <= value <= high:
        raise ValueError(f"{name} must be between {low} and {high}; got {value!r}")


def _number(name: str, value: object, low: float, high: float) -> None:
    if isinstance(value, bool) or not isinstance(value, float | int | np.floating | np.integer):
        raise TypeError(f"{name} must be a number; got {value!r}")
    if not (math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} must be between {low:g} and {high:g}; got {value!r}")


def _strings(name: str, value: object) -> None:
    if isinstance(value, str) or not isinstance(value, Sequence) or not value:
        raise TypeError(f"{name} must be a non-empty sequence of names or paths; got {value!r}")
    for item in value:
        if not isinstance(item, str):
            raise TypeError(f"{name} must hold names or paths as text; got {item!r}")
