"""What entries do with the game of one world, whatever it looks like."""

from typing import Any

import numpy as np

from ...physics.kernels import inlined, kernel
from ...physics.kernels.borrowed import BYTE, INDEX
from ...physics.kernels.portable import array_at
from ..actions import decode_actions, decode_velocities
from ..batch.stepping import reset_worlds, step_worlds, tabulate_outcomes
from ..game.rulebook import Rules
from ..state import INFO_FIELDS, LevelEntry, Outcome, World
from .arrays import HERE

BOOL = np.dtype(np.bool_)
INT32 = np.dtype(np.int32)
FLOAT32 = np.dtype(np.float32)
FLOAT64 = np.dtype(np.float64)

_WORLD_SIZE = World.itemsize
_OUTCOME_SIZE = Outcome.itemsize
_FIELDS = len(INFO_FIELDS)

# What became of a world in a step (`Arrays.moves`).
STAYED = 0  # nothing: its episode is over, and it waits for a reset
PLAYED = 1
BEGUN = 2  # an episode has begun in place of a decision
ENDED = 3  # its episode ended, and the next one begins in the same step

# As in `Autoreset`, whose members kernels can't read.
_DISABLED, _NEXT_STEP, _SAME_STEP = 0, 1, 2


@inlined
def world_of(index: int, arrays: Any) -> Any:
    """Return a world, `World` [1]."""
    return array_at(arrays.worlds + index * _WORLD_SIZE, (1,), World)


@inlined
def outcome_of(index: int, arrays: Any) -> Any:
    """Return its outcome, `Outcome` [1]."""
    return array_at(arrays.outcomes + index * _OUTCOME_SIZE, (1,), Outcome)


@inlined
def rules_of(arrays: Any) -> Any:
    """Return the rules, `Rules` [1]."""
    return array_at(arrays.rules, (1,), Rules)


@inlined
def levels_of(arrays: Any) -> Any:
    """Return the levels that are played in turn, `LevelEntry` [n]."""
    return array_at(arrays.levels, (arrays.num_levels,), LevelEntry)


@kernel
def play(index: int, arrays: Any) -> bool:
    """Play a decision in a world.

    Returns:
        Whether it was played; not if its episode is over, and it waits for a reset.
    """
    worlds = world_of(index, arrays)
    if arrays.autoreset == _DISABLED and worlds[0].done != 0:
        return False
    step_worlds(
        worlds,
        rules_of(arrays),
        levels_of(arrays),
        outcome_of(index, arrays),
        _commands(index, arrays),
        arrays.autoreset == _NEXT_STEP,
        arrays.episodic_life != 0,
    )
    return True


@inlined
def _commands(index: int, arrays: Any) -> Any:
    """Return what a world's action commands, float64 [1, 2]; an illegal one stands still."""
    commands = array_at(arrays.commands + index * 16, (1, 2), FLOAT64)
    if arrays.table != 0:
        actions = array_at(arrays.actions + index * 8, (1,), INDEX)
        table = array_at(arrays.table, (arrays.num_actions, 2), FLOAT64)
        wrong = decode_actions(actions, table, commands)
    else:
        wrong = decode_velocities(array_at(arrays.actions + index * 8, (1, 2), FLOAT32), commands)
    if wrong >= 0:
        commands[0, 0] = 0.0
        commands[0, 1] = 0.0
        array_at(arrays.illegal, (arrays.count,), INT32)[index] += 1
    return commands


@kernel
def report(index: int, arrays: Any, played: bool) -> None:
    """Write the results of a world's step; if it was not played, nothing has happened in it."""
    count, outcomes = arrays.count, outcome_of(index, arrays)
    world, outcome = world_of(index, arrays)[0], outcomes[0]
    if not played:
        _forget_decision(outcome)
    array_at(arrays.rewards, (count,), FLOAT64)[index] = outcome.reward
    array_at(arrays.terminated, (count,), BOOL)[index] = outcome.terminated
    array_at(arrays.truncated, (count,), BOOL)[index] = outcome.truncated
    move = PLAYED
    if not played:
        move = STAYED
    elif world.decisions == world.first_decision:
        move = BEGUN
    elif world.done != 0 and arrays.autoreset == _SAME_STEP:
        move = ENDED
    array_at(arrays.moves, (count,), BYTE)[index] = move
    _tabulate(index, outcomes, arrays.infos, count)


@inlined
def _forget_decision(outcome: Any) -> None:
    """Let an outcome tell of no decision; how the episode has ended stays in it."""
    outcome.reward = 0.0
    outcome.hits = 0
    outcome.bricks_broken = 0
    outcome.lives_gained = 0
    outcome.capsules_caught = 0
    outcome.enemies_destroyed = 0
    outcome.lives_lost = 0
    outcome.rounds_cleared = 0


@kernel
def begin_again(index: int, address: int, arrays: Any) -> bool:
    """Begin a new episode in a world, in the step that has ended one; tell whether one has."""
    if array_at(arrays.moves, (arrays.count,), BYTE)[index] != ENDED:
        return False
    outcomes = outcome_of(index, arrays)
    _tabulate(index, outcomes, arrays.final_infos, arrays.count)
    outcome = outcomes[0]
    reward, terminated, truncated = outcome.reward, outcome.terminated, outcome.truncated
    reset_worlds(
        world_of(index, arrays),
        rules_of(arrays),
        levels_of(arrays),
        outcomes,
        array_at(address + HERE, (1,), BOOL),
    )
    outcome.reward = reward
    outcome.terminated = terminated
    outcome.truncated = truncated
    _tabulate(index, outcomes, arrays.infos, arrays.count)
    return True


@kernel
def _tabulate(index: int, outcomes: Any, infos: int, count: int) -> None:
    """Write what `info` shows of a world into its column of a table."""
    table = array_at(infos, (_FIELDS, count), INDEX)
    tabulate_outcomes(outcomes, table[:, index : index + 1])


@kernel
def keep_number(index: int, arrays: Any, numbers: int, finals: int, size: int) -> None:
    """Copy one of all numbers of observations (float32 [n, size]), if it is of an ended episode."""
    if array_at(arrays.moves, (arrays.count,), BYTE)[index // size] == ENDED:
        length = (arrays.count * size,)
        array_at(finals, length, FLOAT32)[index] = array_at(numbers, length, FLOAT32)[index]
