"""The `grid` observation: planes over the field's cells, float32 [planes, 28, 11] in [-1, 1].

A cell is as large as a brick, 1 by 1/2. Row 0 lies under the ceiling, the lattice of bricks is rows
2 to 19, and the paddle is in row 24.

The place of a moving thing is not rounded to a cell: its weight of 1 is shared among the four cells
whose middles surround it; the nearer the cell, the larger its share. Its motion is its velocity,
shared in the same way, so that one observation is enough. Where things share a cell, their numbers
are added and clipped to [-1, 1]. Games without capsules and enemies have the core parts only.
"""

from copy import copy
from functools import partial
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ...physics.kernels import inlined, inner, kernel
from ..config import Config
from ..game.shapes import BOSS_SHAPE
from ..rules import (
    BEAM_TICKS,
    BOSS_HITS,
    BOSS_X,
    BOSS_Y,
    BRICK_HEIGHT,
    CAPSULES,
    CATCH_TICKS,
    CELLS,
    COLUMNS,
    DIVE_SPEED,
    ENEMY_TICKS_MAX,
    FIELD_HEIGHT,
    GATE_TICKS,
    GATE_X,
    IDLE_TICKS,
    LATTICE_TOP,
    MAX_BALLS,
    MAX_BEAMS,
    MAX_ENEMIES,
    MAX_SHARDS,
    NO_CAPSULE,
    PADDLE_TOP,
    POWERS,
    SHARD_SPEED,
    SHARD_TICKS,
    SPEED_STAGE_MAX,
    UNBREAKABLE,
)
from ..state import ABSENT, HELD, RulesRecord, SharedRules, WorldRecord, Worlds
from .layout import Part, slices
from .pay import brick_pay, has_pay, life_distance, shows_pay
from .protocol import Observe
from .shown import (
    ALL_BRICKS,
    ShownRow,
    bricks_to_write,
    changed_cell,
    check_within,
    forget_shown,
    nothing_shown,
)

GRID_ROWS = int(FIELD_HEIGHT / BRICK_HEIGHT)
PLANE = GRID_ROWS * COLUMNS  # numbers
_PADDLE_ROW = int((FIELD_HEIGHT - PADDLE_TOP) / BRICK_HEIGHT)
_LATTICE = int((FIELD_HEIGHT - LATTICE_TOP) / BRICK_HEIGHT) * COLUMNS  # its first cell in a plane

# A motion is 1 at the speed that is named.
CORE_PARTS = (
    Part("brick", 1, "1: a brick that can be broken"),
    Part("hits_left", 1, "its hits left / 8, at most 1"),
    Part("gold", 1, "1: a brick of gold"),
    Part("status", 1, "one number per row, in all cells of the row: see `STATUS`"),
    Part("paddle", 1, "the fraction of the cell's width that the paddle covers"),
    Part("paddle_motion", 1, "velocity to the right (full speed)"),
    Part("ball", 1, "balls"),
    Part("ball_motion", 2, "velocity to the right and up (the highest speed stage)"),
    Part("ball_held", 1, "ticks until a held ball leaves by itself / 120"),
)
EXTRA_PARTS = (
    Part("capsule", 1, "the falling capsule"),
    Part("beam", 1, "beams"),
    Part("exit", 1, "the gate in the right wall, if it is open"),
    Part("gate", 1, "a gate in the ceiling through which an enemy is about to come"),
    Part("enemy", 1, "enemies"),
    Part("enemy_motion", 2, "velocity to the right and up (a dive)"),
    Part(
        "boss",
        1,
        "the fraction of the cell in the boss's bounding box × the hits it still takes / 16",
    ),
    Part("shard", 1, "shards"),
    Part("shard_motion", 2, "velocity to the right and up (full speed)"),
)
# The last plane, only with `reward="score"`.
PAY_PARTS = (Part("brick_points", 1, "what breaking the brick pays, points / 1000"),)
_CORE = slices(CORE_PARTS)
CORE_PLANES = _CORE["ball_held"].stop
_EXTRAS = slices(EXTRA_PARTS, CORE_PLANES)
FULL_PLANES = _EXTRAS["shard_motion"].stop

_STATUS = (
    *("speed_stage", "idle_clock", "decision_clock", "lives"),
    # Only in games with capsules or enemies: the present power, the falling capsule, and waits.
    *("catch", "enlarge", "laser"),
    *("capsule_catch", "capsule_enlarge", "capsule_laser", "capsule_slow", "capsule_disrupt"),
    *("capsule_break", "capsule_player"),
    *("beam_wait", "enemy_wait", "shard_wait"),
    # Only with `reward="score"`.
    "next_life",
)
# The row of each number in the plane `status`. Each is scaled as in the `vector` observation.
STATUS = {name: row for row, name in enumerate(_STATUS)}

