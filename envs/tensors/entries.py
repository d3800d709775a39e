"""The entries: each plays a decision in one world, and writes what came of it.

They call the very kernels that step and observe the batches of the processor, with arrays that hold
one world. So the bits are the same.
"""

from typing import Any

import numpy as np

from ...physics.kernels import inlined, kernel
from ...physics.kernels.portable import Entry, array_at
from ..actions import decode_actions, decode_velocities
from ..batch.stepping import reset_worlds, step_worlds, tabulate_outcomes
from ..draw.canvas import Drawn, copy_bytes
from ..draw.scenery import Scenery
from ..draw.view import View
from ..game.rulebook import Rules
from ..observe.landing import observe_landings
from ..observe.pixels import draw_pictures
from ..observe.planes import MAX_MARKS, observe_grids
from ..observe.vector import observe_vectors
from ..state import INFO_FIELDS, LevelEntry, Outcome, World
from .arrays import HERE, Arrays

_BOOL = np.dtype(np.bool_)
_BYTE = np.dtype(np.uint8)
_INT32 = np.dtype(np.int32)
_INT64 = np.dtype(np.int64)
_FLOAT32 = np.dtype(np.float32)
_FLOAT64 = np.dtype(np.float64)
_ARRAYS = np.dtype(Arrays)
_WORLD_SIZE = World.itemsize
_OUTCOME_SIZE = Outcome.itemsize
_DRAWN_SIZE = Drawn.itemsize
_SHOWN_SIZE = 3 * 8
_MARKS_SIZE = (1 + MAX_MARKS) * 4
_FIELDS = len(INFO_FIELDS)

# As in `Autoreset`, whose members kernels can't read.
_DISABLED, _NEXT_STEP, _SAME_STEP = 0, 1, 2


@kernel
def step_vectors(index: int, address: int) -> None:
    """Play a decision in a world that is seen as a vector."""
    arrays = array_at(address, (1,), _ARRAYS)[0]
    if _play(index, arrays):
        _observe_vector(index, address, arrays)
        if arrays.autoreset == _SAME_STEP and _is_over(index, arrays):
            _keep_vector(index, arrays)
            _begin_again(index, address, arrays)
            _observe_vector(index, address, arrays)
        _report(index, arrays)


@kernel
def step_grids(index: int, address: int) -> None:
    """Play a decision in a world that is seen as a grid."""
    arrays = array_at(address, (1,), _ARRAYS)[0]
    if _play(index, arrays):
        _observe_grid(index, address, arrays)
        if arrays.autoreset == _SAME_STEP and _is_over(index, arrays):
            _keep(index, arrays.final_grids, arrays.grids, 4 * arrays.grid_size)
            _begin_again(index, address, arrays)
            _observe_grid(index, address, arrays)
        _report(index, arrays)


@kernel
def step_pictures(index: int, address: int) -> None:
    """Play a decision in a world that is seen as pictures."""
    arrays = array_at(address, (1,), _ARRAYS)[0]
    if _play(index, arrays):
        _observe_pictures(index, address, arrays)
        if arrays.autoreset == _SAME_STEP and _is_over(index, arrays):
            _keep_pictures(index, arrays)
            _begin_again(index, address, arrays)
            _observe_pictures(index, address, arrays)
        _report(index, arrays)


@kernel
def step_both(index: int, address: int) -> None:
    """Play a decision in a world that is seen as pictures and as a vector."""
    arrays = array_at(address, (1,), _ARRAYS)[0]
    if _play(index, arrays):
        _observe_pictures(index, address, arrays)
        _observe_vector(index, address, arrays)
        if arrays.autoreset == _SAME_STEP and _is_over(index, arrays):
            _keep_pictures(index, arrays)
            _keep_vector(index, arrays)
            _begin_again(index, address, arrays)
            _observe_pictures(index, address, arrays)
            _observe_vector(index, address, arrays)
        _report(index, arrays)


# By the kind of observation.
ENTRIES = {
    "vector": Entry(__name__, "step_vectors"),
    "grid": Entry(__name__, "step_grids"),
    "rgb": Entry(__name__, "step_pictures"),
    "dict": Entry(__name__, "step_both"),
}


@inlined
def _worlds(index: int, arrays: Any) -> Any:
    return array_at(arrays.worlds + index * _WORLD_SIZE, (1,), World)


@inlined
def _outcomes(index: int, address: int) -> Any:
    return array_at(address + index * _OUTCOME_SIZE, (1,), Outcome)


@inlined
def _rules(arrays: Any) -> Any:
    return array_at(arrays.rules, (1,), Rules)


@inlined
def _is_over(index: int, arrays: Any) -> bool:
    return bool(_worlds(index, arrays)[0].done != 0)


@kernel
def _play(index: int, arrays: Any) -> bool:
    """Play a decision in a world, unless its episode is over and waits for a reset."""
    worlds = _worlds(index, arrays)
    if arrays.autoreset == _DISABLED and worlds[0].done != 0:
        array_at(arrays.rewards + index * 8, (1,), _FLOAT64)[0] = 0.0
        return False
    commands = array_at(arrays.commands + index * 16, (1, 2), _FLOAT64)
    if arrays.table != 0:
        actions = array_at(arrays.actions + index * 8, (1,), _INT64)
        table = array_at(arrays.table, (arrays.num_actions, 2), _FLOAT64)
        wrong = decode_actions(actions, table, commands)
    else:
        wrong = decode_velocities(
            array_at(arrays.actions + index * 8, (1, 2), _FLOAT32), commands
        )
    if wrong >= 0:
        commands[0, 0] = commands[0, 1] = 0.0
        array_at(arrays.illegal + index * 4, (1,), _INT32)[0] += 1
    step_worlds(
        worlds,
        _rules(arrays),
        array_at(arrays.levels, (arrays.num_levels,), LevelEntry),
        _outcomes(index, arrays.outcomes),
        commands,
        arrays.autoreset == _NEXT_STEP,
        arrays.episodic_life != 0,
    )
    return True


