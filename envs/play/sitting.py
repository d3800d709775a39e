"""A sitting: one game after another, with pauses and titles. This needs no window."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
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
from .card import Card
from .controls import Controls, Key
from .hearing import tones_of
from .scores import Scores
from .sound import Speaker

# After a game the fire button does nothing for so long: a player who hammers it sees the score.
OVER_TICKS = 40
TITLE_TICKS = 90  # how long the title of a new round is shown
WARNING_TICKS = 15 * TICKS_PER_SECOND  # the warning comes so long before idling costs a life

KEYS = (
    "ARROWS OR MOUSE: MOVE   SPACE OR CLICK: FIRE",
    "P: PAUSE   N: NEXT ROUND   R: RESTART",
    "H: WHAT IS WHAT   M: SOUND   F: FULL SCREEN   ESC: QUIT",
)
NOTICE_TICKS = 90  # how long it is shown that sound is on or off
SHOWN_SCORES = 5  # at the end of a game
QUESTIONS = {
    Key.RESTART: ("RESTART?", "R: YES, LEAVE THIS GAME"),
    Key.NEXT: ("NEXT ROUND?", "N: YES, LEAVE THIS GAME"),
}

_ALL_WORLDS = np.ones(1, np.bool_)


class Phase(Enum):
    """The phase of a sitting."""

    READY = auto()  # a game is laid out and waits for the player
    PLAYING = auto()
    PAUSED = auto()
    ASKED = auto()  # whether to leave the game
    OVER = auto()


@dataclass(frozen=True)
class Board:
    """The board of high scores.

    Attributes:
        scores: the best ones of each game.
        name: returns the name there of games that begin with these options.
    """

    scores: Scores
    name: Callable[[Mapping[str, Any]], str]


class Sitting:
    """The games of one player, each of them recorded.

    Args:
        config: the configuration of the games; a decision should be one tick.
        options: how the games begin, as for `reset`.
        seed: the seed of their random numbers.
        keep: is called with each game that was begun, when it is over or the player leaves it.
        height: the height of the pictures, in pixels.
        board: the high scores.
        speaker: plays the tones.

    Attributes:
        phase: the present phase.
        ended: whether the player has asked to quit.
        frames_per_second: one picture per tick.

    Raises:
        ValueError: there is no such level, or an option is illegal.
    """

    frames_per_second = float(TICKS_PER_SECOND)

    def __init__(
        self,
        config: Config,
        options: dict[str, Any],
        seed: int,
        keep: Callable[[Replay], None],
        height: int,
        board: Board,
        speaker: Speaker,
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
        self._board = board
        self._speaker = speaker
        self._options: dict[str, Any] = {}  # in force
        self._place: int | None = None  # of the latest game among the high scores
        self._question = Key.RESTART  # which key asked
        self._notice, self._notice_ticks = "", 0
        self._card: Card | None = None
        self._helping = False  # the help card is shown
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
        elif key is Key.SOUND:
            self._notice, self._notice_ticks = self._speaker.switch(), NOTICE_TICKS
        elif key is Key.HELP or self._helping:
            self._help(key)
        elif key in QUESTIONS:
            self._leave(key)
        elif key is Key.PAUSE and self.phase in (Phase.PLAYING, Phase.PAUSED, Phase.ASKED):
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
        self._notice_ticks = max(0, self._notice_ticks - 1)
        if self.phase is not Phase.PLAYING:
            return
        speed = float(self._batch.rules["paddle_speed"][0])
        self._batch.commands[0] = self._controls.command(float(self.world.paddle_x), speed)
        before = self._batch.worlds[0].copy()
        self._batch.step()
        self._speaker.play(tones_of(before, self.world, self._batch.outcomes[0]))
        self._round_ticks = 0 if self.world.rounds_cleared else self._round_ticks + 1
        if self.world.done:
            self._enter(Phase.OVER)
            self._keep_game()

    def close(self) -> None:
        """End the sitting; an unfinished game is kept."""
        self._keep_unfinished()
        self._speaker.close()
        self._recorder.stop()
        self._batch.close()

    def picture(self) -> NDArray[np.uint8]:
        """Return the present picture, uint8 [height, width, 3]."""
        picture = draw_world(self._batch.worlds, self._batch.rules, 0, self._height)
        if self._helping:
            self._help_card().draw(picture)
        else:
            draw_overlay(picture, *self.text(), band=self.phase is not Phase.PLAYING)
        return picture

    def text(self) -> tuple[str, tuple[str, ...]]:
        """Return the title and the lines over the picture; both may be empty."""
        if self.phase is Phase.READY:
            lines = (*self._round_lines(), *self._best_line(), "", "SPACE OR CLICK: START", *KEYS)
            return self._round_title(), lines
        if self.phase is Phase.PAUSED:
            return "PAUSED", ("SPACE OR CLICK: GO ON", *KEYS)
        if self.phase is Phase.ASKED:
            question, answer = QUESTIONS[self._question]
            return question, (answer, "SPACE OR CLICK: NO, GO ON")
        if self.phase is Phase.OVER:
            return self._ending()
        if self._notice_ticks:
            return "", (self._notice,)
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
        self._options |= options
        self._round_ticks = TITLE_TICKS
        self._enter(Phase.READY)

    def _keep_unfinished(self) -> None:
        if self.world.decisions and not self.world.done:
            self._keep_game()

    def _keep_game(self) -> None:
        """Keep the game's recording, and its score if it is high."""
        self._keep(self._recorder.replay())
        self._place = None
        name, world = self._board.name(self._options), self.world
        try:
            self._place = self._board.scores.add(name, int(world.score), int(world.round_number))
        except (OSError, ValueError):
            self._notice, self._notice_ticks = "THE SCORE COULD NOT BE SAVED", NOTICE_TICKS

    def _leave(self, key: Key) -> None:
        """Lay out another game; if this one has begun, only after the same key a second time."""
        begun = self.world.decisions and not self.world.done
        if begun and not (self.phase is Phase.ASKED and self._question is key):
            self._question = key
            self._enter(Phase.ASKED)
        elif key is Key.RESTART:
            self._lay_out({})
        else:
            self._lay_out({"level": int(self.world.round_number) + 1, "seed": None})

    def _help(self, key: Key) -> None:
        """Show the help card, or put it away."""
        if self.phase is Phase.PLAYING:
            self._enter(Phase.PAUSED)
        self._helping = not self._helping and key is Key.HELP

    def _help_card(self) -> Card:
        if self._card is None:
            keys = (*KEYS, "", "H OR SPACE: BACK")
            self._card = Card(self._batch.config, keys, self._height)
        return self._card

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

    def _best_line(self) -> tuple[str, ...]:
        best = self._board.scores.best(self._board.name(self._options))
        return (f"HIGH SCORE {best[0].score}",) if best else ()

    def _ending(self) -> tuple[str, tuple[str, ...]]:
        result = f"SCORE {self.world.score}   ROUND {self.world.round_number}"
        if self._notice_ticks:
            result = self._notice
        best = self._board.scores.best(self._board.name(self._options))[:SHOWN_SCORES]
        table = [
            f"{'-' if place == self._place else ' '} {place + 1}. {entry.score:7}  "
            f"ROUND {entry.round:2} {'-' if place == self._place else ' '}"
            for place, entry in enumerate(best)
        ]
        lines = (result, "", *table, "", "SPACE OR CLICK: PLAY AGAIN   ESC: QUIT")
        return "GAME OVER", lines