_BRICK = _CORE["brick"].start * PLANE
_HITS_LEFT = _CORE["hits_left"].start * PLANE
_GOLD = _CORE["gold"].start * PLANE
_NEXT_LIFE = STATUS["next_life"]
_STATUS_PLANE = _CORE["status"].start * PLANE
_PADDLE = _CORE["paddle"].start * PLANE
_PADDLE_MOTION = _CORE["paddle_motion"].start * PLANE
_BALL = _CORE["ball"].start * PLANE
_BALL_MOTION = _CORE["ball_motion"].start * PLANE
_BALL_HELD = _CORE["ball_held"].start * PLANE
_CAPSULE = _EXTRAS["capsule"].start * PLANE
_BEAM = _EXTRAS["beam"].start * PLANE
_EXIT = _EXTRAS["exit"].start * PLANE
_GATE = _EXTRAS["gate"].start * PLANE
_ENEMY = _EXTRAS["enemy"].start * PLANE
_ENEMY_MOTION = _EXTRAS["enemy_motion"].start * PLANE
_BOSS = _EXTRAS["boss"].start * PLANE
_SHARD = _EXTRAS["shard"].start * PLANE
_SHARD_MOTION = _EXTRAS["shard_motion"].start * PLANE

# The planes of what moves begin here. Nearly all of their cells are empty: those that are not are
# remembered, and erased before the next observation. There are never more than these: a paddle in
# two planes; balls, enemies and shards in three or four, capsule, beams and gates in one plane, in
# four cells each; and 30 cells of the boss.
_MOVING = _PADDLE
MAX_MARKS = 256
# Instead of a number of marks: any cell may be filled, and all are erased.
ANY_CELL = -1


class GridObserver:
    """`Observer` of grids, float32 [n, planes, 28, 11]."""

    def __init__(self, config: Config, num_worlds: int) -> None:
        """Make the arrays; games without capsules and enemies have no planes for them."""
        full = config.capsules or config.enemies
        planes = FULL_PLANES if full else CORE_PLANES
        self.layout = _CORE | _EXTRAS if full else dict(_CORE)
        if shows_pay(config):
            self.layout |= slices(PAY_PARTS, planes)
            planes += len(PAY_PARTS)
        shape = (planes, GRID_ROWS, COLUMNS)
        # Whether Box is generic depends on Gymnasium's version.
        self.space: Any = spaces.Box(-1.0, 1.0, shape, np.float32)
        self.observations: NDArray[np.float32] = np.zeros((num_worlds, *shape), np.float32)
        self._rows = self.observations.reshape(num_worlds, -1)
        self._marks = np.zeros((num_worlds, 1 + MAX_MARKS), np.int32)
        self._shown = nothing_shown(num_worlds)

    def advance(self) -> None:
        """Do nothing: a grid shows the present only."""

    def check(self, observations: NDArray[Any]) -> None:
        """Raise a ValueError if no world could be observed like this."""
        check_within(observations, -1.0, 1.0)
        moving = observations.reshape(len(observations), -1)[:, _MOVING:]
        if (np.count_nonzero(moving, axis=1) > MAX_MARKS).any():
            raise ValueError("the observations show more moving things than a game has")

    def recall(self, observations: NDArray[Any]) -> None:
        """Go on from these grids."""
        self.observations[:] = observations
        self._marks[:, 0] = ANY_CELL
        forget_shown(self._shown)

    def clone(self) -> "GridObserver":
        """Return one that shows the same in arrays of its own."""
        clone = copy(self)
        clone.observations = self.observations.copy()
        clone._rows = clone.observations.reshape(self._rows.shape)
        clone._marks = self._marks.copy()
        clone._shown = self._shown.copy()
        return clone

    def part(self, worlds: Worlds, rules: SharedRules, share: slice) -> Observe:
        """Return what observes a share of the worlds."""
        rows, marks, shown = self._rows[share], self._marks[share], self._shown[share]
        return partial(observe_grids, worlds[share], rules, rows, marks, shown)


@kernel
def observe_grids(
    worlds: Worlds, rules: SharedRules, rows: Any, marks: Any, shown: Any, mask: Any
) -> None:
    """Observe the worlds of a mask.

    Args:
        rows: float32 [n, planes * PLANE].
        marks: int32 [n, 1 + MAX_MARKS], the number of places to be erased, and these; or
            `ANY_CELL`.
        shown: int64 [n, 3], what the rows show.
        mask: bool [n].
    """
    for index in range(worlds.shape[0]):
        if mask[index]:
            _observe_grid(worlds[index], rules[0], rows[index], marks[index], shown[index])