@kernel
def _begin_again(index: int, address: int, arrays: Any) -> None:
    """Begin a new episode in the step that has ended one, and keep apart how that ended."""
    outcomes, finals = _outcomes(index, arrays.outcomes), _outcomes(index, arrays.finals)
    finals[0] = outcomes[0]
    _tabulate(index, finals, arrays.final_infos, arrays.count)
    reset_worlds(
        _worlds(index, arrays),
        _rules(arrays),
        array_at(arrays.levels, (arrays.num_levels,), LevelEntry),
        outcomes,
        array_at(address + HERE, (1,), _BOOL),
    )
    outcomes[0].reward = finals[0].reward
    outcomes[0].terminated = finals[0].terminated
    outcomes[0].truncated = finals[0].truncated


@kernel
def _report(index: int, arrays: Any) -> None:
    """Write the results of a world's step."""
    outcomes = _outcomes(index, arrays.outcomes)
    array_at(arrays.rewards + index * 8, (1,), _FLOAT64)[0] = outcomes[0].reward
    array_at(arrays.terminated + index, (1,), _BOOL)[0] = outcomes[0].terminated
    array_at(arrays.truncated + index, (1,), _BOOL)[0] = outcomes[0].truncated
    _tabulate(index, outcomes, arrays.infos, arrays.count)


@kernel
def _tabulate(index: int, outcomes: Any, infos: int, count: int) -> None:
    """Write what `info` shows of a world into its column of a table, int64 [fields, n]."""
    table = array_at(infos, (_FIELDS, count), _INT64)
    tabulate_outcomes(outcomes, table[:, index : index + 1])


@kernel
def _observe_vector(index: int, address: int, arrays: Any) -> None:
    worlds, rules = _worlds(index, arrays), _rules(arrays)
    size = arrays.vector_size
    rows = array_at(arrays.vectors + 4 * index * size, (1, size), _FLOAT32)
    shown = array_at(arrays.vector_shown + index * _SHOWN_SIZE, (1, 3), _INT64)
    here = array_at(address + HERE, (1,), _BOOL)
    observe_vectors(worlds, rules, rows, shown, arrays.plain_length, here)
    if arrays.landings_start > 0:
        scratch = array_at(arrays.scratch + index * _WORLD_SIZE, (1,), World)
        observe_landings(worlds, rules, rows, arrays.landings_start, scratch, here)


@kernel
def _observe_grid(index: int, address: int, arrays: Any) -> None:
    size = arrays.grid_size
    observe_grids(
        _worlds(index, arrays),
        _rules(arrays),
        array_at(arrays.grids + 4 * index * size, (1, size), _FLOAT32),
        array_at(arrays.marks + index * _MARKS_SIZE, (1, 1 + MAX_MARKS), _INT32),
        array_at(arrays.grid_shown + index * _SHOWN_SIZE, (1, 3), _INT64),
        array_at(address + HERE, (1,), _BOOL),
    )


@kernel
def _observe_pictures(index: int, address: int, arrays: Any) -> None:
    """Draw a world's newest picture, after the earlier ones have moved by one place."""
    shape = (1, arrays.stack, arrays.channels, arrays.height, arrays.width)
    first = arrays.pictures + index * _picture_size(arrays)
    lines = array_at(first, shape, _BYTE)
    pictures = array_at(first, (*shape, 1), _BYTE)
    places = arrays.stack * arrays.channels
    drawn = array_at(
        arrays.drawn + index * places * _DRAWN_SIZE, (1, arrays.stack, arrays.channels), Drawn
    )
    for channel in range(arrays.channels):
        sheets = Scenery(
            array_at(arrays.views, (1,), View),
            array_at(arrays.palettes[channel], (arrays.num_colours, 1), _FLOAT64),
            array_at(arrays.backgrounds[channel], (arrays.height, arrays.width), _BYTE),
            array_at(
                arrays.looks[channel],
                (arrays.num_looks, arrays.look_rows, arrays.look_columns),
                _BYTE,
            ),
        )
        draw_pictures(
            _worlds(index, arrays),
            _rules(arrays),
            array_at(address + HERE, (1,), _BOOL),
            sheets,
            pictures,
            lines,
            drawn,
            channel,
            0,
            arrays.stack - 1,
            1 if arrays.stack > 1 else 0,
        )


@inlined
def _picture_size(arrays: Any) -> int:
    """Return the bytes of a world's pictures."""
    return int(arrays.stack * arrays.channels * arrays.height * arrays.width)


@kernel
def _keep_vector(index: int, arrays: Any) -> None:
    _keep(index, arrays.final_vectors, arrays.vectors, 4 * arrays.vector_size)


@kernel
def _keep_pictures(index: int, arrays: Any) -> None:
    _keep(index, arrays.final_pictures, arrays.pictures, _picture_size(arrays))


@kernel
def _keep(index: int, finals: int, observations: int, size: int) -> None:
    """Copy a world's last observation, of so many bytes, to where that of ended episodes lies."""
    source = array_at(observations + index * size, (size,), _BYTE)
    copy_bytes(array_at(finals + index * size, (size,), _BYTE), source)
