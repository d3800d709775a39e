"""A picture of a world: what stands still is copied, the rest is drawn, one function a thing."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.compilation import kernel
from .bricks import hits_needed
from .font import count_digits, draw_number, text_step
from .palette import (
    BALL,
    BALL_RIM,
    GRIP_LIT,
    GRIP_SHADED,
    PADDLE_LIT,
    PADDLE_SHADED,
    PALETTE,
    VALUE,
)
from .raster import (
    blend_channel,
    convex_coverage,
    fill_disc,
    fill_rectangle,
    fill_rounded_rectangle,
    first_pixel,
    last_pixel,
    mix,
)
from .rules import (
    BALL_RADIUS,
    COLUMNS,
    MAX_BALLS,
    PADDLE_Y,
    ROWS,
    SILVER,
)
from .scenery import (
    DAMAGED,
    DAMAGES,
    LIVES_X,
    ROUND_X,
    SCORE_X,
    VALUE_HEIGHT,
    VALUE_TOP,
    scenery,
)
from .state import ABSENT
from .view import FULL_HEIGHT, FULL_WIDTH

DEFAULT_HEIGHT = 512  # pixels: 32 per brick width
MAX_SIZE = 4096  # pixels

GRIP = 0.45  # the length of the paddle's coloured ends
# The small paddles that count the lives, in brick widths; more of them are a number.
LIFE_WIDTH = 0.66
LIFE_HEIGHT = 0.2
LIFE_STEP = 0.8
LIVES_SHOWN = 5
SCORE_WIDTH = 4.4  # the score grows smaller to stay within it


def draw_world(
    worlds: Any,
    rules: Any,
    index: int,
    height: int = DEFAULT_HEIGHT,
    width: int | None = None,
) -> NDArray[np.uint8]:
    """Return a picture of one world of a batch, a fresh uint8 array [height, width, 3].

    The same state gives the same bits, everywhere. No display is needed.

    Args:
        worlds: `World` records [n].
        rules: `Rules` [1].
        index: of the world.
        height: in pixels.
        width: in pixels; None gives the field, its walls and the score line just enough.

    Raises:
        TypeError, ValueError: a size is no integer, or out of range.
    """
    _check_size("height", height)
    if width is None:
        width = max(1, round(height * FULL_WIDTH / FULL_HEIGHT))
    _check_size("width", width)
    shared = scenery(int(height), int(width))
    frame = shared.background.copy()
    lines = frame.reshape(frame.shape[0], -1)
    draw_play(frame, lines, shared.view, PALETTE, shared.looks, worlds, rules, int(index))
    return frame


def _check_size(name: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(f"{name} must be an integer (pixels); got {value!r}")
    if not 1 <= value <= MAX_SIZE:
        raise ValueError(f"{name} must be between 1 and {MAX_SIZE} pixels; got {value!r}")


@kernel
def brick_look(kind: int, hits_left: int, round_number: int) -> int:
    """Return the look of a cell: none, its kind's, or that of silver damaged so far."""
    if hits_left == 0:
        return 0
    if kind != SILVER:
        return kind
    needed = hits_needed(kind, round_number)
    return kind if hits_left >= needed else DAMAGED + 1 + (needed - hits_left) * DAMAGES // needed


@kernel
def draw_bricks(lines: Any, view: Any, looks: Any, world: Any, channels: int) -> None:
    """Draw the bricks that are there, by copying their cells' pixels from a look's picture.

    Args:
        lines: the picture's bytes, uint8 [height, width * channels]; looks: see `Scenery`.
    """
    left, top = view.columns[0] * channels, view.rows[0]
    for row in range(ROWS):
        for column in range(COLUMNS):
            cell = row * COLUMNS + column
            hits_left = int(world.brick_hits[cell])
            if hits_left > 0:
                look = brick_look(int(world.kind[cell]), hits_left, world.round_number)
                start, end = view.columns[column] * channels, view.columns[column + 1] * channels
                for y in range(view.rows[row], view.rows[row + 1]):
                    line = lines[y, start:end]
                    source = looks[look, y - top, start - left : end - left]
                    # As a loop, because assigning a slice costs two seconds of compilation.
                    for index in range(line.shape[0]):
                        line[index] = source[index]


