"""Recording games: the commands given to one world of a batch, and checksums of its states."""

import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..state import GAME_OVER, World
from .batch import Batch
from .replays import NOTE_EVERY, GameStart, Replay, Result

# After this number of decisions, again and again, the checksum runs over the state; after
# `NOTE_EVERY` its value is noted.
CHECK_EVERY = 16
# What it runs over. These fields are all that a game's course depends on, but for a few counters.
CHECKED = (
    "random",
    "decisions",
    "idle",
    "score",
    "lives",
    "round_number",
    "hits_left",
    "speed_stage",
    "paddle_x",
    "paddle_vx",
    "paddle_half",
    "ball_state",
    "ball_x",
    "ball_y",
    "ball_vx",
    "ball_vy",
    "power",
    "exit_open",
    "capsule",
    "capsule_x",
    "capsule_y",
    "beam_x",
    "beam_y",
    "enemy_state",
    "enemy_x",
    "enemy_y",
    "boss_hits",
    "shard_x",
    "shard_y",
    "brick_hits",
)


def _as_recorded(name: str) -> tuple[str, "np.dtype[Any]", tuple[int, ...]]:
    """Return a field of `World` as checksums take it, however wide its integers are there."""
    field = World[name]
    wide = np.dtype(np.int64) if field.base.kind == "i" else field.base
    return name, wide, field.shape


# Without gaps, and in this order: so a checksum does not depend on how the state is laid out.
Checked = np.dtype([_as_recorded(name) for name in CHECKED])


class Recorder:
    """Records the games of one world of a batch, each from its beginning.

    A game that has already begun is recorded only if it was just reset. A restored state ends the
    recording until the next game begins, and so does a step that was interrupted, by Ctrl-C for
    instance: whether the world has played it, nobody knows. It records as long as somebody keeps
    it, or until `stop`.

    Args:
        batch: of the world.
        world: its index.

    Attributes:
        finished: the latest recorded game that is over, or None.

    Raises:
        TypeError, ValueError: there is no such world.
    """

    def __init__(self, batch: Batch, world: int) -> None:
        batch.check_world(world)
        self.finished: Replay | None = None
        self._batch = batch
        self._world = world
        self._command = batch.commands[world]
        self._checked = np.zeros((), Checked)
        self._changes = batch.changes
        self._recording = False
        self._over = False
        self._start: GameStart
        self._commands = bytearray()
        self._reward = 0.0
        self._checksum = 0
        self._checksums: list[int] = []
        batch.listeners.add(self)
        if batch.seeded[world] and batch.worlds["decisions"][world] == 0:
            self._begin()

    @property
    def over(self) -> bool:
        """Whether the latest recorded game is over, and the next one has not begun."""
        return self._over

    @property
    def checksums(self) -> tuple[int, ...]:
        """The noted checksums, and as the last one the present checksum."""
        return (*self._checksums, self._checksum)

    def replay(self) -> Replay:
        """Return the game so far; after its end, the whole game until the next one begins.

        Raises:
            RuntimeError: it has not been recorded from its beginning, or a step was interrupted.
        """
        if self._recording and self._over and self.finished is not None:
            return self.finished
        if not self._recording or self._batch.changes != self._changes:
            raise RuntimeError(
                "no game is recorded: a recording begins when the world is reset, and ends when a "
                "step is interrupted"
            )
        return self._replay(self._batch.outcomes[self._world])

    def stop(self) -> None:
        """End the recording; what was recorded remains."""
        self._batch.listeners.remove(self)

    def reset(self, mask: NDArray[np.bool_]) -> None:
        """Follow a reset of the worlds of a mask: to a new game, or to a game's next life."""
        with self._following():
            if mask[self._world] and self._batch.worlds["decisions"][self._world] == 0:
                self._begin()

    def _begin(self) -> None:
        """Begin to record a game."""
        self._recording = True
        self._over = False
        self._start = GameStart.of(self._batch.worlds[self._world])
        self._commands = bytearray()
        self._reward = 0.0
        self._checksum = 0
        self._checksums = []
        self._check(0)

    @contextmanager
    def _following(self) -> Iterator[None]:
        """Follow a change of the worlds, unless one before has been interrupted, or this one is."""
        changes = self._batch.changes
        if changes != self._changes + 1:
            self._recording = False
        yield
        # Ctrl-C may come at any time. Unless all is noted, this is not reached.
        self._changes = changes

    def interrupt(self) -> None:
        """Stop, because the world was brought into another state."""
        with self._following():
            self._recording = False

    def step(self) -> None:
        """Follow a step."""
        with self._following():
            self._follow_step()

    def _follow_step(self) -> None:
        batch, index = self._batch, self._world
        outcome = batch.outcomes[index]
        decisions = batch.worlds["decisions"][index]
        begun = bool(decisions == 0)
        # With `episodic_life` a game goes on after an episode's end.
        over = bool(outcome["terminated"] or outcome["truncated"]) and (
            begun or bool(batch.worlds["done"][index] == GAME_OVER)
        )
        # In next-step mode, a step that begins an episode plays no decision.
        played = over or decisions > len(self._commands) // self._command.nbytes
        if self._recording and not self._over and played:
            self._note(over, begun)
        if begun:
            self._begin()

    def _note(self, over: bool, begun: bool) -> None:
        """Record a decision.

        Args:
            over: whether the game is over after it.
            begun: whether the next game has already begun.
        """
        batch, world = self._batch, self._world
        self._commands += self._command.tobytes()
        self._reward += float(batch.outcomes["reward"][world])
        self._over = over
        decisions = len(self._commands) // self._command.nbytes
        if over:
            # The last state may be gone already: the result takes the place of its checksum.
            self.finished = self._replay(batch.finals[world] if begun else batch.outcomes[world])
        elif decisions % CHECK_EVERY == 0:
            self._check(decisions)

    def _check(self, decisions: int) -> None:
        state = self._batch.worlds[self._world]
        for name in CHECKED:
            self._checked[name] = state[name]
        self._checksum = zlib.crc32(self._checked.tobytes(), self._checksum)
        if decisions % NOTE_EVERY == 0:
            self._checksums.append(self._checksum)

    def _replay(self, outcome: Any) -> Replay:
        commands = np.frombuffer(bytes(self._commands), np.float64).reshape(-1, 2)
        return Replay(
            config=self._batch.config.of_the_game(),
            plan=self._batch.plan,
            start=self._start,
            commands=commands,
            checksums=self.checksums,
            result=Result(
                decisions=len(commands),
                reward=self._reward,
                score=int(outcome["score"]),
                lives=int(outcome["lives"]),
                round=int(outcome["round_number"]),
                terminated=self._over and bool(outcome["lives"] == 0),
                truncation=int(outcome["truncation"]),
            ),
        )
