"""The record from which kernels read the shapes, and the rules as the user has tuned them."""

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels.layouts import record_dtype
from ...physics.pairs.lattice import Lattice
from ...physics.shapes.records import Edge, Shape
from ..rules import (
    BALL_SPEED,
    BRICK_HEIGHT,
    BRICK_WIDTH,
    CIRCLE_RADIUS,
    CIRCLE_SPEED,
    COLUMNS,
    DEFLECTIONS,
    LATTICE_TOP,
    PADDLE_SPEED,
    REWARDS,
    ROWS,
    UNBREAKABLE,
)
from ..state import SharedRules
from .shapes import fit_paddle, game_shapes

if TYPE_CHECKING:
    from ..config import Config
    from ..levels.plan import LevelPlan

_SHAPES, _EDGES = game_shapes()

Rules = record_dtype(
    [
        ("shapes", Shape, _SHAPES.shape),
        ("edges", Edge, _EDGES.shape),
        ("lattice", Lattice, (1,)),  # of the bricks
        # Directions by whole degrees from the vertical: kernels compute no sines.
        ("sine", np.float64, (92,)),
        ("cosine", np.float64, (92,)),
        ("circle_sine", np.float64),  # of the angle by which a circling enemy turns in a tick
        ("circle_cosine", np.float64),
        ("brick_values", np.float32, (256,)),  # that observations show for each hits left
        ("ball_speed", np.float64),  # at speed stage 0, per tick
        ("paddle_speed", np.float64),  # per tick
        ("paddle_half", np.float64),
        ("long_paddle_half", np.float64),
        ("frame_skip", np.int64),
        ("sticky_action", np.float64),
        ("auto_fire", np.int64),  # 1: there is no fire button, the laser shoots by itself
        ("deflection", np.int64),
        ("reward", np.int64),
        ("life_penalty", np.float64),
        ("lives", np.int64),
        ("max_decisions", np.int64),
        ("capsule_rate", np.float64),  # 0: there are none
        ("enemies", np.int64),  # 0: neither enemies nor boss
        ("first_seed", np.int64),  # of the generated rounds
        ("num_seeds", np.float64),
        ("table_counts", np.int64),  # 1: the levels of the table are played
        ("endless", np.int64),  # 1: after the table's levels come generated ones; 0: again
        ("difficulty", np.float64),  # of generated rounds; negative: it rises
        ("first_difficulty", np.float64),  # from here
    ]
)


def brick_values() -> NDArray[np.float32]:
    """Return the number that observations show for each number of hits left, float32 [256]."""
    values = np.minimum(np.arange(256) / 8.0, 1.0).astype(np.float32)
    values[UNBREAKABLE] = -1.0
    return values


def make_rules(config: "Config", plan: "LevelPlan") -> SharedRules:
    """Return the rules of a validated configuration, `Rules` [1]."""
    rules = np.zeros(1, Rules)
    record = rules[0]
    record.shapes[:] = _SHAPES
    record.edges[:] = _EDGES
    fit_paddle(record, config.paddle)
    record.lattice[0] = (0.0, LATTICE_TOP, BRICK_WIDTH, BRICK_HEIGHT, COLUMNS, ROWS)
    for degree in range(92):
        record.sine[degree] = math.sin(math.radians(degree))
        record.cosine[degree] = math.cos(math.radians(degree))
    record.circle_sine = math.sin(CIRCLE_SPEED / CIRCLE_RADIUS)
    record.circle_cosine = math.cos(CIRCLE_SPEED / CIRCLE_RADIUS)
    record.brick_values[:] = brick_values()
    record.ball_speed = BALL_SPEED * config.speed
    record.paddle_speed = PADDLE_SPEED
    record.frame_skip = config.frame_skip
    record.sticky_action = config.sticky_action
    record.auto_fire = config.actions == "discrete3"
    record.deflection = DEFLECTIONS[config.deflection]
    record.reward = REWARDS[config.reward]
    record.life_penalty = config.life_penalty
    record.lives = config.lives
    record.max_decisions = config.max_decisions
    record.capsule_rate = config.capsule_rate if config.capsules else 0.0
    record.enemies = config.enemies
    record.first_seed = plan.seeds.start
    record.num_seeds = plan.seeds.stop - plan.seeds.start
    record.table_counts = len(plan.names) > 0
    record.endless = plan.endless
    record.difficulty = -1.0 if config.difficulty is None else config.difficulty
    record.first_difficulty = plan.first_difficulty
    return rules
