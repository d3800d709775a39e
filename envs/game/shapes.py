"""The colliders of the game, their places in the table of shapes, and what a ball can meet."""

import math
from typing import Any

from ...physics.shapes.colliders import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    Particle,
    Rectangle,
)
from ...physics.shapes.table import shape_table
from ..rules import (
    BALL_RADIUS,
    BEAM_HEIGHT,
    BEAM_WIDTH,
    BRICK_HEIGHT,
    BRICK_WIDTH,
    CAPSULE_HEIGHT,
    CAPSULE_WIDTH,
    FIELD_WIDTH,
    LONG_PADDLE_WIDTH,
    PADDLE_THICKNESS,
    PADDLE_WIDTH,
)

PADDLE_SHAPE = 0
LONG_PADDLE_SHAPE = 1
BALL_SHAPE = 2
BRICK_SHAPE = 3
CAPSULE_SHAPE = 4
BEAM_SHAPE = 5
LEFT_WALL_SHAPE = 6  # lies at (0, 0)
RIGHT_WALL_SHAPE = 7  # lies at (FIELD_WIDTH, 0)
CEILING_SHAPE = 8  # lies at (0, FIELD_HEIGHT)
BOSS_SHAPE = 9
SHARD_SHAPE = 10
ENEMY_SHAPE = 11  # and the following, one for each kind

# What a ball or a beam meets.
NOTHING = 0
WALL = 1
CEILING = 2
BRICK = 3
PADDLE = 4
ENEMY = 5
BOSS = 6


def paddle_collider(width: float) -> Convex:
    """Return the paddle's collider: a bar with pointed ends, which send a ball up or down.

    Args:
        width: from tip to tip, in brick widths.
    """
    half, thick = width / 2, PADDLE_THICKNESS / 2
    return Convex(
        [
            (half, 0.0),
            (half - thick, thick),
            (-half + thick, thick),
            (-half, 0.0),
            (-half + thick, -thick),
            (half - thick, -thick),
        ]
    )


def paddle_widths(paddle: float) -> tuple[float, float]:
    """Return the paddle's width, plain and enlarged; none is wider than the field.

    Args:
        paddle: factor on the paddle's width, at most 5.
    """
    return PADDLE_WIDTH * paddle, min(LONG_PADDLE_WIDTH * paddle, FIELD_WIDTH)


def boss_collider() -> Convex:
    """Return the boss's collider: a face with a broad brow and a narrow chin."""
    return Convex(
        [
            (0.6, -1.45),
            (1.5, -0.5),
            (1.75, 0.6),
            (1.2, 1.3),
            (-1.2, 1.3),
            (-1.75, 0.6),
            (-1.5, -0.5),
            (-0.6, -1.45),
        ]
    )


def shard_collider() -> Convex:
    """Return the collider of what the boss throws: a splinter with its point ahead."""
    return Convex([(0.0, -0.25), (0.14, 0.08), (0.0, 0.17), (-0.14, 0.08)])


def enemy_colliders() -> list[Collider]:
    """Return the colliders of the kinds of enemies; all fit through a gap of one brick."""
    hexagon = [(0.0, -0.3), (0.32, -0.12), (0.32, 0.16), (0.0, 0.36), (-0.32, 0.16), (-0.32, -0.12)]
    return [
        Convex([(0.0, -0.36), (0.36, 0.24), (-0.36, 0.24)]),
        Rectangle(0.5, 0.5, math.pi / 4),
        Convex(hexagon),
        Rectangle(0.66, 0.3, math.pi / 6),
    ]


def game_shapes(paddle: float) -> tuple[Any, Any]:
    """Return the game's shapes and their edges, as records.

    Args:
        paddle: factor on the paddle's width.
    """
    width, long_width = paddle_widths(paddle)
    return shape_table(
        [
            paddle_collider(width),
            paddle_collider(long_width),
            Particle(BALL_RADIUS),
            AxisAlignedRectangle(BRICK_WIDTH, BRICK_HEIGHT),
            AxisAlignedRectangle(CAPSULE_WIDTH, CAPSULE_HEIGHT),
            AxisAlignedRectangle(BEAM_WIDTH, BEAM_HEIGHT),
            AxisAlignedHalfPlane("+x"),
            AxisAlignedHalfPlane("-x"),
            AxisAlignedHalfPlane("-y"),
            boss_collider(),
            shard_collider(),
            *enemy_colliders(),
        ]
    )
