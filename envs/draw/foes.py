"""The player's opponents: enemies, the boss and its shards, in the shapes of their colliders."""

import math

import numpy as np

from ...physics.kernels import inlined, kernel
from ..game.boss import MOUTH
from ..game.shapes import BOSS_SHAPE, ENEMY_SHAPE, SHARD_SHAPE
from ..rules import BOSS_HITS, BOSS_X, BOSS_Y, FIELD_HEIGHT, MAX_ENEMIES, MAX_SHARDS
from ..state import ABSENT, RulesRecord, WorldRecord
from .canvas import DrawnRecord, note_shape
from .palette import (
    BOSS_BROW,
    BOSS_EYE,
    BOSS_FACE,
    BOSS_GLOW,
    BOSS_LIT,
    BOSS_RIM,
    BOSS_SHADED,
    BOSS_STEPS,
    CRACK,
    ENEMY_LIT,
    ENEMY_RIM,
    ENEMY_SHADED,
    EYE,
    OPENING,
    PUPIL,
    SHARD,
    SHARD_RIM,
)
from .raster import Colour, Image, draw_line, fill_convex, fill_disc
from .scenery import Scenery
from .view import WALL_WIDTH

# Fractions of the collider's size.
ENEMY_BODY = 0.76
BOSS_BODY = 0.94
BOSS_PLATE = 0.66
SHARD_BODY = 0.6
# Lengths in brick widths.
EYE_RADIUS = 0.13
PUPIL_RADIUS = 0.065
GAZE = 0.055  # how far a pupil moves from the middle of the eye
MOUTH_RADIUS = 0.24
GLOW_TICKS = 30  # so long before the boss throws, its mouth glows
CRACK_WIDTH = 0.055
# Each hit adds a crack, from (x, y) to (x, y), relative to the boss's middle, y up.
BOSS_CRACKS = np.array(
    [
        (-1.09, 1.19, -0.81, 0.84),
        (1.42, -0.4, 1.03, -0.28),
        (-0.81, 0.84, -0.97, 0.57),
        (0.47, 1.19, 0.28, 0.87),
        (-1.52, 0.1, -1.14, -0.05),
        (1.03, -0.28, 0.78, -0.63),
        (0.28, 0.87, 0.57, 0.63),
        (-1.14, -0.05, -0.9, -0.47),
        (1.58, 0.66, 1.19, 0.7),
        (-0.47, -1.29, -0.52, -0.87),
        (0.57, 0.63, 0.11, 0.28),
        (1.19, 0.7, 0.97, 0.97),
        (-0.9, -0.47, -1.06, -0.7),
        (0.11, 0.28, -0.19, -0.1),
        (0.78, -0.63, 0.43, -0.76),
    ]
)


@inlined
def draw_enemies(
    image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord, rules: RulesRecord
) -> None:
    """Draw the enemies; what is still above the gate is hidden."""
    if world.enemies == 0:
        return
    view = scenery.views[0]
    ceiling = FIELD_HEIGHT + (WALL_WIDTH if view.header == 1 else 0.0)
    hidden = max(0, math.ceil(view.bottom - ceiling * view.scale))
    for enemy in range(MAX_ENEMIES):
        if world.enemy_state[enemy] != ABSENT:
            shape = rules.shapes[ENEMY_SHAPE + world.enemy_kind[enemy]]
            x = view.left + world.enemy_x[enemy] * view.scale
            y = view.bottom - world.enemy_y[enemy] * view.scale
            note_shape(drawn, image, shape, x, y, view.scale, hidden)
            _draw_enemy(image[hidden:], scenery, world, rules, enemy, x, y - hidden)


@inlined
def _draw_enemy(
    image: Image,
    scenery: Scenery,
    world: WorldRecord,
    rules: RulesRecord,
    enemy: int,
    x: float,
    y: float,
) -> None:
    """Draw an enemy at x, y in pixels; it looks where it goes."""
    palette, scale = scenery.palette, scenery.views[0].scale
    kind = world.enemy_kind[enemy]
    shape, edges = rules.shapes[ENEMY_SHAPE + kind], rules.edges
    rim, lit = palette[ENEMY_RIM + kind], palette[ENEMY_LIT + kind]
    fill_convex(image, shape, edges, x, y, scale, rim, rim)
    fill_convex(image, shape, edges, x, y, ENEMY_BODY * scale, lit, palette[ENEMY_SHADED + kind])
    fill_disc(image, x, y, EYE_RADIUS * scale, palette[EYE])
    if scenery.views[0].header == 0:
        return
    vx, vy = world.enemy_vx[enemy], world.enemy_vy[enemy]
    speed = math.sqrt(vx * vx + vy * vy)
    gaze = GAZE * scale / speed if speed > 0.0 else 0.0
    fill_disc(image, x + vx * gaze, y - vy * gaze, PUPIL_RADIUS * scale, palette[PUPIL])


