"""Keys and the mouse: what they mean, and what they command. This needs no window."""

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
    FASTER = auto()
    SLOWER = auto()
    HELP = auto()
    SOUND = auto()
    QUIT = auto()


# SDL's key codes, which pygame uses: letters have the codes of their characters, arrows their own.
RIGHT_ARROW = 0x4000004F
LEFT_ARROW = 0x40000050
DOWN_ARROW = 0x40000051
UP_ARROW = 0x40000052
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
    # Plus is typed with shift on some keyboards, where its key is that of the equals sign.
    ord("+"): Key.FASTER,
    ord("="): Key.FASTER,
    UP_ARROW: Key.FASTER,
    ord("-"): Key.SLOWER,
    DOWN_ARROW: Key.SLOWER,
    ord("h"): Key.HELP,
    ord("m"): Key.SOUND,
    ESCAPE: Key.QUIT,
}

# The mouse's velocities are multiples of 1 / STEPS of the paddle's speed. Few different commands
# keep a replay small, and the paddle still stops within 1 / 300 of a brick width of the mouse.
STEPS = 32


class Controls:
    """The state of keys and mouse, and what it commands.

    The paddle follows whichever was used last, the keys or the mouse.
    """

    def __init__(self) -> None:
        self._held: set[Key] = set()
        self._tapped = False  # fire was pressed since the latest command: no tap is too short
        self._target: float | None = None

    def press(self, key: Key) -> None:
        """Note that a key is pressed."""
        self._held.add(key)
        if key is Key.FIRE:
            self._tapped = True
        elif key in (Key.LEFT, Key.RIGHT):
            self._target = None

    def release(self, key: Key) -> None:
        """Note that a key is released."""
        self._held.discard(key)

    def point(self, x: float) -> None:
        """Note where the mouse points: x in the field, in brick widths; it may be outside."""
        self._target = x

    def let_go(self) -> None:
        """Forget all keys and the mouse."""
        self._held.clear()
        self._tapped = False
        self._target = None

    def command(self, paddle_x: float, paddle_speed: float) -> tuple[float, float]:
        """Return the velocity in [-1, 1] and fire (0 or 1) of the next tick.

        Args:
            paddle_x: the paddle's x.
            paddle_speed: how far it can move per tick.
        """
        fire = self._tapped or Key.FIRE in self._held
        self._tapped = False
        if self._target is None:
            return float(move_of(self._held)), float(fire)
        part = (self._target - paddle_x) / paddle_speed
        return round(max(-1.0, min(1.0, part)) * STEPS) / STEPS, float(fire)


def move_of(held: set[Key]) -> int:
    """Return where the held keys move the paddle: -1 left, 0 nowhere, 1 right."""
    return (Key.RIGHT in held) - (Key.LEFT in held)


def keys_to_action(config: Config) -> dict[tuple[int, ...], Any]:
    """Return the action of each combination of key codes, for `gymnasium.utils.play`."""
    moving = [code for code, key in KEYS.items() if key in (Key.LEFT, Key.RIGHT, Key.FIRE)]
    actions: dict[tuple[int, ...], Any] = {}
    for count in range(1, len(moving) + 1):
        for codes in itertools.combinations(sorted(moving), count):
            held = {KEYS[code] for code in codes}
            actions[codes] = _action(config, move_of(held), Key.FIRE in held)
    return actions


def _action(config: Config, move: int, fire: bool) -> Any:
    """Return the action that moves and fires, or one that moves if none does both."""
    table = COMMANDS.get(config.actions)
    if table is None:
        return np.array([move, fire], np.float32)
    moves = table[:, 0] == move
    # Of those that move so, the one that fires or does not, or else the only one.
    return int((2 * moves + (moves & (table[:, 1] == fire))).argmax())
