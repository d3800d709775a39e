"""The background and the bricks: copied from finished pixels, where the picture is out of date."""

from ...physics.kernels import inlined, kernel
from ..game.bricks import hits_needed
from ..rules import CELLS, COLUMNS, ROWS, SILVER
from ..state import WorldRecord
from .canvas import DrawnRecord, Lines, copy_bytes
from .scenery import DAMAGED, DAMAGES, Scenery


@kernel
def brick_look(kind: int, hits_left: int, round_number: int) -> int:
    """Return the look of a cell: 0 if it is empty, its kind, or a look of damaged silver."""
    if hits_left == 0:
        return 0
    if kind != SILVER:
        return kind
    needed = hits_needed(kind, round_number)
    return kind if hits_left >= needed else DAMAGED + 1 + (needed - hits_left) * DAMAGES // needed


@inlined
def begin_picture(lines: Lines, drawn: DrawnRecord, scenery: Scenery) -> None:
    """Copy the whole background: the picture shows an empty field."""
    for row in range(lines.shape[0]):
        copy_bytes(lines[row], scenery.background[row])
    drawn.begun = 1
    # No world has these numbers: score line or status are out of date.
    drawn.score = -1
    drawn.header_round = -1
    drawn.idle = -1
    drawn.round_number = 0
    drawn.boxes = 0
    for cell in range(CELLS):
        drawn.brick_hits[cell] = 0
        drawn.kind[cell] = 0


@inlined
def erase_things(lines: Lines, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord) -> None:
    """Draw background and bricks again in the boxes of the things that were drawn."""
    channels = scenery.palette.shape[1]
    for index in range(drawn.boxes):
        top, bottom = drawn.top[index], drawn.bottom[index]
        start, end = drawn.left[index] * channels, drawn.right[index] * channels
        for row in range(top, bottom):
            copy_bytes(lines[row, start:end], scenery.background[row, start:end])
        _restore_bricks(lines, scenery, world, drawn.left[index], top, drawn.right[index], bottom)
    drawn.boxes = 0


@inlined
def _restore_bricks(
    lines: Lines, scenery: Scenery, world: WorldRecord, left: int, top: int, right: int, bottom: int
) -> None:
    """Draw the cells that have pixels in a box; its right and bottom are excluded."""
    view = scenery.views[0]
    if top >= view.rows[ROWS] or bottom <= view.rows[0]:
        return
    for row in range(ROWS):
        if view.rows[row] >= bottom or view.rows[row + 1] <= top:
            continue
        for column in range(COLUMNS):
            if view.columns[column] < right and view.columns[column + 1] > left:
                _draw_cell(lines, scenery, world, row, column)


@kernel
def _draw_cell(lines: Lines, scenery: Scenery, world: WorldRecord, row: int, column: int) -> None:
    """Draw a cell of the lattice: copy the pixels of its look."""
    view = scenery.views[0]
    cell = row * COLUMNS + column
    look = brick_look(int(world.kind[cell]), int(world.brick_hits[cell]), world.round_number)
    channels = scenery.palette.shape[1]
    left, top = view.columns[0] * channels, view.rows[0]
    start, end = view.columns[column] * channels, view.columns[column + 1] * channels
    for y in range(view.rows[row], view.rows[row + 1]):
        copy_bytes(lines[y, start:end], scenery.looks[look, y - top, start - left : end - left])


@inlined
def draw_bricks(lines: Lines, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord) -> None:
    """Draw the cells that look different from the picture."""
    # How damaged silver looks depends on the hits that it needs in this round.
    if drawn.round_number == world.round_number and not _bricks_differ(drawn, world):
        return
    new_round = drawn.round_number != world.round_number
    drawn.round_number = world.round_number
    for cell in range(CELLS):
        hits, kind = world.brick_hits[cell], world.kind[cell]
        differs = hits != drawn.brick_hits[cell] or (
            hits > 0 and (new_round or kind != drawn.kind[cell])
        )
        drawn.brick_hits[cell] = hits
        drawn.kind[cell] = kind
        if differs:
            _draw_cell(lines, scenery, world, cell // COLUMNS, cell % COLUMNS)


@inlined
def _bricks_differ(drawn: DrawnRecord, world: WorldRecord) -> bool:
    """Return whether any brick may look different from the picture."""
    difference = 0
    for cell in range(CELLS):
        difference |= world.brick_hits[cell] ^ drawn.brick_hits[cell]
        difference |= world.kind[cell] ^ drawn.kind[cell]
    return difference != 0
