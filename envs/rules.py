"""The rules' numbers, each with its unit, and the record that carries them to the kernels.

Lengths are in brick widths, times in ticks of 1/60 s, y points up, and the origin is the field's
lower left corner. What a user may tune travels in a `Rules` record, for Numba freezes globals.
"""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..physics.colliders import Convex, Particle
from ..physics.lattice import Lattice
from ..physics.records import Edge, Shape
from ..physics.shape_table import shape_table

if TYPE_CHECKING:
    from .config import Config

TICKS_PER_SECOND = 60

FIELD_WIDTH = 11.0
FIELD_HEIGHT = 14.0

COLUMNS = 11
ROWS = 18
CELLS = COLUMNS * ROWS
BRICK_WIDTH = 1.0
BRICK_HEIGHT = 0.5
LATTICE_TOP = FIELD_HEIGHT - 1.0
LATTICE_BOTTOM = LATTICE_TOP - ROWS * BRICK_HEIGHT

BALL_RADIUS = 0.125
BALL_SPEED = 0.176  # per tick, at speed stage 0
SPEED_STAGE_MIN = -1
SPEED_STAGE_MAX = 7
# Brick hits since the serve after which the speed stage rises by one.
SPEED_STAGE_HITS = (30, 55, 80, 105, 130, 150, 165)
MAX_BALLS = 3

PADDLE_WIDTH = 2.0
PADDLE_THICKNESS = 0.25
PADDLE_TOP = 2.0
PADDLE_Y = PADDLE_TOP - PADDLE_THICKNESS / 2
PADDLE_SPEED = 0.19  # per tick

SERVE_TICKS = 60  # then the ball serves itself
SERVE_ANGLE_MIN = 20.0  # degrees from the vertical
SERVE_ANGLE_MAX = 40.0
DEFLECTION_MIN = 10.0  # degrees from the vertical, at the paddle's middle
DEFLECTION_RANGE = 53.0  # degrees more at the paddle's ends
FLAT_ANGLE = 10.0  # degrees: no flight is flatter than this after a bounce

# A ball that bounces this often without damage or paddle contact is turned by a random angle.
LOOP_BOUNCES = 64
LOOP_TURN_MIN = 10.0  # degrees
LOOP_TURN_MAX = 20.0

IDLE_TICKS = 3600  # without damage to a brick: the episode is truncated
# More hits of one ball in one tick than the rules' fastest ball can make in a cluttered field.
HITS_PER_TICK = 64

EXTRA_LIFE_FIRST = 20_000  # points
EXTRA_LIFE_EVERY = 60_000

# Kinds of bricks, in the order of their letters in a level file.
EMPTY = 0
COLOURS = 8  # kinds 1..8
SILVER = 9
GOLD = 10
BRICK_LETTERS = ".wocgrbmySX"
COLOUR_POINTS = (50, 60, 70, 80, 90, 100, 110, 120)
SILVER_POINTS = 50  # times the round's number
UNBREAKABLE = 255  # the hits left of a golden brick, for ever

# Deflection by the paddle.
ANGLE = 0
ZONES6 = 1
PHYSICAL = 2
DEFLECTIONS = {"angle": ANGLE, "zones6": ZONES6, "physical": PHYSICAL}
ZONE_ANGLES = (63.0, 40.0, 15.0, -15.0, -40.0, -63.0)

# What a decision pays.
PROGRESS = 0
SCORE = 1
SPARSE = 2
REWARDS = {"progress": PROGRESS, "score": SCORE, "sparse": SPARSE}

# The shapes of the game, by their index in the shape table.
PADDLE_SHAPE = 0
BALL_SHAPE = 1


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


def _tables(paddle_width: float) -> tuple[Any, Any]:
    return shape_table([paddle_collider(paddle_width), Particle(BALL_RADIUS)])


_SHAPES, _EDGES = _tables(PADDLE_WIDTH)

Rules = np.dtype(
    (
        np.record,
        [
            ("shapes", Shape, _SHAPES.shape),
            ("edges", Edge, _EDGES.shape),
            ("lattice", Lattice, (1,)),  # of the bricks
            # Directions by whole degrees from the vertical, for no sine is taken while stepping.
            ("sine", np.float64, (92,)),
            ("cosine", np.float64, (92,)),
            ("brick_values", np.float32, (256,)),  # that observations show for each hits left
            ("ball_speed", np.float64),  # at speed stage 0, per tick
            ("paddle_speed", np.float64),  # per tick
            ("paddle_half", np.float64),
            ("frame_skip", np.int64),
            ("sticky_action", np.float64),
            ("deflection", np.int64),
            ("reward", np.int64),
            ("life_penalty", np.float64),
            ("lives", np.int64),
            ("max_decisions", np.int64),
        ],
    )
)


def brick_values() -> NDArray[np.float32]:
    """Return the number that observations show for each number of hits left, float32 [256]."""
    values = np.minimum(np.arange(256) / 8.0, 1.0).astype(np.float32)
    values[UNBREAKABLE] = -1.0
    return values


def make_rules(config: "Config") -> Any:
    """Return the one-element array of `Rules` that a validated configuration stands for."""
    rules = np.zeros(1, Rules)
    record = rules[0]
    width = PADDLE_WIDTH * config.paddle
    shapes, edges = _tables(width)
    record.shapes[:] = shapes
    record.edges[:] = edges
    for degree in range(92):
        record.sine[degree] = math.sin(math.radians(degree))
        record.cosine[degree] = math.cos(math.radians(degree))
    record.lattice[0] = (0.0, LATTICE_TOP, BRICK_WIDTH, BRICK_HEIGHT, COLUMNS, ROWS)
    record.brick_values[:] = brick_values()
    record.ball_speed = BALL_SPEED * config.speed
    record.paddle_speed = PADDLE_SPEED
    record.paddle_half = width / 2
    record.frame_skip = config.frame_skip
    record.sticky_action = config.sticky_action
    record.deflection = DEFLECTIONS[config.deflection]
    record.reward = REWARDS[config.reward]
    record.life_penalty = config.life_penalty
    record.lives = config.lives
    record.max_decisions = config.max_decisions
    return rules
