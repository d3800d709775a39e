"""The `vector` observation: float32 numbers in [-1, 1], in named parts.

x runs from -1 at the left wall to 1 at the right one, y from -1 at the field's lower edge to 1 at
the ceiling. Numbers of things that are not there are 0. Games without capsules and enemies have the
core parts only.
"""

from copy import copy
from functools import partial
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ...physics.kernels import inlined, kernel
from ...physics.kernels.prefetch import prefetch
from ..config import Config
from ..rules import (
    BEAM_TICKS,
    BOSS_HITS,
    CAPSULES,
    CATCH_TICKS,
    CELLS,
    DIVE_SPEED,
    ENEMY_KINDS,
    ENEMY_TICKS_MAX,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GATE_TICKS,
    GATES,
    IDLE_TICKS,
    MAX_BALLS,
    MAX_BEAMS,
    MAX_ENEMIES,
    MAX_SHARDS,
    NO_CAPSULE,
    POWERS,
    SHARD_SPEED,
    SHARD_TICKS,
    SPEED_STAGE_MAX,
)
from ..state import (
    ABSENT,
    HELD,
    RulesRecord,
    SharedRules,
    World,
    WorldRecord,
    Worlds,
    zeros_in_lines,
)
from .landing import LANDING_LENGTH, LANDING_PARTS, observe_landings
from .layout import Part, slices
from .pay import brick_pay, has_pay, life_distance, shows_pay
from .protocol import Mask, Observe
from .shown import (
    ALL_BRICKS,
    SHOWN_CAPSULES,
    SHOWN_ENEMIES,
    ShownRow,
    bricks_to_write,
    changed_cell,
    check_within,
    forget_shown,
    nothing_shown,
)

# A velocity is 1 at the speed that is named.
CORE_PARTS = (
    Part("paddle", 3, "x of its middle; half its width / half the field's; velocity (full speed)"),
    Part("ball_in_play", MAX_BALLS, "1 for each ball in play, held or flying"),
    Part("ball_held", MAX_BALLS, "1 for each ball that the paddle holds"),
    Part("ball_x", MAX_BALLS, "x"),
    Part("ball_y", MAX_BALLS, "y"),
    Part("ball_vx", MAX_BALLS, "x velocity (the highest speed stage)"),
    Part("ball_vy", MAX_BALLS, "y velocity (the highest speed stage)"),
    Part("ball_release", MAX_BALLS, "ticks until a held ball leaves by itself / 120"),
    Part("speed_stage", 1, "the speed stage / 7"),
    Part("idle_clock", 1, "ticks without damage / 3600; at 1 a life is lost"),
    Part("decision_clock", 1, "decisions / `max_decisions`; at 1 the episode is truncated"),
    Part("lives", 1, "1 / lives"),
    Part("bricks", CELLS, "row by row from the top: hits left / 8, at most 1; -1: gold; 0: empty"),
)
EXTRA_PARTS = (
    Part("power", POWERS, "1 for the present power: catch, enlarge, laser"),
    Part("exit_open", 1, "1: the gate in the right wall is open"),
    Part(
        "capsule",
        CAPSULES,
        "1 for the falling capsule: catch, enlarge, laser, slow, disrupt, break, player",
    ),
    Part("capsule_x", 1, "x"),
    Part("capsule_y", 1, "y"),
    Part("beam_wait", 1, "ticks until the laser can shoot / 15"),
    Part("beam_in_play", MAX_BEAMS, "1 for each beam in play"),
    Part("beam_x", MAX_BEAMS, "x"),
    Part("beam_y", MAX_BEAMS, "y"),
    Part("gate_open", GATES, "1 for a gate in the ceiling through which an enemy is about to come"),
    Part("enemy_wait", 1, "ticks until the next enemy comes / 600"),
    Part("enemy_in_play", MAX_ENEMIES, "1 for each enemy in play"),
    Part("enemy_x", MAX_ENEMIES, "x"),
    Part("enemy_y", MAX_ENEMIES, "y"),
    Part("enemy_vx", MAX_ENEMIES, "x velocity (a dive)"),
    Part("enemy_vy", MAX_ENEMIES, "y velocity (a dive)"),
    Part("enemy_kind", MAX_ENEMIES * ENEMY_KINDS, "enemy by enemy, 1 for its kind"),
    Part("boss", 1, "hits that the boss still takes / 16"),
    Part("shard_wait", 1, "ticks until the boss throws / 90"),
    Part("shard_in_play", MAX_SHARDS, "1 for each shard in play"),
    Part("shard_x", MAX_SHARDS, "x"),
    Part("shard_y", MAX_SHARDS, "y"),
    Part("shard_vx", MAX_SHARDS, "x velocity (full speed)"),
    Part("shard_vy", MAX_SHARDS, "y velocity (full speed)"),
)
# The last parts, only with `reward="score"`.
PAY_PARTS = (
    Part("next_life", 1, "points to the next life / 60000"),
    Part("brick_points", CELLS, "row by row from the top: what breaking it pays, points / 1000"),
)
_CORE = slices(CORE_PARTS)
CORE_LENGTH = _CORE["bricks"].stop
_EXTRAS = slices(EXTRA_PARTS, CORE_LENGTH)
FULL_LENGTH = _EXTRAS["shard_vy"].stop
PAY_LENGTH = slices(PAY_PARTS)["brick_points"].stop

