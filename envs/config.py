"""Every knob of the environment, validated: what `gym.make`'s keywords become."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from difflib import get_close_matches
from typing import Any

import numpy as np

from .checks import check_choice, check_integer, check_number
from .rules import CAPSULE_RATE, DEFLECTIONS, REWARDS

ACTIONS = ("discrete6", "discrete3", "box")
OBSERVATIONS = ("vector", "grid", "rgb")
# The keywords that say how a game is seen. All others decide its course.
_PICTURES = ("size", "grey", "stack")
_SEEN = ("observation", *_PICTURES)
MAX_SIZE = 4096  # pixels, of a picture's height and width
MAX_STACK = 64


@dataclass(frozen=True)
class Config:
    """The configuration of an environment; every field is a keyword of `gym.make`.

    Args:
        observation: ``"vector"`` (float32 numbers, see `observation`), ``"grid"`` (float32 planes
            over the cells of the field, see `grid`) or ``"rgb"`` (uint8 pictures, see `pixels`).
        size: pixels of a picture's sides, or (height, width). It needs ``"rgb"``, as the next two.
        grey: whether pictures have one channel, their brightness, instead of red, green and blue.
        stack: how many pictures an observation shows, the latest as the last.
        actions: ``"discrete6"``, (no-op, left, right) × (fire); ``"discrete3"``, without fire
            (balls leave the paddle, and the laser shoots, by themselves); or ``"box"``, float32
            [2]: velocity in [-1, 1], as a part of the paddle's speed, and fire if it is positive.
        reward: ``"progress"`` (each needed hit pays 1 / needed hits of the round, clearing pays 1),
            ``"score"`` (points / 1000) or ``"sparse"`` (1 for clearing a round).
        frame_skip: ticks a decision lasts; the reward is summed.
        sticky_action: probability that a decision repeats the one before.
        lives: balls one may lose before the episode terminates.
        life_penalty: what the loss of a life costs.
        levels: ``"campaign"`` (the named rounds, the boss's, then generated ones without end),
            ``"train"`` or ``"test"`` (generated from the seeds for that), ``"seeds:100-200"`` or a
            `range` (generated from these seeds); or a name of a packaged round, the path of a level
            file, or a sequence of such, played in turn again and again.
        difficulty: of generated rounds, in [0, 1]; None lets it rise from round to round.
        capsules: whether there are any.
        capsule_rate: the part of the coloured bricks that hide one.
        enemies: whether there are any, and the boss.
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
    size: int | Sequence[int] = 84
    grey: bool = False
    stack: int = 1
    actions: str = "discrete6"
    reward: str = "progress"
    frame_skip: int = 4
    sticky_action: float = 0.0
    lives: int = 3
    life_penalty: float = 0.0
    levels: str | range | Sequence[str] = "campaign"
    difficulty: float | None = None
    capsules: bool = True
    capsule_rate: float = CAPSULE_RATE
    enemies: bool = True
    speed: float = 1.0
    paddle: float = 1.0
    deflection: str = "angle"
    max_decisions: int = 27_000

    def __post_init__(self) -> None:
        check_choice("observation", self.observation, OBSERVATIONS)
        self._check_pictures()
        check_choice("actions", self.actions, ACTIONS)
        check_choice("reward", self.reward, tuple(REWARDS))
        check_choice("deflection", self.deflection, tuple(DEFLECTIONS))
        check_integer("frame_skip", self.frame_skip, 1, 1000)
        check_integer("lives", self.lives, 1, 1000)
        check_integer("max_decisions", self.max_decisions, 1, 10**12)
        check_number("sticky_action", self.sticky_action, 0.0, 1.0)
        check_number("life_penalty", self.life_penalty, 0.0, 1e9)
        check_number("speed", self.speed, 1e-3, 1e6)
        check_number("paddle", self.paddle, 0.25, 5.0)
        if self.difficulty is not None:
            check_number("difficulty", self.difficulty, 0.0, 1.0)
        _boolean("capsules", self.capsules)
        check_number("capsule_rate", self.capsule_rate, 0.0, 1.0)
        _boolean("enemies", self.enemies)
        _levels(self.levels)

    def _check_pictures(self) -> None:
        if not isinstance(self.size, int | np.integer):
            if isinstance(self.size, str) or not isinstance(self.size, Sequence):
                raise TypeError(f"size must be an integer or (height, width); got {self.size!r}")
            if len(self.size) != 2:
                raise ValueError(f"size must be an integer or (height, width); got {self.size!r}")
            # As a tuple, for JSON and TOML know lists only.
            object.__setattr__(self, "size", tuple(self.size))
        for pixels in self.picture_size:
            check_integer("size", pixels, 1, MAX_SIZE)
        _boolean("grey", self.grey)
        check_integer("stack", self.stack, 1, MAX_STACK)
        if self.observation == "rgb":
            return
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name in _PICTURES and value != field.default:
                raise ValueError(
                    f"{field.name}={value!r} says how pictures look, and observation="
                    f"{self.observation!r} has none: leave it out, or use observation='rgb'"
                )

    @property
    def picture_size(self) -> tuple[int, int]:
        """The height and width of an observed picture, in pixels."""
        if isinstance(self.size, Sequence):
            height, width = self.size
            return height, width
        return self.size, self.size

    @classmethod
    def from_keywords(cls, keywords: dict[str, Any]) -> "Config":
        """Return the configuration; an unknown keyword is a TypeError naming the nearest one."""
        known = [field.name for field in fields(cls)]
        for name in keywords:
            if name not in known:
                near = get_close_matches(name, known, 1)
                hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}."
                # In Python's own words: TorchRL tries a keyword and looks for them (`GymEnv`).
                raise TypeError(f"got an unexpected keyword argument {name!r}; {hint}")
        return cls(**keywords)

    def plain(self) -> dict[str, Any]:
        """Return the keywords as JSON and TOML hold them; `from_keywords` takes them back."""
        return {field.name: _plain(getattr(self, field.name)) for field in fields(self)}

    def of_the_game(self) -> "Config":
        """Return the configuration without what says only how the game is seen."""
        names = [field.name for field in fields(self) if field.name not in _SEEN]
        return Config(**{name: getattr(self, name) for name in names})


def _plain(value: Any) -> Any:
    if isinstance(value, range):
        return f"seeds:{value.start}-{value.stop - 1}"
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(item) for item in value]
    return value


def _boolean(name: str, value: object) -> None:
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{name} must be True or False; got {value!r}")


def _levels(value: object) -> None:
    if isinstance(value, range) or (isinstance(value, str) and value):
        return
    if isinstance(value, str) or not isinstance(value, Sequence) or not value:
        raise TypeError(
            "levels must be 'campaign', 'train', 'test', 'seeds:100-200', a range of seeds, a name "
            f"or path of a level, or a non-empty sequence of such names; got {value!r}"
        )
    for item in value:
        if not isinstance(item, str):
            raise TypeError(f"levels must hold names or paths as text; got {item!r}")
