"""The colliders of the game, their places in the table of shapes, and what a ball can meet."""

import math
from typing import Any

from ...physics.kernels import kernel
from ...physics.shapes.bounds import bounds_of
from ...physics.shapes.colliders import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    Particle,
    Rectangle,
)
from ...physics.shapes.polygons import close_polygon
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


@kernel
def fit_paddle(rules: Any, paddle: float) -> None:
    """Write how wide the paddle is, plain and enlarged, and its shapes.

    Args:
        rules: a `Rules` record with the shapes of any paddle.
        paddle: factor on the paddle's width, at most 5. No paddle is wider than the field.
    """
    rules.paddle_half = PADDLE_WIDTH * paddle / 2
    rules.long_paddle_half = min(LONG_PADDLE_WIDTH * paddle, FIELD_WIDTH) / 2
    shapes, edges = rules.shapes, rules.edges
    for number in (PADDLE_SHAPE, LONG_PADDLE_SHAPE):
        half = rules.paddle_half if number == PADDLE_SHAPE else rules.long_paddle_half
        shape = shapes[number]
        for index in range(shape.first, shape.first + shape.count):
            edge = edges[index]
            # The ends slope by 45 degrees: a corner lies as far inside as above or below the tips.
            x = half - abs(edge.start_y)
            edge.start_x = x if edge.start_x > 0.0 else -x
        close_polygon(edges, shape.first, shape.count)
        bounds = bounds_of(edges, shape.first, shape.count, shape.radius)
        shape.lower_x, shape.lower_y, shape.upper_x, shape.upper_y = bounds


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


def game_shapes() -> tuple[Any, Any]:
    """Return the game's shapes and their edges, as records; `fit_paddle` changes the paddle's."""
    return shape_table(
        [
            paddle_collider(PADDLE_WIDTH),
            paddle_collider(LONG_PADDLE_WIDTH),
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