@kernel
def draw_paddle(
    image: Any, palette: Any, shape: Any, edges: Any, x: float, y: float, scale: float
) -> None:
    """Draw the paddle's collider (its middle at x, y in pixels), with coloured ends."""
    seam = (shape.upper_x - GRIP) * scale
    for row in range(
        first_pixel(y - shape.upper_y * scale),
        last_pixel(y - shape.lower_y * scale, image.shape[0]),
    ):
        part = min(max(0.5 + (row + 0.5 - y) / ((shape.upper_y - shape.lower_y) * scale), 0.0), 1.0)
        for column in range(
            first_pixel(x + shape.lower_x * scale),
            last_pixel(x + shape.upper_x * scale, image.shape[1]),
        ):
            coverage = convex_coverage(edges, shape.first, shape.count, x, y, scale, row, column)
            grip = min(max(abs(column + 0.5 - x) - seam + 0.5, 0.0), 1.0)
            for channel in range(image.shape[2]):
                middle = mix(palette[PADDLE_LIT, channel], palette[PADDLE_SHADED, channel], part)
                end = mix(palette[GRIP_LIT, channel], palette[GRIP_SHADED, channel], part)
                blend_channel(image, row, column, channel, mix(middle, end, grip), coverage)


@kernel
def draw_ball(image: Any, palette: Any, x: float, y: float, scale: float) -> None:
    """Draw a ball (its middle at x, y in pixels): a rim, and a highlight at the upper left."""
    radius = BALL_RADIUS * scale
    fill_disc(image, x, y, radius, palette[BALL_RIM])
    fill_disc(image, x - 0.12 * radius, y - 0.12 * radius, 0.78 * radius, palette[BALL])


@kernel
def draw_life(image: Any, palette: Any, x: float, y: float, scale: float) -> None:
    """Draw a small paddle on the score line; x, y: upper left corner of the line, in pixels."""
    top = y + (VALUE_HEIGHT - LIFE_HEIGHT) / 2 * scale
    bottom = top + LIFE_HEIGHT * scale
    right = x + LIFE_WIDTH * scale
    grip = 0.25 * (right - x)
    fill_rounded_rectangle(image, x, top, right, bottom, LIFE_HEIGHT / 2 * scale, palette[GRIP_LIT])
    fill_rectangle(
        image, x + grip, top, right - grip, bottom, palette[PADDLE_LIT], palette[PADDLE_SHADED]
    )


@kernel
def draw_header(image: Any, view: Any, palette: Any, world: Any) -> None:
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
        draw_life(image, palette, view.left + (LIVES_X + LIFE_STEP * life) * scale, top, scale)
    if world.lives > LIVES_SHOWN:
        draw_number(
            image, world.lives, view.left + (LIVES_X + LIFE_STEP) * scale, top, height, value
        )


@kernel
def draw_play(
    image: Any,
    lines: Any,
    view: Any,
    palette: Any,
    looks: Any,
    worlds: Any,
    rules: Any,
    index: int,
) -> None:
    """Draw what changes of one world over the background; lines: the same bytes, see above."""
    where = view[0]
    world = worlds[index]
    shape = rules[0].shapes[world.paddle_shape]
    scale = where.scale
    draw_bricks(lines, where, looks, world, image.shape[2])
    draw_paddle(
        image,
        palette,
        shape,
        rules[0].edges,
        where.left + world.paddle_x * scale,
        where.bottom - PADDLE_Y * scale,
        scale,
    )
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] != ABSENT:
            x = where.left + world.ball_x[ball] * scale
            draw_ball(image, palette, x, where.bottom - world.ball_y[ball] * scale, scale)
    if where.header:
        draw_header(image, where, palette, world)
