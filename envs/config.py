"""Every option of the environment, with its meaning and checked: the keywords of `gym.make`."""

import os
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from enum import Enum
from typing import Any

import numpy as np

from .checks import check_boolean, check_choice, check_integer, check_number
from .hints import keyword_hint
from .rules import CAPSULE_RATE, DEFLECTIONS, REWARDS

# What the keywords that take one of some words mean by each.
OBSERVATIONS = {
    "vector": "float32 numbers",
    "grid": "float32 planes over the cells of the field",
    "rgb": "uint8 pictures",
    "dict": "pictures and numbers together, with the keys ``'rgb'`` and ``'vector'``",
}
ACTIONS = {
    "discrete6": "0 nothing, 1 left, 2 right, and 3, 4, 5 the same with fire",
    "discrete4": "0 nothing, 1 fire, 2 right, 3 left, as in Atari's Breakout, for its wrappers",
    "discrete3": "0 nothing, 1 left, 2 right, while balls leave the paddle and the laser shoots by "
    "themselves",
    "box": "float32 [2], each in [-1, 1]: the paddle's velocity (1: full speed to the right), and "
    "fire if positive; values beyond a bound count as the bound",
}
CHANNELS = {
    "first": "``[channels, height, width]``, for the networks of torch",
    "last": "``[height, width, channels]``, for the wrappers of Gymnasium and Atari",
}
REWARD_MEANINGS = {
    "progress": "each needed hit pays 1 / needed hits of the round, and clearing it pays 1",
    "score": "points / 1000",
    "sparse": "clearing a round pays 1",
}
DEFLECTION_MEANINGS = {
    "angle": "the place on the paddle where the ball lands decides its angle",
    "zones6": "six zones of the paddle give six fixed angles",
    "physical": "the ball bounces from the paddle's shape",
}
# The keywords that say only how a game is seen, or cut into episodes. All others decide its course.
_PICTURES = ("size", "grey", "stack", "channels")
SEEN = ("observation", "landing", *_PICTURES, "episodic_life")
MAX_SIZE = 4096  # pixels, of a picture's height and width
MAX_STACK = 64
MOST_WORLDS = 1 << 30  # of the largest pictures: more are no size of an array
MOST_DECISIONS = 10**12
# The least and the most of the keywords of the game that are whole numbers, and of other numbers.
WHOLE_LIMITS = {"frame_skip": (1, 1000), "lives": (1, 1000), "max_decisions": (1, MOST_DECISIONS)}
LIMITS = {
    "sticky_action": (0.0, 1.0),
    "life_penalty": (0.0, 1e9),
    "speed": (1e-3, 1e6),
    "paddle": (0.25, 5.0),
    "difficulty": (0.0, 1.0),
    "capsule_rate": (0.0, 1.0),
}


def _keyword(default: Any, meaning: str, words: Mapping[str, str] | None = None) -> Any:
    """Return a dataclass field that knows its meaning, and the meanings of its words."""
    return field(default=default, metadata={"meaning": meaning, "words": words or {}})