@inlined
def _observe_grid(
    world: WorldRecord, rules: RulesRecord, row: Any, marks: Any, shown: ShownRow
) -> None:
    """Write a world's observation into its row; the bricks only if they have changed."""
    if marks[0] == ANY_CELL:
        for place in range(_MOVING, row.shape[0]):
            row[place] = 0.0
    for index in range(marks[0]):
        row[marks[1 + index]] = 0.0
    marks[0] = 0
    pay = row.shape[0] - PLANE  # where the last plane begins
    count = bricks_to_write(world, shown)
    if count == ALL_BRICKS:
        for cell in range(CELLS):
            _write_brick(world, rules, row, pay, cell)
    for change in range(count):
        _write_brick(world, rules, row, pay, changed_cell(world, change))
    full = (pay if has_pay(rules) else row.shape[0]) > CORE_PLANES * PLANE
    _write_status(world, rules, row, full)
    if has_pay(rules):
        _write_number(row, _NEXT_LIFE, life_distance(world))
    _mark_paddle(world, rules, row, marks)
    _mark_balls(world, rules, row, marks)
    if full:
        _mark_capsules(world, row, marks)
        _mark_enemies(world, row, marks)
        if world.boss_hits > 0:
            _mark_boss(world, rules, row, marks)


@inner
def _write_brick(world: WorldRecord, rules: RulesRecord, row: Any, pay: int, cell: int) -> None:
    """Write what the planes of the bricks show in a cell; that of what they pay begins at `pay`."""
    hits = world.brick_hits[cell]
    place = _LATTICE + cell
    breaks = hits > 0 and hits != UNBREAKABLE
    row[_BRICK + place] = 1.0 if breaks else 0.0
    row[_HITS_LEFT + place] = rules.brick_values[hits] if breaks else 0.0
    row[_GOLD + place] = 1.0 if hits == UNBREAKABLE else 0.0
    if has_pay(rules):
        row[pay + place] = brick_pay(world, cell)


@inlined
def _write_status(world: WorldRecord, rules: RulesRecord, row: Any, full: bool) -> None:
    """Write the numbers that have no place in the field."""
    _write_number(row, 0, world.speed_stage * (1.0 / SPEED_STAGE_MAX))
    _write_number(row, 1, min(1.0, world.idle * (1.0 / IDLE_TICKS)))
    _write_number(row, 2, world.decisions / rules.max_decisions)
    _write_number(row, 3, 1.0 / max(1, world.lives))
    if not full:
        return
    place = 4
    for power in range(POWERS):
        _write_number(row, place + power, 1.0 if world.power == power + 1 else 0.0)
    place += POWERS
    for kind in range(CAPSULES):
        _write_number(row, place + kind, 1.0 if world.capsule == kind + 1 else 0.0)
    place += CAPSULES
    boss = world.boss_hits > 0
    _write_number(row, place, world.beam_wait * (1.0 / BEAM_TICKS))
    _write_number(row, place + 1, 0.0 if boss else world.enemy_wait * (1.0 / ENEMY_TICKS_MAX))
    _write_number(row, place + 2, world.shard_wait * (1.0 / SHARD_TICKS) if boss else 0.0)


@kernel
def _write_number(row: Any, number: int, value: float) -> None:
    """Write a number into all its row of the plane for them, if it has changed."""
    first = _STATUS_PLANE + number * COLUMNS
    if row[first] != np.float32(value):
        for place in range(first, first + COLUMNS):
            row[place] = value


@inlined
def _mark_paddle(world: WorldRecord, rules: RulesRecord, row: Any, marks: Any) -> None:
    """Mark the paddle and its motion, by the part of each cell's width that it covers."""
    left, right = world.paddle_x - world.paddle_half, world.paddle_x + world.paddle_half
    speed = world.paddle_vx / rules.paddle_speed
    for column in range(max(0, int(left)), min(COLUMNS, int(right) + 1)):
        part = min(right, column + 1.0) - max(left, float(column))
        place = _PADDLE_ROW * COLUMNS + column
        _put(row, marks, _PADDLE + place, part)
        _put(row, marks, _PADDLE_MOTION + place, part * speed)


@inlined
def _mark_balls(world: WorldRecord, rules: RulesRecord, row: Any, marks: Any) -> None:
    """Mark the balls, their motion, and how long they are held."""
    fastest = rules.ball_speed * (1.0 + 0.25 * SPEED_STAGE_MAX)
    for ball in range(MAX_BALLS):
        state = world.ball_state[ball]
        if state == ABSENT:
            continue
        x, y = world.ball_x[ball], world.ball_y[ball]
        _share(row, marks, _BALL, x, y, 1.0)
        if state == HELD:
            _share(row, marks, _BALL_HELD, x, y, world.ball_release[ball] * (1.0 / CATCH_TICKS))
        _share(row, marks, _BALL_MOTION, x, y, world.ball_vx[ball] / fastest)
        _share(row, marks, _BALL_MOTION + PLANE, x, y, world.ball_vy[ball] / fastest)


