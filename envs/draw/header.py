"""The score line above the field."""

from ...physics.kernels import inlined
from ..rules import FIELD_HEIGHT, NO_POWER
from ..state import WorldRecord
from .canvas import DrawnRecord, Lines, copy_bytes
from .font import count_digits, draw_number, text_step
from .palette import GRIP_LIT, PADDLE_LIT, PADDLE_SHADED, VALUE
from .player import draw_capsule
from .raster import Image, fill_rectangle, fill_rounded_rectangle, first_pixel
from .scenery import (
    LABEL_HEIGHT,
    LABEL_TOP,
    LIVES_X,
    ROUND_X,
    SCORE_X,
    VALUE_HEIGHT,
    VALUE_TOP,
    Palette,
    Scenery,
)
from .view import WALL_WIDTH, ViewRecord

# Each life is a small paddle, in brick widths. More than `LIVES_SHOWN` are one paddle and a number.
LIFE_WIDTH = 0.66
LIFE_HEIGHT = 0.2
LIFE_STEP = 0.8
LIVES_SHOWN = 5
SCORE_WIDTH = 4.4  # a long score is drawn smaller, to fit
POWER_X = 10.55  # the middle of the capsule that shows the power


@inlined
def draw_header(
    image: Image, lines: Lines, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord
) -> None:
    """Draw the score line again if it is out of date."""
    if (
        drawn.score == world.score
        and drawn.lives == world.lives
        and drawn.header_round == world.round_number
        and drawn.power == world.power
    ):
        return
    view = scenery.views[0]
    ceiling = view.bottom - (FIELD_HEIGHT + WALL_WIDTH) * view.scale
    for row in range(first_pixel(ceiling)):
        copy_bytes(lines[row], scenery.background[row])
    drawn.score = world.score
    drawn.lives = world.lives
    drawn.header_round = world.round_number
    drawn.power = world.power
    _draw_values(image, view, scenery.palette, world)
    if world.power != NO_POWER:
        middle = LABEL_TOP - LABEL_HEIGHT / 2
        x, y = view.left + POWER_X * view.scale, view.bottom - middle * view.scale
        draw_capsule(image, scenery, world.power, x, y)


@inlined
def _draw_values(image: Image, view: ViewRecord, palette: Palette, world: WorldRecord) -> None:
    """Draw the numbers of the score line, and the lives as small paddles."""
    scale = view.scale
    top = view.bottom - VALUE_TOP * scale
    height = VALUE_HEIGHT * scale
    value = palette[VALUE]
    fitting = SCORE_WIDTH * scale / (count_digits(world.score) * text_step(1.0))
    draw_number(image, world.score, view.left + SCORE_X * scale, top, min(height, fitting), value)
    draw_number(image, world.round_number, view.left + ROUND_X * scale, top, height, value)
    shown = world.lives if world.lives <= LIVES_SHOWN else 1
    for life in range(shown):
        _draw_life(image, palette, view.left + (LIVES_X + LIFE_STEP * life) * scale, top, scale)
    if world.lives > LIVES_SHOWN:
        x = view.left + (LIVES_X + LIFE_STEP) * scale
        draw_number(image, world.lives, x, top, height, value)


@inlined
def _draw_life(image: Image, palette: Palette, x: float, y: float, scale: float) -> None:
    """Draw a small paddle on the score line; x, y: its upper left corner, in pixels."""
    top = y + (VALUE_HEIGHT - LIFE_HEIGHT) / 2 * scale
    bottom = top + LIFE_HEIGHT * scale
    right = x + LIFE_WIDTH * scale
    grip = 0.25 * (right - x)
    fill_rounded_rectangle(image, x, top, right, bottom, LIFE_HEIGHT / 2 * scale, palette[GRIP_LIT])
    fill_rectangle(
        image, x + grip, top, right - grip, bottom, palette[PADDLE_LIT], palette[PADDLE_SHADED]
    )
