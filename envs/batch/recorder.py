"""Recording: what is commanded in one world of a batch, and checksums of what comes of it."""

import zlib
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .batch import Batch
from .replays import Replay, Result, Start

# A checksum runs over the state after every so many decisions ...
CHECK_EVERY = 16
# ... and its value is noted after every so many.
NOTE_EVERY = 256
# What it runs over: by name, so that it does not depend on how the state is laid out. These numbers
# are all that a game's course depends on, but for a few counters.
_CHECKED = (
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


class Recorder:
    """Records the games of one world of a batch, each from its beginning.

    A game that is in play when the recording begins is recorded if it has just been reset. A
    restored state ends the recording, until the next game begins.

    Args:
        batch: of the world.
        world: its index.

    Attributes:
        finished: the latest recorded game that is over, or None.

    Raises:
        ValueError: there is no such world.
    """

    def __init__(self, batch: Batch, world: int) -> None:
        batch.check_world(world)
        self.finished: Replay | None = None
        self._batch = batch
        self._world = world
        self._command = batch.commands[world]
        self._checked: list[Any] = [batch.worlds[name][world : world + 1] for name in _CHECKED]
        self._recording = False
        self._over = False
        self._start: Start
        self._commands = bytearray()
        self._reward = 0.0
        self._checksum = 0
        self._checksums: list[int] = []
        batch.listeners.append(self)
        record = batch.worlds[world]
        if batch.seeded[world] and record["decisions"] == 0:
            self._begin()

    @property
    def over(self) -> bool:
        """Whether the game that was recorded last is over, and the next has not begun."""
        return self._over

    @property
    def checksums(self) -> tuple[int, ...]:
        """The checksums that were noted, and at last that of the latest state they ran over."""
        return (*self._checksums, self._checksum)

    def replay(self) -> Replay:
        """Return the game so far, also after its end, until the next one begins.

        Raises:
            RuntimeError: it has not been recorded from its beginning.
        """
        if not self._recording:
            raise RuntimeError("no game is recorded: a recording begins when the world is reset")
        if self._over and self.finished is not None:
            return self.finished
        return self._replay(self._batch.outcomes[self._world])

    def stop(self) -> None:
        """End the recording; what was recorded remains."""
        with suppress(ValueError):
            self._batch.listeners.remove(self)

    def reset(self, mask: NDArray[np.bool_]) -> None:
        """Note that the worlds of a mask were reset."""
        if mask[self._world]:
            self._begin()

    def _begin(self) -> None:
        """Note that a game has begun."""
        self._recording = True
        self._over = False
        self._start = Start.of(self._batch.worlds[self._world])
        self._commands = bytearray()
        self._reward = 0.0
        self._checksum = 0
        self._checksums = []
        self._check(0)

    def interrupt(self) -> None:
        """Note that the world was brought into another state."""
        self._recording = False

    def step(self) -> None:
        """Note a step."""
        outcome = self._batch.outcomes[self._world]
        over = bool(outcome["terminated"] or outcome["truncated"])
        begun = bool(self._batch.worlds["decisions"][self._world] == 0)
        # A step of next-step mode that begins a game plays none.
        if self._recording and not self._over and (over or not begun):
            self._note(over, begun)
        if begun:
            self._begin()

    def _note(self, over: bool, begun: bool) -> None:
        """Note a decision, after which the game is over or not, and another has begun or not."""
        batch, world = self._batch, self._world
        self._commands += self._command.tobytes()
        self._reward += float(batch.outcomes["reward"][world])
        self._over = over
        decisions = len(self._commands) // self._command.nbytes
        if over:
            # The last state may be gone already, so no checksum runs over it: the result tells.
            self.finished = self._replay(batch.finals[world] if begun else batch.outcomes[world])
        elif decisions % CHECK_EVERY == 0:
            self._check(decisions)

    def _check(self, decisions: int) -> None:
        for part in self._checked:
            self._checksum = zlib.crc32(part, self._checksum)
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
                terminated=self._over and bool(outcome["terminated"]),
                truncation=int(outcome["truncation"]),
            ),
        )
