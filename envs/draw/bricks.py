"""The background and the bricks: copied from pictures of them, where a picture shows others."""

from typing import Any

from ...physics.kernels import inlined, kernel
from ..game.bricks import hits_needed
from ..rules import CELLS, COLUMNS, ROWS, SILVER
from .canvas import copy_bytes
from .scenery import DAMAGED, DAMAGES


@kernel
def brick_look(kind: int, hits_left: int, round_number: int) -> int:
    """Return the look of a cell: none, its kind's, or that of silver damaged so far."""
    if hits_left == 0:
        return 0
    if kind != SILVER:
        return kind
    needed = hits_needed(kind, round_number)
    return kind if hits_left >= needed else DAMAGED + 1 + (needed - hits_left) * DAMAGES // needed


@inlined
def begin_picture(lines: Any, drawn: Any, sheets: Any) -> None:
    """Copy the whole background: a picture of an empty field."""
    for row in range(lines.shape[0]):
        copy_bytes(lines[row], sheets.background[row])
    drawn.begun = 1
    drawn.score = -1
    drawn.round_number = 0
    drawn.marks = 0
    for cell in range(CELLS):
        drawn.brick_hits[cell] = 0
        drawn.kind[cell] = 0


@inlined
def erase_things(lines: Any, drawn: Any, sheets: Any, world: Any) -> None:
    """Put background and bricks back into the boxes of the things that were drawn."""
    channels = sheets.palette.shape[1]
    for index in range(drawn.marks):
        top, bottom = drawn.top[index], drawn.bottom[index]
        start, end = drawn.left[index] * channels, drawn.right[index] * channels
        for row in range(top, bottom):
            copy_bytes(lines[row, start:end], sheets.background[row, start:end])
        _restore_bricks(lines, sheets, world, drawn.left[index], top, drawn.right[index], bottom)
    drawn.marks = 0


@inlined
def _restore_bricks(
    lines: Any, sheets: Any, world: Any, left: int, top: int, right: int, bottom: int
) -> None:
    """Draw the cells that have pixels in a box, each end excluded."""
    view = sheets.views[0]
    if top >= view.rows[ROWS] or bottom <= view.rows[0]:
        return
    for row in range(ROWS):
        if view.rows[row] >= bottom or view.rows[row + 1] <= top:
            continue
        for column in range(COLUMNS):
            if view.columns[column] < right and view.columns[column + 1] > left:
                _draw_cell(lines, sheets, world, row, column)


@kernel
def _draw_cell(lines: Any, sheets: Any, world: Any, row: int, column: int) -> None:
    """Draw a cell of the lattice, by copying its pixels from the picture of its look."""
    view = sheets.views[0]
    cell = row * COLUMNS + column
    look = brick_look(int(world.kind[cell]), int(world.brick_hits[cell]), world.round_number)
    channels = sheets.palette.shape[1]
    left, top = view.columns[0] * channels, view.rows[0]
    start, end = view.columns[column] * channels, view.columns[column + 1] * channels
    for y in range(view.rows[row], view.rows[row + 1]):
        copy_bytes(lines[y, start:end], sheets.looks[look, y - top, start - left : end - left])


@inlined
def draw_bricks(lines: Any, drawn: Any, sheets: Any, world: Any) -> None:
    """Draw the cells that the picture shows otherwise than they are."""
    # Silver shows its damage as a part of the hits that it needs in a round.
    if drawn.round_number == world.round_number and not _bricks_differ(drawn, world):
        return
    anew = drawn.round_number != world.round_number
    drawn.round_number = world.round_number
    for cell in range(CELLS):
        hits, kind, shown = world.brick_hits[cell], world.kind[cell], drawn.brick_hits[cell]
        differs = hits != shown or (hits > 0 and (anew or kind != drawn.kind[cell]))
        drawn.brick_hits[cell] = hits
        drawn.kind[cell] = kind
        if differs:
            _draw_cell(lines, sheets, world, cell // COLUMNS, cell % COLUMNS)


@inlined
def _bricks_differ(drawn: Any, world: Any) -> bool:
    """Return whether any brick may look otherwise than the picture shows it."""
    difference = 0
    for cell in range(CELLS):
        difference |= world.brick_hits[cell] ^ drawn.brick_hits[cell]
        difference |= world.kind[cell] ^ drawn.kind[cell]
    return difference != 0
