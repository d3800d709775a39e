"""What entries do to show one world."""

from typing import Any

from ...physics.kernels import kernel
from ...physics.kernels.borrowed import BYTE, INDEX, borrowed
from ...physics.kernels.portable import array_at, on_stack
from ..draw.canvas import Drawn
from ..draw.scenery import Scenery
from ..draw.view import View
from ..observe.landing import observe_landings
from ..observe.pixels import draw_pictures
from ..observe.planes import MAX_MARKS, observe_grids
from ..observe.vector import observe_vectors
from ..state import World
from .arrays import HERE
from .playing import BOOL, FLOAT32, FLOAT64, INT32, rules_of, world_of

_WORLD_SIZE = World.itemsize
_DRAWN_SIZE = Drawn.itemsize
_SHOWN_SIZE = 3 * 8
_MARKS_SIZE = (1 + MAX_MARKS) * 4


@kernel
def observe_vector(index: int, address: int, arrays: Any) -> None:
    """Write a world's vector."""
    worlds, rules, size = world_of(index, arrays), rules_of(arrays), arrays.vector_size
    rows = array_at(arrays.vectors + 4 * index * size, (1, size), FLOAT32)
    shown = array_at(arrays.vector_shown + index * _SHOWN_SIZE, (1, 3), INDEX)
    here = array_at(address + HERE, (1,), BOOL)
    observe_vectors(worlds, rules, rows, shown, arrays.plain_length, here)
    if arrays.landings_start > 0:
        scratch = borrowed(on_stack(_WORLD_SIZE), 0, 1, World)
        observe_landings(worlds, rules, rows, arrays.landings_start, scratch, here)


@kernel
def observe_grid(index: int, address: int, arrays: Any) -> None:
    """Write a world's grid."""
    size = arrays.grid_size
    observe_grids(
        world_of(index, arrays),
        rules_of(arrays),
        array_at(arrays.grids + 4 * index * size, (1, size), FLOAT32),
        array_at(arrays.marks + index * _MARKS_SIZE, (1, 1 + MAX_MARKS), INT32),
        array_at(arrays.grid_shown + index * _SHOWN_SIZE, (1, 3), INDEX),
        array_at(address + HERE, (1,), BOOL),
    )


@kernel
def draw_canvas(index: int, address: int, arrays: Any) -> None:
    """Draw a world's newest picture."""
    size = arrays.channels * arrays.height * arrays.width
    first = arrays.canvas + index * size
    lines = array_at(first, (1, 1, arrays.channels, arrays.height, arrays.width), BYTE)
    pictures = array_at(first, (1, 1, arrays.channels, arrays.height, arrays.width, 1), BYTE)
    drawn = array_at(
        arrays.drawn + index * arrays.channels * _DRAWN_SIZE, (1, 1, arrays.channels), Drawn
    )
    looks = (arrays.num_looks, arrays.look_rows, arrays.look_columns)
    for channel in range(arrays.channels):
        sheets = Scenery(
            array_at(arrays.views, (1,), View),
            array_at(arrays.palettes[channel], (arrays.num_colours, 1), FLOAT64),
            array_at(arrays.backgrounds[channel], (arrays.height, arrays.width), BYTE),
            array_at(arrays.looks[channel], looks, BYTE),
        )
        here = array_at(address + HERE, (1,), BOOL)
        worlds, rules = world_of(index, arrays), rules_of(arrays)
        draw_pictures(worlds, rules, here, sheets, pictures, lines, drawn, channel, 0, 0, 0)
