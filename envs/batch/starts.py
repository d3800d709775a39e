"""Choosing how the next games of a world begin, while its present one goes on."""

from typing import Any

from ..levels.starts import read_start
from .batch import Batch


def set_start(batch: Batch, world: int, options: dict[str, Any]) -> None:
    """Set how the next games of a world begin, without a reset.

    Rounds that the present game has yet to reach follow the options, too: generated ones have the
    new difficulty, and a level that repeats is the new one. So recordings end, until a game begins.

    Args:
        batch: of the world.
        world: its index.
        options: those of a reset, `START_OPTIONS`.

    Raises:
        TypeError, ValueError: an option or the index is illegal; nothing changes then.
        RuntimeError: another call is in progress.
    """
    batch.check_world(world)
    fields = read_start(options, batch.config, batch.plan)
    batch.alone.run(_set, batch, world, fields)


def _set(batch: Batch, world: int, fields: dict[str, Any]) -> None:
    batch.changes += 1
    for name, value in fields.items():
        batch.worlds[name][world] = value
    # A replay knows only how its game began.
    for listener in batch.listeners:
        listener.interrupt()