_PADDLE = _CORE["paddle"].start
_IN_PLAY = _CORE["ball_in_play"].start
_HELD = _CORE["ball_held"].start
_X = _CORE["ball_x"].start
_Y = _CORE["ball_y"].start
_VX = _CORE["ball_vx"].start
_VY = _CORE["ball_vy"].start
_RELEASE = _CORE["ball_release"].start
_STAGE = _CORE["speed_stage"].start
_IDLE = _CORE["idle_clock"].start
_DECISIONS = _CORE["decision_clock"].start
_LIVES = _CORE["lives"].start
_BRICKS = _CORE["bricks"].start

_POWER = _EXTRAS["power"].start
_EXIT = _EXTRAS["exit_open"].start
_CAPSULE = _EXTRAS["capsule"].start
_CAPSULE_X = _EXTRAS["capsule_x"].start
_CAPSULE_Y = _EXTRAS["capsule_y"].start
_BEAM_WAIT = _EXTRAS["beam_wait"].start
_BEAM = _EXTRAS["beam_in_play"].start
_BEAM_X = _EXTRAS["beam_x"].start
_BEAM_Y = _EXTRAS["beam_y"].start
_GATE = _EXTRAS["gate_open"].start
_ENEMY_WAIT = _EXTRAS["enemy_wait"].start
_ENEMY = _EXTRAS["enemy_in_play"].start
_ENEMY_X = _EXTRAS["enemy_x"].start
_ENEMY_Y = _EXTRAS["enemy_y"].start
_ENEMY_VX = _EXTRAS["enemy_vx"].start
_ENEMY_VY = _EXTRAS["enemy_vy"].start
_ENEMY_KIND = _EXTRAS["enemy_kind"].start
_BOSS = _EXTRAS["boss"].start
_SHARD_WAIT = _EXTRAS["shard_wait"].start
_SHARD = _EXTRAS["shard_in_play"].start
_SHARD_X = _EXTRAS["shard_x"].start
_SHARD_Y = _EXTRAS["shard_y"].start
_SHARD_VX = _EXTRAS["shard_vx"].start
_SHARD_VY = _EXTRAS["shard_vy"].start

# How many rows ahead memory is asked for, and the parts of a row, in bytes: without the bricks,
# few of which change.
_AHEAD = 8
_HEAD, _HEAD_SIZE = 0, 4 * _BRICKS
_CAPSULES, _CAPSULES_SIZE = 4 * _POWER, 4 * (_GATE - _POWER)
_GATES, _GATES_SIZE = 4 * _GATE, 4 * (_ENEMY - _GATE)
_ENEMIES, _ENEMIES_SIZE = 4 * _ENEMY, 4 * (FULL_LENGTH - _ENEMY)


class VectorObserver:
    """`Observer` of vectors, float32 [n, k].

    Attributes:
        plain_length: of the core parts, or of core and extra parts.
        shows_landings: whether there are landings; landings_start: where they begin.
    """

    def __init__(self, config: Config, num_worlds: int) -> None:
        """Make the array; games without capsules and enemies have no numbers for them."""
        full = config.capsules or config.enemies
        length = FULL_LENGTH if full else CORE_LENGTH
        self.layout = _CORE | _EXTRAS if full else dict(_CORE)
        self.plain_length = length
        if shows_pay(config):
            self.layout |= slices(PAY_PARTS, length)
            length += PAY_LENGTH
        self.landings_start = length
        if config.landing:
            self.layout |= slices(LANDING_PARTS, length)
            length += LANDING_LENGTH
        self.shows_landings = config.landing
        # Whether Box is generic depends on Gymnasium's version.
        self.space: Any = spaces.Box(-1.0, 1.0, (length,), np.float32)
        self.observations: NDArray[np.float32] = zeros_in_lines((num_worlds, length), np.float32)
        self._shown = nothing_shown(num_worlds)

    def advance(self) -> None:
        """Do nothing: a vector shows the present only."""

    def check(self, observations: NDArray[Any]) -> None:
        """Raise a ValueError if no world could be observed like this."""
        check_within(observations, -1.0, 1.0)

    def recall(self, observations: NDArray[Any]) -> None:
        """Go on from these vectors."""
        self.observations[:] = observations
        forget_shown(self._shown)

    def clone(self) -> "VectorObserver":
        """Return one that shows the same in arrays of its own."""
        clone = copy(self)
        clone.observations = self.observations.copy()
        clone._shown = self._shown.copy()
        return clone

    def part(self, worlds: Worlds, rules: SharedRules, share: slice) -> Observe:
        """Return what observes a share of the worlds."""
        rows, shown = self.observations[share], self._shown[share]
        seen = worlds[share], rules, rows
        vectors = partial(observe_vectors, *seen, shown, self.plain_length)
        if not self.shows_landings:
            return vectors
        # No two threads may share it.
        scratch = zeros_in_lines((1,), World)
        landings = partial(observe_landings, *seen, self.landings_start, scratch)

        def observe(mask: Mask) -> None:
            vectors(mask)
            landings(mask)

        return observe


