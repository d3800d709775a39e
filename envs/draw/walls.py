"""What moves in the walls: the gates in the ceiling, and the exit on the right."""

from ...physics.kernels import inlined
from ..rules import FIELD_HEIGHT, FIELD_WIDTH, GATE_TICKS, GATE_X, GATES, MAX_ENEMIES
from ..state import ENTERING, WorldRecord
from .canvas import DrawnRecord, note_box
from .palette import ARROW, LAMP, OPENING
from .raster import Image, draw_line, fill_rectangle
from .scenery import Scenery
from .view import EXIT_BOTTOM, EXIT_TOP, GATE_WIDTH, WALL_WIDTH

# Lengths in brick widths.
EDGE = 0.06  # the lit edge of a gate's wing
# In pictures without the ceiling, a gate is a mark of this height at the field's upper edge.
MARK_HEIGHT = 0.2


@inlined
def gate_opening(world: WorldRecord, gate: int) -> float:
    """Return how far a gate in the ceiling is open, from 0 to 1."""
    for enemy in range(MAX_ENEMIES):
        enters = world.enemy_state[enemy] == ENTERING
        if enters and abs(world.enemy_x[enemy] - GATE_X[gate]) < GATE_WIDTH:
            return 1.0
    if world.boss_hits > 0 or world.enemy_gate != gate or world.enemy_wait >= GATE_TICKS:
        return 0.0
    return float(1.0 - world.enemy_wait / GATE_TICKS)


@inlined
def draw_gates(image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord) -> None:
    """Draw the gates in the ceiling that are not closed."""
    if world.enemies == 0 and world.enemy_wait >= GATE_TICKS:
        return
    view, palette = scenery.views[0], scenery.palette
    lamp, opening = palette[LAMP], palette[OPENING]
    scale = view.scale
    bottom = view.bottom - FIELD_HEIGHT * scale
    for gate in range(GATES):
        part = gate_opening(world, gate)
        if part == 0.0:
            continue
        x = view.left + GATE_X[gate] * scale
        half = GATE_WIDTH / 2 * part * scale
        left, right = x - half, x + half
        if view.header == 0:
            low = bottom + MARK_HEIGHT * scale
            note_box(drawn, image, left, bottom, right, low)
            fill_rectangle(image, left, bottom, right, low, lamp, lamp)
            continue
        top, edge = bottom - WALL_WIDTH * scale, min(EDGE * scale, half)
        note_box(drawn, image, left, top, right, bottom)
        fill_rectangle(image, left, top, right, bottom, opening, opening)
        fill_rectangle(image, left, top, left + edge, bottom, lamp, lamp)
        fill_rectangle(image, right - edge, top, right, bottom, lamp, lamp)


@inlined
def draw_exit(image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord) -> None:
    """Draw the open exit in the right wall: arrows that point out."""
    if world.exit_open == 0:
        return
    view, palette = scenery.views[0], scenery.palette
    arrow, opening = palette[ARROW], palette[OPENING]
    scale = view.scale
    left, right = view.left + FIELD_WIDTH * scale, view.left + (FIELD_WIDTH + WALL_WIDTH) * scale
    top, bottom = view.bottom - EXIT_TOP * scale, view.bottom - EXIT_BOTTOM * scale
    note_box(drawn, image, left, top, right, bottom)
    fill_rectangle(image, left, top, right, bottom, arrow, arrow)
    if view.header == 0:
        return
    edge = EDGE * scale
    fill_rectangle(image, left, top + edge, right, bottom - edge, opening, opening)
    middle = (top + bottom) / 2
    for index in range(2):
        x = left + (0.1 + 0.17 * index) * scale
        reach = 0.14 * scale
        draw_line(image, x, middle - 2.0 * reach, x + reach, middle, edge, arrow)
        draw_line(image, x, middle + 2.0 * reach, x + reach, middle, edge, arrow)
