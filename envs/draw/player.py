"""What the player has: the paddle with its powers, balls and beams; and the capsules."""

from ...physics.kernels import inlined, kernel
from ..rules import (
    BALL_RADIUS,
    BEAM_HEIGHT,
    BEAM_PLACE,
    BEAM_WIDTH,
    CAPSULE_HEIGHT,
    CAPSULE_LETTERS,
    CAPSULE_WIDTH,
    LASER,
    MAX_BALLS,
    MAX_BEAMS,
    NO_CAPSULE,
    PADDLE_Y,
)
from ..state import ABSENT, RulesRecord, WorldRecord
from .canvas import DrawnRecord, note_box, note_shape
from .font import GLYPH_WIDTH, draw_glyph
from .palette import (
    BALL,
    BALL_RIM,
    BEAM,
    BEAM_CORE,
    CAPSULE_BODY,
    CAPSULE_LIT,
    CAPSULE_SHADED,
    GRIP_LIT,
    GRIP_SHADED,
    LETTER,
    MUZZLE,
    PADDLE_LIT,
    PADDLE_SHADED,
)
from .raster import (
    Colour,
    Image,
    blend,
    blend_channel,
    fill_disc,
    fill_rectangle,
    fill_rounded_rectangle,
    first_pixel,
    height_part,
    last_pixel,
    mix,
    rounded_coverage,
    row_span,
    span_coverage,
)
from .scenery import Scenery

# Lengths in brick widths.
GRIP = 0.45  # of the paddle's coloured ends
MUZZLE_WIDTH = 0.2  # of the laser, where its beams start
CAPSULE_CORNER = 0.1
CAPSULE_RIM = 0.035
LETTER_HEIGHT = 0.27
STRIPE = 0.2  # replaces a letter that would be too small to read
# Four fourths of a disc of radius 1 cover pi / 4 of their pixels; the coverage may be wrong by 1/8.
BRIGHTENING = 1.5

_LETTERS = tuple(ord(letter) for letter in CAPSULE_LETTERS)


@inlined
def draw_paddle(
    image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord, rules: RulesRecord
) -> None:
    """Draw the paddle in its collider's shape; the colours of ends and body show its power."""
    view, palette = scenery.views[0], scenery.palette
    shape, edges = rules.shapes[world.paddle_shape], rules.edges
    power, scale = world.power, view.scale
    x, y = view.left + world.paddle_x * scale, view.bottom - PADDLE_Y * scale
    seam = (shape.upper_x - GRIP) * scale
    muzzle = BEAM_PLACE * world.paddle_half * scale if power == LASER else -scale
    note_shape(drawn, image, shape, x, y, scale, 0)
    top, bottom = y - shape.upper_y * scale, y - shape.lower_y * scale
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        part = height_part(row, top, bottom)
        span = row_span(shape, edges, x, y, scale, row)
        if span.height == 0.0:
            continue
        for column in range(first_pixel(span.begin), last_pixel(span.end, image.shape[1])):
            coverage = span_coverage(span, shape, edges, x, y, scale, row, column)
            across = abs(column + 0.5 - x)
            grip = min(max(across - seam + 0.5, 0.0), 1.0)
            hot = min(max(MUZZLE_WIDTH / 2 * scale - abs(across - muzzle) + 0.5, 0.0), 1.0)
            for channel in range(image.shape[2]):
                middle = mix(
                    palette[PADDLE_LIT + power, channel],
                    palette[PADDLE_SHADED + power, channel],
                    part,
                )
                end = mix(
                    palette[GRIP_LIT + power, channel], palette[GRIP_SHADED + power, channel], part
                )
                colour = mix(mix(middle, end, grip), palette[MUZZLE, channel], hot)
                blend_channel(image, row, column, channel, colour, coverage)