@inlined
def _mark_capsules(world: WorldRecord, row: Any, marks: Any) -> None:
    """Mark the falling capsule, the beams, and the open gate in the right wall."""
    if world.capsule != NO_CAPSULE:
        _share(row, marks, _CAPSULE, world.capsule_x, world.capsule_y, 1.0)
    if world.beams > 0:
        for beam in range(MAX_BEAMS):
            if world.beam_state[beam] != ABSENT:
                _share(row, marks, _BEAM, world.beam_x[beam], world.beam_y[beam], 1.0)
    if world.exit_open == 1:
        _put(row, marks, _EXIT + (_PADDLE_ROW + 1) * COLUMNS - 1, 1.0)


@inlined
def _mark_enemies(world: WorldRecord, row: Any, marks: Any) -> None:
    """Mark enemies and shards, their motions, and the gate that opens."""
    if world.boss_hits == 0 and 0 < world.enemy_wait < GATE_TICKS:
        _share(row, marks, _GATE, GATE_X[world.enemy_gate], FIELD_HEIGHT, 1.0)
    if world.enemies > 0:
        for enemy in range(MAX_ENEMIES):
            if world.enemy_state[enemy] != ABSENT:
                x, y = world.enemy_x[enemy], world.enemy_y[enemy]
                vx, vy = world.enemy_vx[enemy], world.enemy_vy[enemy]
                _share(row, marks, _ENEMY, x, y, 1.0)
                _share(row, marks, _ENEMY_MOTION, x, y, vx * (1.0 / DIVE_SPEED))
                _share(row, marks, _ENEMY_MOTION + PLANE, x, y, vy * (1.0 / DIVE_SPEED))
    if world.shards > 0:
        for shard in range(MAX_SHARDS):
            if world.shard_state[shard] != ABSENT:
                x, y = world.shard_x[shard], world.shard_y[shard]
                vx, vy = world.shard_vx[shard], world.shard_vy[shard]
                _share(row, marks, _SHARD, x, y, 1.0)
                _share(row, marks, _SHARD_MOTION, x, y, vx * (1.0 / SHARD_SPEED))
                _share(row, marks, _SHARD_MOTION + PLANE, x, y, vy * (1.0 / SHARD_SPEED))


@inlined
def _mark_boss(world: WorldRecord, rules: RulesRecord, row: Any, marks: Any) -> None:
    """Mark the boss by the part of each cell that it covers, and by the hits that it takes."""
    shape = rules.shapes[BOSS_SHAPE]
    left, right = BOSS_X + shape.lower_x, BOSS_X + shape.upper_x
    # In rows from the ceiling down.
    top = (FIELD_HEIGHT - BOSS_Y - shape.upper_y) * (1.0 / BRICK_HEIGHT)
    bottom = (FIELD_HEIGHT - BOSS_Y - shape.lower_y) * (1.0 / BRICK_HEIGHT)
    value = world.boss_hits * (1.0 / BOSS_HITS)
    for line in range(int(top), int(bottom) + 1):
        height = min(bottom, line + 1.0) - max(top, float(line))
        for column in range(int(left), int(right) + 1):
            width = min(right, column + 1.0) - max(left, float(column))
            _put(row, marks, _BOSS + line * COLUMNS + column, value * height * width)


@kernel
def _share(row: Any, marks: Any, plane: int, x: float, y: float, value: float) -> None:
    """Share a value among the four cells of a plane whose middles lie around a point."""
    if value == 0.0:
        return
    # In cells, from the middle of the upper left one; what is outside is on the edge.
    across = min(max(x - 0.5, 0.0), COLUMNS - 1.0)
    down = min(max((FIELD_HEIGHT - y) * (1.0 / BRICK_HEIGHT) - 0.5, 0.0), GRID_ROWS - 1.0)
    column = min(int(across), COLUMNS - 2)
    line = min(int(down), GRID_ROWS - 2)
    right, lower = across - column, down - line
    place = plane + line * COLUMNS + column
    _put(row, marks, place, value * (1.0 - right) * (1.0 - lower))
    _put(row, marks, place + 1, value * right * (1.0 - lower))
    _put(row, marks, place + COLUMNS, value * (1.0 - right) * lower)
    _put(row, marks, place + COLUMNS + 1, value * right * lower)


@kernel
def _put(row: Any, marks: Any, place: int, value: float) -> None:
    """Add a value to what is at a place, within -1 and 1, and remember that it must be erased."""
    row[place] = min(1.0, max(-1.0, row[place] + value))
    marks[1 + marks[0]] = place
    marks[0] += 1
