"""A sitting: one game after the other, pauses and titles. No window is needed for it."""

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
from ..levels.files import load_round
from ..levels.generator import MAX_SEED
from ..rules import IDLE_TICKS, TICKS_PER_SECOND
from .controls import Controls, Key

# Whoever still holds or hammers the fire button when the last life is lost sees the score first.
OVER_TICKS = 40
TITLE_TICKS = 90  # that the title of a new round is shown
WARNING_TICKS = 15 * TICKS_PER_SECOND  # before a game is cut for want of a hit

HELP = (
    "ARROWS OR MOUSE: MOVE   SPACE OR CLICK: FIRE",
    "P: PAUSE   N: NEXT ROUND   R: RESTART",
    "F: FULL SCREEN   ESC: QUIT",
)

_EVERYWHERE = np.ones(1, np.bool_)


class Phase(Enum):
    """What a sitting is at."""

    READY = auto()  # a game is laid out, and waits for its player
    PLAYING = auto()
    PAUSED = auto()
    OVER = auto()


class Sitting:
    """Games of one player, each of them recorded.

    Args:
        config: of the games; a decision should be one tick.
        options: how they begin, as for `reset`.
        seed: of their random numbers.
        keep: is given each game that was begun, when it is over or left.
        height: of the pictures, in pixels.

    Attributes:
        phase: what it is at.
        ended: whether the player has asked to leave.

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
        self._waited = 0  # ticks in this phase
        self._title = TITLE_TICKS  # ticks since a round began
        levels = [load_round(name) for name in self._batch.plan.names]
        self._names = {level.kinds.tobytes(): level.name for level in levels}
        self._lay_out(options)

    @property
    def world(self) -> Any:
        """The state, a `World` record."""
        return self._batch.worlds[0]

    def press(self, key: Key) -> None:
        """Do what a key asks for that goes down."""
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
        """Note that a key goes up."""
        self._controls.release(key)

    def point(self, x: float) -> None:
        """Note where the mouse points: x in the field, in brick widths."""
        self._controls.point(x)

    def leave(self) -> None:
        """Pause, for the player looks elsewhere."""
        if self.phase is Phase.PLAYING:
            self._enter(Phase.PAUSED)

    def tick(self) -> None:
        """Play a tick, if no pause is on."""
        self._waited += 1
        if self.phase is not Phase.PLAYING:
            return
        speed = float(self._batch.rules["paddle_speed"][0])
        self._batch.commands[0] = self._controls.command(float(self.world.paddle_x), speed)
        self._batch.step()
        self._title = 0 if self.world.rounds_cleared else self._title + 1
        if self.world.done:
            self._enter(Phase.OVER)
            self._keep(self._recorder.replay())

    def close(self) -> None:
        """End the sitting; a game that is not over is kept as it is."""
        self._keep_unfinished()
        self._recorder.stop()
        self._batch.close()

    def picture(self) -> NDArray[np.uint8]:
        """Return what is to be seen now, uint8 [height, width, 3]."""
        picture = draw_world(self._batch.worlds, self._batch.rules, 0, self._height)
        draw_overlay(picture, *self.text(), band=self.phase is not Phase.PLAYING)
        return picture

    def text(self) -> tuple[str, tuple[str, ...]]:
        """Return the title and the lines that are shown over the picture, if any."""
        if self.phase is Phase.READY:
            return self._round_title(), (*self._round_lines(), "", "SPACE OR CLICK: START", *HELP)
        if self.phase is Phase.PAUSED:
            return "PAUSED", ("SPACE OR CLICK: GO ON", *HELP)
        if self.phase is Phase.OVER:
            return self._ending()
        left = IDLE_TICKS - int(self.world.idle)
        if left <= WARNING_TICKS:
            return "", (f"HIT A BRICK WITHIN {math.ceil(left / TICKS_PER_SECOND)} S",)
        if self._title < TITLE_TICKS:
            return self._round_title(), self._round_lines()
        return "", ()

    def _lay_out(self, options: dict[str, Any]) -> None:
        """Lay out a game, and keep the one that is left for it."""
        self._keep_unfinished()
        self._batch.reset(_EVERYWHERE, options)
        self._title = TITLE_TICKS
        self._enter(Phase.READY)

    def _keep_unfinished(self) -> None:
        if self.world.decisions and not self.world.done:
            self._keep(self._recorder.replay())

    def _go_on(self) -> None:
        """Start, go on after a pause, or begin another game."""
        if self.phase is not Phase.OVER:
            self._enter(Phase.PLAYING)
        elif self._waited >= OVER_TICKS:
            self._lay_out({})

    def _enter(self, phase: Phase) -> None:
        self.phase = phase
        self._waited = 0
        self._controls.let_go()

    def _round_title(self) -> str:
        """Return the name of the level, or the round's number if it has none."""
        return self._names.get(self.world.kind.tobytes(), f"Round {self.world.round_number}")

    def _round_lines(self) -> tuple[str, ...]:
        number = f"ROUND {self.world.round_number}"
        return () if self._round_title().upper() == number else (number,)

    def _ending(self) -> tuple[str, tuple[str, ...]]:
        world = self.world
        title = "GAME OVER"
        if world.lives:
            title = f"{IDLE_TICKS // TICKS_PER_SECOND} SECONDS WITHOUT A HIT"
        result = f"SCORE {world.score}   ROUND {world.round_number}"
        return title, (result, "", "SPACE OR CLICK: PLAY AGAIN", "ESC: QUIT")