@kernel
def _across(x: float) -> float:
    """Return x on the field's scale."""
    return x * (2.0 / FIELD_WIDTH) - 1.0


@kernel
def _up(y: float) -> float:
    """Return y on the field's scale; what is a little outside is at its edge."""
    return max(-1.0, min(1.0, y * (2.0 / FIELD_HEIGHT) - 1.0))


@kernel
def observe_vectors(
    worlds: Worlds, rules: SharedRules, rows: Any, shown: Any, length: int, mask: Any
) -> None:
    """Observe the worlds of a mask.

    Args:
        rows: float32 [n, k]; shown: int64 [n, 3], what the rows show; length: of the core parts, or
            of core and extra parts; mask: bool [n].
    """
    for index in range(worlds.shape[0]):
        if index + _AHEAD < worlds.shape[0]:
            _prefetch_row(worlds[index + _AHEAD], rows, index + _AHEAD, length)
        if mask[index]:
            _observe_vector(worlds[index], rules[0], rows[index], shown[index], length)


@inlined
def _prefetch_row(world: WorldRecord, rows: Any, index: int, length: int) -> None:
    """Ask for those parts of a world's row that its observation will write."""
    prefetch(rows, index, _HEAD, _HEAD_SIZE)
    if length > CORE_LENGTH:
        prefetch(rows, index, _GATES, _GATES_SIZE)
        if _has_capsules(world):
            prefetch(rows, index, _CAPSULES, _CAPSULES_SIZE)
        if _has_enemies(world):
            prefetch(rows, index, _ENEMIES, _ENEMIES_SIZE)


@inlined
def _has_capsules(world: WorldRecord) -> bool:
    """Tell whether there is a power, a falling capsule, a beam or an open exit."""
    return bool(world.power + world.capsule + world.beams + world.exit_open > 0)


@inlined
def _has_enemies(world: WorldRecord) -> bool:
    """Tell whether there is an enemy or the boss."""
    return bool(world.enemies + world.boss_hits > 0)


@inlined
def _observe_vector(
    world: WorldRecord, rules: RulesRecord, row: Any, shown: ShownRow, length: int
) -> None:
    """Write a world's observation into its row; the bricks only if they have changed."""
    row[_PADDLE] = _across(world.paddle_x)
    row[_PADDLE + 1] = world.paddle_half * (2.0 / FIELD_WIDTH)
    row[_PADDLE + 2] = world.paddle_vx / rules.paddle_speed
    fastest = rules.ball_speed * (1.0 + 0.25 * SPEED_STAGE_MAX)
    for ball in range(MAX_BALLS):
        state = world.ball_state[ball]
        present = state != ABSENT
        row[_IN_PLAY + ball] = 1.0 if present else 0.0
        row[_HELD + ball] = 1.0 if state == HELD else 0.0
        row[_X + ball] = _across(world.ball_x[ball]) if present else 0.0
        row[_Y + ball] = _up(world.ball_y[ball]) if present else 0.0
        row[_VX + ball] = world.ball_vx[ball] / fastest
        row[_VY + ball] = world.ball_vy[ball] / fastest
        row[_RELEASE + ball] = world.ball_release[ball] * (1.0 / CATCH_TICKS)
    row[_STAGE] = world.speed_stage * (1.0 / SPEED_STAGE_MAX)
    row[_IDLE] = min(1.0, world.idle * (1.0 / IDLE_TICKS))
    row[_DECISIONS] = world.decisions / rules.max_decisions
    row[_LIVES] = 1.0 / max(1, world.lives)
    _observe_bricks(world, rules, row, length + 1, shown)
    if has_pay(rules):
        row[length] = life_distance(world)
    if length > CORE_LENGTH:
        _observe_capsules(world, row, shown)
        _observe_enemies(world, row, shown)


