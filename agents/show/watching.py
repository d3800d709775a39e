"""An agent at play as a show for a window: one game after the other, with pauses and speeds."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ...envs.draw.overlay import draw_overlay
from ...envs.play.controls import Key
from ...envs.play.pace import Pace
from ..experiment.settings import Experiment
from ..measure.policy import Policy
from ..measure.suites import EpisodeStart
from .frames import Frame, can_be_smooth, frame_rate, play_frames

WATCH_KEYS = "space: pause, + faster, - slower, N: next game, R: from the start, Esc: quit"
HINT_SECONDS = 4.0  # how long the first game shows the keys
_HINT = (
    "SPACE: PAUSE   + -: SPEED   N: NEXT GAME",
    "R: FROM THE START   F: FULL SCREEN   ESC: QUIT",
)


class Watching:
    """The evaluation's games, shown one after the other.

    Args:
        experiment: says what is played.
        policy: who plays.
        starts: how the games begin, in turn.
        report: is called with the number of each game that was played to its end, from 1, and its
            last picture.

    Attributes:
        ended: whether the user has asked to quit.
        paused: whether the game is paused.
    """

    def __init__(
        self,
        experiment: Experiment,
        policy: Policy,
        starts: Sequence[EpisodeStart],
        report: Callable[[int, Frame], None],
    ) -> None:
        self.ended = self.paused = False
        self._smooth = can_be_smooth(experiment)
        self._pace = Pace(frame_rate(experiment, self._smooth))
        self._hints = round(HINT_SECONDS * self._pace.frames_per_second)
        self._experiment, self._policy, self._starts = experiment, policy, starts
        self._report = report
        self._game = 0
        self._frames: Iterator[Frame]
        self._frame: Frame
        self._begin()

    @property
    def frames_per_second(self) -> float:
        """How many pictures per second give the present speed."""
        return self._pace.frames_per_second

    def press(self, key: Key) -> None:
        """React to a key: pause or go on, another speed, the next game, begin again, quit."""
        if self._pace.press(key):
            return
        if key is Key.QUIT:
            self.ended = True
        elif key in (Key.PAUSE, Key.FIRE):
            self.paused = not self.paused
        elif key in (Key.NEXT, Key.RESTART):
            self._game += key is Key.NEXT
            self._begin()

    def release(self, key: Key) -> None:
        """Do nothing: released keys have no meaning here."""

    def point(self, x: float) -> None:
        """Do nothing: the mouse has no meaning here."""

    def lose_focus(self) -> None:
        """Do nothing: the show goes on."""

    def tick(self) -> None:
        """Go on by one picture, unless the game is paused; after a game comes the next."""
        for _ in range(0 if self.paused else self._pace.stride):
            frame = next(self._frames, None)
            if frame is None:
                self._report(self._game + 1, self._frame)
                self._game += 1
                self._begin()
                return
            self._frame = frame

    def picture(self) -> NDArray[np.uint8]:
        """Return the present picture, uint8 [height, width, 3]."""
        picture = self._frame.picture.copy()
        draw_overlay(picture, *self.text())
        self._hints = max(0, self._hints - 1)
        return picture

    def text(self) -> tuple[str, tuple[str, ...]]:
        """Return the title and the lines over the picture; both may be empty."""
        if self.paused:
            return "PAUSED", _HINT
        speed = self._pace.text()
        return "", (speed,) if speed else _HINT if self._hints else ()

    def _begin(self) -> None:
        start = self._starts[self._game % len(self._starts)]
        self._frames = play_frames(self._experiment, self._policy, start, self._smooth, self._game)
        self._frame = next(self._frames)
        self.paused = False