@inlined
def draw_balls(image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord) -> None:
    """Draw the balls: in large pictures with a rim and a highlight, in small ones bright."""
    view, palette = scenery.views[0], scenery.palette
    radius = BALL_RADIUS * view.scale
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == ABSENT:
            continue
        x = view.left + world.ball_x[ball] * view.scale
        y = view.bottom - world.ball_y[ball] * view.scale
        note_box(drawn, image, x - radius, y - radius, x + radius, y + radius)
        if view.header == 1:
            fill_disc(image, x, y, radius, palette[BALL_RIM])
            fill_disc(image, x - 0.12 * radius, y - 0.12 * radius, 0.78 * radius, palette[BALL])
        else:
            _fill_bright_disc(image, x, y, radius, palette[BALL])


@inlined
def _fill_bright_disc(image: Image, x: float, y: float, radius: float, colour: Colour) -> None:
    """Fill a small disc so that at least one of its pixels has its colour, wherever it lies.

    If a disc lies on the corner of four pixels, it covers a part of each. All parts are enlarged by
    a factor with which these four would be full.
    """
    gain = max(1.0, BRIGHTENING / (radius * radius))
    left, top, right, bottom = x - radius, y - radius, x + radius, y + radius
    for row in range(first_pixel(top), last_pixel(bottom, image.shape[0])):
        for column in range(first_pixel(left), last_pixel(right, image.shape[1])):
            part = rounded_coverage(row, column, left, top, right, bottom, radius)
            blend(image, row, column, colour, min(1.0, gain * part))


@inlined
def draw_beams(image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord) -> None:
    """Draw the laser's beams, bright in the middle."""
    view, palette = scenery.views[0], scenery.palette
    across, along = BEAM_WIDTH / 2 * view.scale, BEAM_HEIGHT / 2 * view.scale
    core = palette[BEAM_CORE]
    for beam in range(MAX_BEAMS):
        if world.beam_state[beam] == ABSENT:
            continue
        x = view.left + world.beam_x[beam] * view.scale
        y = view.bottom - world.beam_y[beam] * view.scale
        left, top, right, bottom = x - across, y - along, x + across, y + along
        note_box(drawn, image, left, top, right, bottom)
        fill_rectangle(image, left, top, right, bottom, core, palette[BEAM])
        inset = across / 2
        fill_rectangle(image, x - inset, top, x + inset, bottom, core, core)


@inlined
def draw_falling_capsule(
    image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord
) -> None:
    """Draw the falling capsule, if there is one."""
    if world.capsule == NO_CAPSULE:
        return
    view = scenery.views[0]
    scale = view.scale
    x, y = view.left + world.capsule_x * scale, view.bottom - world.capsule_y * scale
    across, along = CAPSULE_WIDTH / 2 * scale, CAPSULE_HEIGHT / 2 * scale
    note_box(drawn, image, x - across, y - along, x + across, y + along)
    draw_capsule(image, scenery, world.capsule, x, y)


@kernel
def draw_capsule(image: Image, scenery: Scenery, kind: int, x: float, y: float) -> None:
    """Draw a capsule, its middle at x, y in pixels; in large pictures with its letter."""
    palette, scale = scenery.palette, scenery.views[0].scale
    across, along = CAPSULE_WIDTH / 2 * scale, CAPSULE_HEIGHT / 2 * scale
    left, top, right, bottom = x - across, y - along, x + across, y + along
    body, letter = palette[CAPSULE_BODY + kind], palette[LETTER + kind]
    if scenery.views[0].header == 0:
        half = STRIPE / 2 * scale
        fill_rectangle(image, left, top, right, bottom, body, body)
        fill_rectangle(image, x - half, top, x + half, bottom, letter, letter)
        return
    corner, rim = CAPSULE_CORNER * scale, CAPSULE_RIM * scale
    shaded, lit = palette[CAPSULE_SHADED + kind], palette[CAPSULE_LIT + kind]
    fill_rounded_rectangle(image, left, top, right, bottom, corner, shaded)
    left, top, right, bottom = left + rim, top + rim, right - rim, bottom - rim
    fill_rounded_rectangle(image, left, top, right, bottom, corner, body)
    fill_rectangle(image, left + corner, top, right - corner, y, lit, body)
    height = LETTER_HEIGHT * scale
    draw_glyph(image, _LETTERS[kind], x - GLYPH_WIDTH * height / 2, y - height / 2, height, letter)
