"""Keys and the mouse: what they mean, and what they command. No window is needed for it."""

import itertools
from enum import Enum, auto
from typing import Any

import numpy as np

from ..actions import COMMANDS
from ..config import Config


class Key(Enum):
    """What a key or a mouse button means."""

    LEFT = auto()
    RIGHT = auto()
    FIRE = auto()
    PAUSE = auto()
    RESTART = auto()
    NEXT = auto()
    FULL_SCREEN = auto()
    QUIT = auto()


# SDL's codes, which are pygame's: a letter's is that of its character, the arrows' are their own.
RIGHT_ARROW = 0x4000004F
LEFT_ARROW = 0x40000050
ESCAPE = 27
KEYS = {
    LEFT_ARROW: Key.LEFT,
    ord("a"): Key.LEFT,
    RIGHT_ARROW: Key.RIGHT,
    ord("d"): Key.RIGHT,
    ord(" "): Key.FIRE,
    ord("p"): Key.PAUSE,
    ord("r"): Key.RESTART,
    ord("n"): Key.NEXT,
    ord("f"): Key.FULL_SCREEN,
    ESCAPE: Key.QUIT,
}

# The mouse's velocities are whole parts of this of the paddle's speed: with few different commands
# a replay stays small, and the paddle is still placed to within 1 / 300 of a brick's width.
STEPS = 32


class Controls:
    """What the player holds and points at, and what that commands.

    Of keys and mouse the one that was moved last moves the paddle.
    """

    def __init__(self) -> None:
        self._held: set[Key] = set()
        self._tapped = False  # fire, since the latest command: no tap is too short
        self._target: float | None = None

    def press(self, key: Key) -> None:
        """Note that a key goes down."""
        self._held.add(key)
        if key is Key.FIRE:
            self._tapped = True
        elif key in (Key.LEFT, Key.RIGHT):
            self._target = None

    def release(self, key: Key) -> None:
        """Note that a key goes up."""
        self._held.discard(key)

    def point(self, x: float) -> None:
        """Note where the mouse points: x in the field, in brick widths; the walls count too."""
        self._target = x

    def let_go(self) -> None:
        """Forget all that is held and pointed at."""
        self._held.clear()
        self._tapped = False
        self._target = None

    def command(self, paddle_x: float, paddle_speed: float) -> tuple[float, float]:
        """Return the velocity in [-1, 1] and fire (0 or 1) of the next tick.

        Args:
            paddle_x: where the paddle is.
            paddle_speed: how far it comes in a tick.
        """
        fire = self._tapped or Key.FIRE in self._held
        self._tapped = False
        if self._target is None:
            return float(move_of(self._held)), float(fire)
        part = (self._target - paddle_x) / paddle_speed
        return round(max(-1.0, min(1.0, part)) * STEPS) / STEPS, float(fire)


def move_of(held: set[Key]) -> int:
    """Return the direction of the keys that are held: -1, 0 or 1."""
    return (Key.RIGHT in held) - (Key.LEFT in held)


def keys_to_action(config: Config) -> dict[tuple[int, ...], Any]:
    """Return the action of each combination of keys, by their codes, for `gymnasium.utils.play`."""
    moving = [code for code, key in KEYS.items() if key in (Key.LEFT, Key.RIGHT, Key.FIRE)]
    actions: dict[tuple[int, ...], Any] = {}
    for count in range(1, len(moving) + 1):
        for codes in itertools.combinations(sorted(moving), count):
            held = {KEYS[code] for code in codes}
            actions[codes] = _action(config, move_of(held), Key.FIRE in held)
    return actions


def _action(config: Config, move: int, fire: bool) -> Any:
    """Return the action that moves and fires; without a fire button none fires."""
    table = COMMANDS.get(config.actions)
    if table is None:
        return np.array([move, fire], np.float32)
    can_fire = bool(table[:, 1].any())
    return int(np.flatnonzero((table == [move, fire and can_fire]).all(axis=1))[0])