@inlined
def _observe_bricks(
    world: WorldRecord, rules: RulesRecord, row: Any, pay: int, shown: ShownRow
) -> None:
    """Write the bricks that have changed, and what they pay, from the place `pay` on."""
    count = bricks_to_write(world, shown)
    if count == ALL_BRICKS:
        for cell in range(CELLS):
            row[_BRICKS + cell] = rules.brick_values[world.brick_hits[cell]]
            if has_pay(rules):
                row[pay + cell] = brick_pay(world, cell)
    for change in range(count):
        cell = changed_cell(world, change)
        row[_BRICKS + cell] = rules.brick_values[world.brick_hits[cell]]
        if has_pay(rules):
            row[pay + cell] = brick_pay(world, cell)


@inlined
def _observe_capsules(world: WorldRecord, row: Any, shown: ShownRow) -> None:
    """Write powers, the falling capsule and beams, if there are any or the row shows some."""
    present = 1 if _has_capsules(world) else 0
    if present == 0 and shown[SHOWN_CAPSULES] == 0:
        return
    shown[SHOWN_CAPSULES] = present
    for power in range(POWERS):
        row[_POWER + power] = 1.0 if world.power == power + 1 else 0.0
    row[_EXIT] = world.exit_open
    for kind in range(CAPSULES):
        row[_CAPSULE + kind] = 1.0 if world.capsule == kind + 1 else 0.0
    falls = world.capsule != NO_CAPSULE
    row[_CAPSULE_X] = _across(world.capsule_x) if falls else 0.0
    row[_CAPSULE_Y] = _up(world.capsule_y) if falls else 0.0
    row[_BEAM_WAIT] = world.beam_wait * (1.0 / BEAM_TICKS) if present == 1 else 0.0
    for beam in range(MAX_BEAMS):
        flies = world.beam_state[beam] != ABSENT
        row[_BEAM + beam] = 1.0 if flies else 0.0
        row[_BEAM_X + beam] = _across(world.beam_x[beam]) if flies else 0.0
        row[_BEAM_Y + beam] = _up(world.beam_y[beam]) if flies else 0.0


@inlined
def _observe_enemies(world: WorldRecord, row: Any, shown: ShownRow) -> None:
    """Write when the next enemy comes; enemies, boss and shards, if any are there or shown."""
    waits = world.boss_hits == 0
    row[_ENEMY_WAIT] = world.enemy_wait * (1.0 / ENEMY_TICKS_MAX) if waits else 0.0
    opens = waits and 0 < world.enemy_wait < GATE_TICKS
    for gate in range(GATES):
        row[_GATE + gate] = 1.0 if opens and gate == world.enemy_gate else 0.0
    present = 1 if _has_enemies(world) else 0
    if present == 0 and shown[SHOWN_ENEMIES] == 0:
        return
    shown[SHOWN_ENEMIES] = present
    for enemy in range(MAX_ENEMIES):
        exists = world.enemy_state[enemy] != ABSENT
        row[_ENEMY + enemy] = 1.0 if exists else 0.0
        row[_ENEMY_X + enemy] = _across(world.enemy_x[enemy]) if exists else 0.0
        row[_ENEMY_Y + enemy] = _up(world.enemy_y[enemy]) if exists else 0.0
        row[_ENEMY_VX + enemy] = world.enemy_vx[enemy] * (1.0 / DIVE_SPEED)
        row[_ENEMY_VY + enemy] = world.enemy_vy[enemy] * (1.0 / DIVE_SPEED)
        for kind in range(ENEMY_KINDS):
            is_kind = exists and world.enemy_kind[enemy] == kind
            row[_ENEMY_KIND + enemy * ENEMY_KINDS + kind] = 1.0 if is_kind else 0.0
    row[_BOSS] = world.boss_hits * (1.0 / BOSS_HITS)
    row[_SHARD_WAIT] = 0.0 if waits else world.shard_wait * (1.0 / SHARD_TICKS)
    for shard in range(MAX_SHARDS):
        flies = world.shard_state[shard] != ABSENT
        row[_SHARD + shard] = 1.0 if flies else 0.0
        row[_SHARD_X + shard] = _across(world.shard_x[shard]) if flies else 0.0
        row[_SHARD_Y + shard] = _up(world.shard_y[shard]) if flies else 0.0
        row[_SHARD_VX + shard] = world.shard_vx[shard] * (1.0 / SHARD_SPEED)
        row[_SHARD_VY + shard] = world.shard_vy[shard] * (1.0 / SHARD_SPEED)