@inlined
def draw_boss(
    image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord, rules: RulesRecord
) -> None:
    """Draw the boss, if there is one; each hit makes it redder and adds a crack."""
    if world.boss_hits == 0:
        return
    view, palette = scenery.views[0], scenery.palette
    scale = view.scale
    x, y = view.left + BOSS_X * scale, view.bottom - BOSS_Y * scale
    shape, edges = rules.shapes[BOSS_SHAPE], rules.edges
    note_shape(drawn, image, shape, x, y, scale, 0)
    step = (BOSS_HITS - world.boss_hits) * BOSS_STEPS // BOSS_HITS
    lit, shaded = palette[BOSS_LIT + step], palette[BOSS_SHADED + step]
    rim, face, brow = palette[BOSS_RIM], palette[BOSS_FACE], palette[BOSS_BROW]
    fill_convex(image, shape, edges, x, y, scale, rim, rim)
    fill_convex(image, shape, edges, x, y, BOSS_BODY * scale, lit, shaded)
    fill_convex(image, shape, edges, x, y + 0.12 * scale, BOSS_PLATE * scale, face, face)
    for index in range(BOSS_HITS - world.boss_hits):
        _draw_stroke(
            image,
            x,
            y,
            scale,
            BOSS_CRACKS[index, 0],
            BOSS_CRACKS[index, 1],
            BOSS_CRACKS[index, 2],
            BOSS_CRACKS[index, 3],
            CRACK_WIDTH,
            palette[CRACK],
        )
    for side in range(-1, 2, 2):
        _draw_stroke(
            image, x, y, scale, 0.78 * side, 0.22, 0.28 * side, 0.02, 0.2, palette[BOSS_EYE]
        )
        _draw_stroke(image, x, y, scale, 0.95 * side, 0.55, 0.16 * side, 0.22, 0.18, brow)
    mouth = MOUTH_RADIUS * scale
    fill_disc(image, x, y + MOUTH * scale, mouth, palette[OPENING])
    if world.shard_wait < GLOW_TICKS:
        part = 1.0 - world.shard_wait / GLOW_TICKS
        fill_disc(image, x, y + MOUTH * scale, 0.9 * part * mouth, palette[BOSS_GLOW])


@kernel
def _draw_stroke(
    image: Image,
    x: float,
    y: float,
    scale: float,
    start_x: float,
    start_y: float,
    end_x: float,
    end_y: float,
    width: float,
    colour: Colour,
) -> None:
    """Draw a line between two points of a body at x, y in pixels."""
    draw_line(
        image,
        x + start_x * scale,
        y - start_y * scale,
        x + end_x * scale,
        y - end_y * scale,
        width * scale,
        colour,
    )


@inlined
def draw_shards(
    image: Image, drawn: DrawnRecord, scenery: Scenery, world: WorldRecord, rules: RulesRecord
) -> None:
    """Draw the shards that the boss has thrown."""
    if world.shards == 0:
        return
    view, palette = scenery.views[0], scenery.palette
    scale = view.scale
    shape, edges = rules.shapes[SHARD_SHAPE], rules.edges
    rim, body = palette[SHARD_RIM], palette[SHARD]
    size = scale * (SHARD_BODY if view.header == 1 else 1.0)
    for shard in range(MAX_SHARDS):
        if world.shard_state[shard] == ABSENT:
            continue
        x = view.left + world.shard_x[shard] * scale
        y = view.bottom - world.shard_y[shard] * scale
        note_shape(drawn, image, shape, x, y, scale, 0)
        fill_convex(image, shape, edges, x, y, scale, rim, rim)
        fill_convex(image, shape, edges, x, y, size, body, body)
