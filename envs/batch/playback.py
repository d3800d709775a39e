"""Recorded games played again: as states, as pictures, or only to check that they end alike."""

from collections.abc import Iterator
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import counted
from ..state import LIFE_LOST
from .batch import Batch
from .recorder import Recorder
from .replays import NOTE_EVERY, Replay, Result


class ReplayDivergedError(RuntimeError):
    """A replayed game takes another course than the recorded one."""


def play_replay(replay: Replay | str | PathLike[str]) -> Result:
    """Play a recorded game again, and return its result.

    Args:
        replay: the game, or the path of its file.

    Raises:
        OSError, ValueError: the file can't be read, see `Replay.load`.
        ReplayDivergedError: the game took another course when it was recorded.
    """
    game = _loaded(replay)
    for _ in replay_states(game):
        pass
    return game.result


def replay_frames(replay: Replay | str | PathLike[str]) -> Iterator[NDArray[np.uint8]]:
    """Yield pictures of a recorded game, uint8 [height, width, 3]: the first, one per decision.

    `Replay.frames_per_second` of them are a second of the game.

    Raises:
        OSError, ValueError, ReplayDivergedError: as `play_replay`.
    """
    # Imported on demand: playing without pictures needs none of the drawing kernels.
    from ..draw.picture import draw_world

    for batch in replay_states(replay):
        yield draw_world(batch.worlds, batch.rules, 0)


def replay_states(replay: Replay | str | PathLike[str]) -> Iterator[Batch]:
    """Yield the one-world batch that replays a game, at the beginning and after each decision.

    Raises:
        OSError, ValueError, ReplayDivergedError: as `play_replay`.
    """
    game = _loaded(replay)
    batch = Batch(1, game.config, plan=game.plan)
    game.start.apply(batch.worlds)
    recorder = Recorder(batch, 0)
    batch.reset(np.ones(1, np.bool_))
    _compare_checksums(game, recorder)
    yield batch
    for decision, command in enumerate(game.commands, 1):
        if recorder.over:
            raise ReplayDivergedError(
                f"the game is over after {counted(decision - 1, 'decision')} instead of "
                f"{len(game.commands)}"
            )
        begin_next_life(batch)
        batch.commands[0] = command
        batch.step()
        if decision % NOTE_EVERY == 0:
            _compare_checksums(game, recorder)
        yield batch
    again = recorder.replay()
    if again.checksums != game.checksums or again.result != game.result:
        raise ReplayDivergedError(
            f"the game ends differently: {again.result} instead of {game.result}, or with other "
            f"states after decision {len(game.commands) // NOTE_EVERY * NOTE_EVERY}"
        )


def begin_next_life(batch: Batch) -> bool:
    """Begin the next episode of a replayed game, if the loss of a life has ended one."""
    begins = bool(batch.worlds["done"][0] == LIFE_LOST)
    if begins:
        batch.reset(np.ones(1, np.bool_))
    return begins


def _loaded(replay: Any) -> Replay:
    return replay if isinstance(replay, Replay) else Replay.load(replay)


def _compare_checksums(game: Replay, recorder: Recorder) -> None:
    """Raise an error if the checksums so far are not the recorded ones."""
    noted = len(recorder.checksums) - 1
    if recorder.checksums[:noted] == game.checksums[:noted]:
        return
    decisions = (noted - 1) * NOTE_EVERY
    if decisions == 0:
        raise ReplayDivergedError("the game begins differently from the one that was recorded")
    raise ReplayDivergedError(
        "the game takes another course than when it was recorded, between decisions "
        f"{decisions - NOTE_EVERY} and {decisions}"
    )