@dataclass(frozen=True)
class Config:
    """The configuration of an environment; every field is a keyword of `gym.make`."""

    observation: str = _keyword("vector", "what is observed", OBSERVATIONS)
    size: int | Sequence[int] = _keyword(
        84, "with pictures: their height and width in pixels, or (height, width)"
    )
    grey: bool = _keyword(False, "with pictures: one channel, brightness, instead of three")
    stack: int = _keyword(
        1, "with pictures: how many of the latest ones an observation shows, the newest last"
    )
    channels: str = _keyword("first", "with pictures: which axis has the channels", CHANNELS)
    landing: bool = _keyword(
        False,
        "with vectors and dict: whether they say where and when each ball will come down to the "
        "paddle, among walls, bricks and the boss as they stand",
    )
    actions: str = _keyword("discrete6", "the action space", ACTIONS)
    reward: str = _keyword("progress", "what a decision pays", REWARD_MEANINGS)
    frame_skip: int = _keyword(4, "ticks per decision; the reward is their sum")
    sticky_action: float = _keyword(0.0, "the probability that a decision repeats the one before")
    lives: int = _keyword(3, "how many balls may be lost; then the episode terminates")
    episodic_life: bool = _keyword(
        False,
        "whether each lost life ends an episode. The game goes on behind it: the next episode "
        "begins where the game is, until the last life is lost or the game is truncated. A reset "
        "with a seed or options, or in the middle of an episode, begins a new game",
    )
    life_penalty: float = _keyword(0.0, "is taken off the reward for each lost life")
    levels: str | range | Sequence[str] = _keyword(
        "campaign",
        "which levels are played. ``'campaign'``: the named levels, the boss last, then generated "
        "ones without end; ``'train'`` or ``'test'``: generated from the training or test seeds; "
        "``'seed:7'``, ``'seeds:100-200'`` or a ``range``: generated from these seeds; the name of "
        "a packaged level, the path of a level file, or a sequence of these: in turn, again and "
        "again",
    )
    difficulty: float | None = _keyword(
        None, "of generated levels, in [0, 1]; None: it rises from round to round"
    )
    capsules: bool = _keyword(True, "whether bricks hide capsules")
    capsule_rate: float = _keyword(CAPSULE_RATE, "the fraction of coloured bricks that hide one")
    enemies: bool = _keyword(True, "whether there are enemies and the boss")
    speed: float = _keyword(1.0, "a factor on the ball's speed")
    paddle: float = _keyword(
        1.0, "a factor on the paddle's width; enlarged, it is at most as wide as the field"
    )
    deflection: str = _keyword("angle", "how the paddle deflects a ball", DEFLECTION_MEANINGS)
    max_decisions: int = _keyword(27_000, "decisions after which the episode is truncated")

    def __post_init__(self) -> None:
        check_choice("observation", self.observation, tuple(OBSERVATIONS))
        self._check_pictures()
        check_boolean("landing", self.landing)
        if self.landing and self.observation not in ("vector", "dict"):
            raise ValueError(
                f"landing={self.landing!r} adds numbers to vectors, and observation="
                f"{self.observation!r} has none: leave it out, or use observation='vector'"
            )
        check_choice("actions", self.actions, tuple(ACTIONS))
        check_choice("reward", self.reward, tuple(REWARDS))
        check_choice("deflection", self.deflection, tuple(DEFLECTIONS))
        for name, limits in WHOLE_LIMITS.items():
            check_integer(name, getattr(self, name), *limits)
        for name, bounds in LIMITS.items():
            if name != "difficulty" or self.difficulty is not None:
                check_number(name, getattr(self, name), *bounds)
        for name in ("episodic_life", "capsules", "enemies"):
            check_boolean(name, getattr(self, name))
        object.__setattr__(self, "levels", _paths_as_text(self.levels))
        _check_levels(self.levels)

    def _check_pictures(self) -> None:
        if not isinstance(self.size, int | np.integer):
            if isinstance(self.size, str) or not isinstance(self.size, Sequence):
                raise TypeError(f"size must be an integer or (height, width); got {self.size!r}")
            if len(self.size) != 2:
                raise ValueError(f"size must be an integer or (height, width); got {self.size!r}")
            # A tuple, because JSON and TOML give lists.
            object.__setattr__(self, "size", tuple(self.size))
        for pixels in self.picture_size:
            check_integer("size", pixels, 1, MAX_SIZE)
        check_boolean("grey", self.grey)
        check_integer("stack", self.stack, 1, MAX_STACK)
        check_choice("channels", self.channels, tuple(CHANNELS))
        if self.observation in ("rgb", "dict"):
            return
        for keyword in fields(self):
            value = getattr(self, keyword.name)
            if keyword.name in _PICTURES and value != keyword.default:
                raise ValueError(
                    f"{keyword.name}={value!r} says how pictures look, and observation="
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
    def from_keywords(cls, keywords: dict[str, Any], others: Sequence[str] = ()) -> "Config":
        """Return the configuration.

        Args:
            keywords: the values that are not the defaults.
            others: keywords that the caller takes itself; errors name them, too.

        Raises:
            TypeError: a keyword is unknown (the message says which one is meant), or a value has
                the wrong type.
            ValueError: a value is out of range.
        """
        known = [keyword.name for keyword in fields(cls)]
        for name in keywords:
            if name not in known:
                hint = keyword_hint(name, [*known, *others])
                # These are Python's own words: TorchRL's `GymEnv` looks for them.
                raise TypeError(f"got an unexpected keyword argument {name!r}; {hint}")
        return cls(**keywords)

    def plain(self) -> dict[str, Any]:
        """Return the keywords as JSON and TOML hold them; `from_keywords` takes them back."""
        return {keyword: plain(value) for keyword, value in vars(self).items()}

    def of_the_game(self) -> "Config":
        """Return the same game with the default observation, as one episode."""
        keywords = vars(self).items()
        return Config(**{name: value for name, value in keywords if name not in SEEN})


def plain(value: Any) -> Any:
    """Return a keyword's value as JSON and TOML hold it."""
    if isinstance(value, range):
        return f"seeds:{value.start}-{value.stop - 1}"
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(item) for item in value]
    return value


def _paths_as_text(levels: Any) -> Any:
    """Return the value of `levels` with text in place of each `pathlib.Path`."""
    if isinstance(levels, os.PathLike):
        return os.fspath(levels)
    if isinstance(levels, list | tuple):
        return type(levels)(
            os.fspath(item) if isinstance(item, os.PathLike) else item for item in levels
        )
    return levels


def _check_levels(value: object) -> None:
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


def _describe_keywords() -> str:
    """Return the part of `Config`'s docstring that its fields give."""
    lines = ["Args:"]
    for keyword in fields(Config):
        words = (f"``{word!r}``: {text}" for word, text in keyword.metadata["words"].items())
        meaning = ". ".join([keyword.metadata["meaning"], "; ".join(words)]).removesuffix(" ")
        text = f"{keyword.name}: {meaning.removesuffix('.')}."
        lines += textwrap.wrap(text, 92, initial_indent="    ", subsequent_indent=" " * 8)
    lines += [
        "",
        "Raises:",
        "    ValueError: a value is out of range; the message says which, and what is legal.",
        "    TypeError: a value has the wrong type.",
    ]
    return "\n".join(lines)


# For `help` and the reference pages.
Config.__doc__ = f"{Config.__doc__}\n\n{_describe_keywords()}"
