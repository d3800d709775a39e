"""The `vector` observation: float32 numbers in [-1, 1], found by named slices."""

from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ..physics.compilation import kernel
from .rules import (
    CELLS,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    IDLE_TICKS,
    MAX_BALLS,
    SERVE_TICKS,
    SPEED_STAGE_MAX,
)
from .state import ABSENT, HELD


def _layout() -> dict[str, slice]:
    sizes = {
        "paddle": 3,  # x of the middle (-1 left wall, 1 right wall), half its width, its velocity
        "ball_in_play": MAX_BALLS,  # 1: lies on the paddle or flies; 0: the ball's numbers are 0
        "ball_held": MAX_BALLS,  # 1: lies on the paddle
        "ball_x": MAX_BALLS,  # on the paddle's scale
        "ball_y": MAX_BALLS,  # -1 at the lower edge of the field, 1 at the ceiling
        "ball_vx": MAX_BALLS,  # 1: the fastest stage's speed
        "ball_vy": MAX_BALLS,
        "speed_stage": 1,
        "serve_timer": 1,  # 0 to 1, when the ball serves itself
        "idle_clock": 1,  # 0 to 1, when the episode is truncated for lack of damage
        "decision_clock": 1,  # 0 to 1, when the episode is truncated for its length
        "lives": 1,  # 1 / lives
        "bricks": CELLS,  # row by row from the top: 0 none, -1 gold, else hits left / 8, at most 1
    }
    layout = {}
    start = 0
    for name, size in sizes.items():
        layout[name] = slice(start, start + size)
        start += size
    return layout


LAYOUT = _layout()
LENGTH = LAYOUT["bricks"].stop

_PADDLE = LAYOUT["paddle"].start
_IN_PLAY = LAYOUT["ball_in_play"].start
_HELD = LAYOUT["ball_held"].start
_X = LAYOUT["ball_x"].start
_Y = LAYOUT["ball_y"].start
_VX = LAYOUT["ball_vx"].start
_VY = LAYOUT["ball_vy"].start
_STAGE = LAYOUT["speed_stage"].start
_SERVE = LAYOUT["serve_timer"].start
_IDLE = LAYOUT["idle_clock"].start
_DECISIONS = LAYOUT["decision_clock"].start
_LIVES = LAYOUT["lives"].start
_BRICKS = LAYOUT["bricks"].start


def vector_space() -> spaces.Space[NDArray[np.float32]]:
    """Return the space of one observation, a Box of float32 [`LENGTH`]."""
    # Whether Box is generic depends on Gymnasium's version.
    space: Any = spaces.Box(-1.0, 1.0, (LENGTH,), np.float32)
    return space  # type: ignore[no-any-return]


@kernel
def observe(world: Any, rules: Any, row: Any) -> None:
    """Write a world's observation into a float32 row; the bricks only if they have changed."""
    row[_PADDLE] = world.paddle_x * (2.0 / FIELD_WIDTH) - 1.0
    row[_PADDLE + 1] = rules.paddle_half * (2.0 / FIELD_WIDTH)
    row[_PADDLE + 2] = world.paddle_vx / rules.paddle_speed
    fastest = rules.ball_speed * (1.0 + 0.25 * SPEED_STAGE_MAX)
    held = False
    for ball in range(MAX_BALLS):
        state = world.ball_state[ball]
        present = state != ABSENT
        held = held or state == HELD
        row[_IN_PLAY + ball] = 1.0 if present else 0.0
        row[_HELD + ball] = 1.0 if state == HELD else 0.0
        row[_X + ball] = world.ball_x[ball] * (2.0 / FIELD_WIDTH) - 1.0 if present else 0.0
        height = world.ball_y[ball] * (2.0 / FIELD_HEIGHT) - 1.0
        row[_Y + ball] = max(-1.0, height) if present else 0.0
        row[_VX + ball] = world.ball_vx[ball] / fastest if present else 0.0
        row[_VY + ball] = world.ball_vy[ball] / fastest if present else 0.0
    row[_STAGE] = world.speed_stage / SPEED_STAGE_MAX
    row[_SERVE] = world.held_ticks / SERVE_TICKS if held else 0.0
    row[_IDLE] = min(1.0, world.idle / IDLE_TICKS)
    row[_DECISIONS] = world.decisions / rules.max_decisions
    row[_LIVES] = 1.0 / max(1, world.lives)
    if world.lattice_changed:
        world.lattice_changed = 0
        for cell in range(CELLS):
            row[_BRICKS + cell] = rules.brick_values[world.brick_hits[cell]]
