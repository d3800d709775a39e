"""Shows a recorded game, with pauses. This needs no window."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..batch.batch import Batch
from ..batch.playback import replay_states
from ..batch.replays import Replay
from ..draw.overlay import draw_overlay
from ..draw.picture import draw_world
from .controls import Key
from .pace import Pace

HINT_SECONDS = 4.0  # how long the window shows the keys at first
_HINT = ("SPACE: PAUSE   + -: SPEED", "R: FROM THE START   F: FULL SCREEN   ESC: QUIT")
REPLAY_KEYS = "space: pause, + faster, - slower, R: from the start, F: full screen, Esc: quit"


class Viewer:
    """Plays a recorded game again, and checks that it is the same game.

    Args:
        replay: the game.
        speed: a factor on the speed at which it was played.
        height: the height of the pictures, in pixels.

    Attributes:
        paused: whether the game is paused.
        ended: whether the user has asked to quit.

    Raises:
        ReplayDivergedError: here and in `tick`: the game differs from the recording.
    """

    def __init__(self, replay: Replay, speed: float, height: int) -> None:
        self._pace = Pace(replay.frames_per_second, speed)
        self._hints = round(HINT_SECONDS * self._pace.frames_per_second)
        self.paused = False
        self.ended = False
        self._over = False
        self._replay = replay
        self._height = height
        self._states: Iterator[Batch]
        self._batch: Batch
        self._begin()

    @property
    def frames_per_second(self) -> float:
        """How many pictures per second give the present speed."""
        return self._pace.frames_per_second

    def press(self, key: Key) -> None:
        """React to a key that is pressed: pause or continue, another speed, begin again, quit."""
        if self._pace.press(key):
            return
        if key is Key.QUIT:
            self.ended = True
        elif key is Key.RESTART:
            self._begin()
        elif key in (Key.PAUSE, Key.FIRE):
            if self._over:
                self._begin()
            else:
                self.paused = not self.paused

    def release(self, key: Key) -> None:
        """Do nothing: released keys have no meaning here."""

    def point(self, x: float) -> None:
        """Do nothing: the mouse has no meaning here."""

    def lose_focus(self) -> None:
        """Do nothing: the show goes on."""

    def tick(self) -> None:
        """Go on by one picture, unless the game is paused."""
        for _ in range(0 if self.paused or self._over else self._pace.stride):
            state = next(self._states, None)
            if state is None:
                self._over = True
                break
            self._batch = state

    def picture(self) -> NDArray[np.uint8]:
        """Return the present picture, uint8 [height, width, 3]."""
        picture = draw_world(self._batch.worlds, self._batch.rules, 0, self._height)
        draw_overlay(picture, *self.text())
        self._hints = max(0, self._hints - 1)
        return picture

    def text(self) -> tuple[str, tuple[str, ...]]:
        """Return the title and the lines over the picture; both may be empty."""
        if self._over:
            result = self._replay.result
            score = f"SCORE {result.score}   ROUND {result.round}"
            return "THE END", (score, "", "SPACE: AGAIN   ESC: QUIT")
        if self.paused:
            keys = "SPACE: GO ON   R: FROM THE START"
            return "PAUSED", (keys, "+ -: SPEED   F: FULL SCREEN   ESC: QUIT")
        speed = self._pace.text()
        return "", (speed,) if speed else _HINT if self._hints else ()

    def _begin(self) -> None:
        self._states = replay_states(self._replay)
        self._batch = next(self._states)
        self.paused = self._over = False
