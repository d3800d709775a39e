"""A sitting: one game after another, with pauses and titles. This needs no window."""

import math
from collections.abc import Callable
from enum import Enum, auto
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..batch.batch import Batch
from ..batch.recorder import Recorder
from ..batch.replays import Replay
from ..checks import check_integer
from ..config import Config
from ..draw.overlay import draw_overlay
from ..draw.picture import draw_world
from ..levels import load_level
from ..levels.generator import MAX_SEED
from ..rules import IDLE_TICKS, TICKS_PER_SECOND
from .controls import Controls, Key

# After a game the fire button does nothing for so long: a player who hammers it sees the score.
OVER_TICKS = 40
TITLE_TICKS = 90  # how long the title of a new round is shown
WARNING_TICKS = 15 * TICKS_PER_SECOND  # the warning comes so long before idling costs a life

HELP = (
    "ARROWS OR MOUSE: MOVE   SPACE OR CLICK: FIRE",
    "P: PAUSE   N: NEXT ROUND   R: RESTART",
    "F: FULL SCREEN   ESC: QUIT",
)

_ALL_WORLDS = np.ones(1, np.bool_)


class Phase(Enum):
    """The phase of a sitting."""

    READY = auto()  # a game is laid out and waits for the player
    PLAYING = auto()
    PAUSED = auto()
    OVER = auto()


class Sitting:
    """The games of one player, each of them recorded.

    Args:
        config: the configuration of the games; a decision should be one tick.
        options: how the games begin, as for `reset`.
        seed: the seed of their random numbers.
        keep: is called with each game that was begun, when it is over or the player leaves it.
        height: the height of the pictures, in pixels.

    Attributes:
        phase: the present phase.
        ended: whether the player has asked to quit.

    Raises:
        ValueError: there is no such level, or an option is illegal.
    """

    def __init__(
        self,
        config: Config,
        options: dict[str, Any],
        seed: int,
        keep: Callable[[Replay], None],
        height: int,
    ) -> None:
        check_integer("seed", seed, 0, MAX_SEED)
        self.phase = Phase.READY
        self.ended = False
        self._keep = keep
        self._height = height
        self._controls = Controls()
        self._batch = Batch(1, config)
        self._recorder = Recorder(self._batch, 0)
        self._batch.seed(0, seed)
        self._phase_ticks = 0  # since this phase began
        self._round_ticks = TITLE_TICKS  # since this round began
        levels = [load_level(name) for name in self._batch.plan.names]
        self._names = {level.kinds.tobytes(): level.name for level in levels}
        self._lay_out(options)

    @property
    def world(self) -> Any:
        """The state, a `World` record."""
        return self._batch.worlds[0]

    def press(self, key: Key) -> None:
        """React to a key that is pressed."""
        if key is Key.QUIT:
            self.ended = True
        elif key is Key.RESTART:
            self._lay_out({})
        elif key is Key.NEXT:
            self._lay_out({"level": int(self.world.round_number) + 1, "seed": None})
        elif key is Key.PAUSE and self.phase in (Phase.PLAYING, Phase.PAUSED):
            self._enter(Phase.PAUSED if self.phase is Phase.PLAYING else Phase.PLAYING)
        elif key is Key.FIRE and self.phase is not Phase.PLAYING:
            self._go_on()
        else:
            self._controls.press(key)

    def release(self, key: Key) -> None:
        """React to a key that is released."""
        self._controls.release(key)

    def point(self, x: float) -> None:
        """React to the mouse: it points at x in the field, in brick widths."""
        self._controls.point(x)

    def lose_focus(self) -> None:
        """Pause: the player looks elsewhere."""
        if self.phase is Phase.PLAYING:
            self._enter(Phase.PAUSED)

    def tick(self) -> None:
        """Play a tick, unless the game is paused."""
        self._phase_ticks += 1
        if self.phase is not Phase.PLAYING:
            return
        speed = float(self._batch.rules["paddle_speed"][0])
        self._batch.commands[0] = self._controls.command(float(self.world.paddle_x), speed)
        self._batch.step()
        self._round_ticks = 0 if self.world.rounds_cleared else self._round_ticks + 1
        if self.world.done:
            self._enter(Phase.OVER)
            self._keep(self._recorder.replay())

    def close(self) -> None:
        """End the sitting; an unfinished game is kept."""
        self._keep_unfinished()
        self._recorder.stop()
        self._batch.close()

    def picture(self) -> NDArray[np.uint8]:
        """Return the present picture, uint8 [height, width, 3]."""
        picture = draw_world(self._batch.worlds, self._batch.rules, 0, self._height)
        draw_overlay(picture, *self.text(), band=self.phase is not Phase.PLAYING)
        return picture

    def text(self) -> tuple[str, tuple[str, ...]]:
        """Return the title and the lines over the picture; both may be empty."""
        if self.phase is Phase.READY:
            return self._round_title(), (*self._round_lines(), "", "SPACE OR CLICK: START", *HELP)
        if self.phase is Phase.PAUSED:
            return "PAUSED", ("SPACE OR CLICK: GO ON", *HELP)
        if self.phase is Phase.OVER:
            return self._ending()
        remaining = IDLE_TICKS - int(self.world.idle)
        if remaining <= WARNING_TICKS:
            return "", (f"HIT A BRICK WITHIN {math.ceil(remaining / TICKS_PER_SECOND)} S",)
        if self._round_ticks < TITLE_TICKS:
            return self._round_title(), self._round_lines()
        return "", ()

    def _lay_out(self, options: dict[str, Any]) -> None:
        """Lay out a new game, and keep the old one."""
        self._keep_unfinished()
        self._batch.reset(_ALL_WORLDS, options)
        self._round_ticks = TITLE_TICKS
        self._enter(Phase.READY)

    def _keep_unfinished(self) -> None:
        if self.world.decisions and not self.world.done:
            self._keep(self._recorder.replay())

    def _go_on(self) -> None:
        """Start the game, continue it, or lay out another one."""
        if self.phase is not Phase.OVER:
            self._enter(Phase.PLAYING)
        elif self._phase_ticks >= OVER_TICKS:
            self._lay_out({})

    def _enter(self, phase: Phase) -> None:
        self.phase = phase
        self._phase_ticks = 0
        self._controls.let_go()

    def _round_title(self) -> str:
        """Return the level's name; if it has none, the round's number."""
        return self._names.get(self.world.kind.tobytes(), f"Round {self.world.round_number}")

    def _round_lines(self) -> tuple[str, ...]:
        number = f"ROUND {self.world.round_number}"
        return () if self._round_title().upper() == number else (number,)

    def _ending(self) -> tuple[str, tuple[str, ...]]:
        result = f"SCORE {self.world.score}   ROUND {self.world.round_number}"
        return "GAME OVER", (result, "", "SPACE OR CLICK: PLAY AGAIN", "ESC: QUIT")
