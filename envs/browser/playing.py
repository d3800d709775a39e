"""What entries do with a game: seed and begin it, play it, and look at it."""

from typing import Any

from ...physics.kernels import kernel
from ...physics.kernels.borrowed import BYTE, INDEX
from ...physics.kernels.portable import array_at
from ..actions import decode_velocities
from ..batch.stepping import reset_worlds, step_worlds
from ..game.random import mix_seed
from ..game.shapes import fit_paddle
from ..observe.planes import ANY_CELL, MAX_MARKS
from ..observe.shown import UNKNOWN
from ..play.hearing import hear
from ..state import Outcome, World
from ..tensors.arrays import HERE
from ..tensors.playing import (
    BOOL,
    FLOAT64,
    INT32,
    levels_of,
    outcome_of,
    rules_of,
    world_of,
)
from .checksums import checksum_of_world
from .records import Game

_VELOCITY = int(Game.fields["velocity"][1])  # type: ignore[index]
_WORLD_SIZE = World.itemsize


@kernel
def seed_game(game: Any) -> None:
    """Seed the random numbers."""
    world_of(0, game.arrays)[0].random = mix_seed(game.seed)


@kernel
def begin_game(address: int, game: Any) -> None:
    """Begin an episode: a new game, or the next life of the present one."""
    arrays = game.arrays
    here = array_at(address + HERE, (1,), BOOL)
    outcomes = outcome_of(0, arrays)
    reset_worlds(world_of(0, arrays), rules_of(arrays), levels_of(arrays), outcomes, here)


@kernel
def steer_game(address: int, game: Any) -> None:
    """Play a decision with the game's velocity and fire, whatever its actions are."""
    arrays = game.arrays
    worlds = world_of(0, arrays)
    if worlds[0].done != 0:
        return
    commands = array_at(arrays.commands, (1, 2), FLOAT64)
    if decode_velocities(array_at(address + _VELOCITY, (1, 2), FLOAT64), commands) >= 0:
        commands[0, 0] = 0.0
        commands[0, 1] = 0.0
        array_at(arrays.illegal, (1,), INT32)[0] += 1
    step_worlds(
        worlds,
        rules_of(arrays),
        levels_of(arrays),
        outcome_of(0, arrays),
        commands,
        False,
        arrays.episodic_life != 0,
    )


@kernel
def fit_game(game: Any) -> None:
    """Let the paddle be as wide as the game says."""
    fit_paddle(rules_of(game.arrays)[0], game.paddle)


@kernel
def forget_game(game: Any) -> None:
    """Note that observations show anything, because another state has come."""
    arrays = game.arrays
    for shown in (arrays.vector_shown, arrays.grid_shown):
        row = array_at(shown, (3,), INDEX)
        row[0] = UNKNOWN
        row[1] = 1
        row[2] = 1
    array_at(arrays.marks, (1 + MAX_MARKS,), INT32)[0] = ANY_CELL


@kernel
def hear_tick(hearing: Any) -> None:
    """Write the tones of a tick."""
    before = array_at(hearing.before, (1,), World)[0]
    after = array_at(hearing.after, (1,), World)[0]
    hearing.tones = hear(before, after, array_at(hearing.outcome, (1,), Outcome)[0])


@kernel
def note_game(game: Any) -> None:
    """Take the state into the checksum."""
    memory = array_at(game.arrays.worlds, (_WORLD_SIZE,), BYTE)
    game.checksum = checksum_of_world(memory, game.checksum)
