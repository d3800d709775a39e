"""The `vector` observation: float32 numbers in [-1, 1], found by named slices.

Places are on the field's scale: x from -1 at the left wall to 1 at the right one, y from -1 at the
lower edge to 1 at the ceiling. What is not there has zeros. Games without capsules and enemies have
no numbers for them.
"""

from copy import copy
from functools import partial
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ...physics.kernels import inlined, kernel
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
from ..state import ABSENT, HELD
from .layout import slices
from .protocol import Observe

_CORE = slices(
    {
        "paddle": 3,  # x of the middle, half the width (of half the field's), velocity
        "ball_in_play": MAX_BALLS,  # 1: lies on the paddle or flies
        "ball_held": MAX_BALLS,  # 1: lies on the paddle
        "ball_x": MAX_BALLS,
        "ball_y": MAX_BALLS,
        "ball_vx": MAX_BALLS,  # 1: the fastest stage's speed
        "ball_vy": MAX_BALLS,
        "ball_release": MAX_BALLS,  # of a held ball: 0, when it leaves by itself, to 1
        "speed_stage": 1,
        "idle_clock": 1,  # 0 to 1, when the episode is truncated for lack of damage
        "decision_clock": 1,  # 0 to 1, when the episode is truncated for its length
        "lives": 1,  # 1 / lives
        "bricks": CELLS,  # row by row from the top: 0 none, -1 gold, else hits left / 8, at most 1
    },
    0,
)
CORE_LENGTH = _CORE["bricks"].stop
_EXTRAS = slices(
    {
        "power": POWERS,  # 1 for catch, enlarge, laser
        "exit_open": 1,  # 1: the gate in the right wall
        "capsule": CAPSULES,  # 1 for the one that falls, of catch, enlarge, laser, slow, disrupt,
        # break, player
        "capsule_x": 1,
        "capsule_y": 1,
        "beam_wait": 1,  # 0, when the laser can shoot again, to 1
        "beam_in_play": MAX_BEAMS,
        "beam_x": MAX_BEAMS,
        "beam_y": MAX_BEAMS,
        "gate_open": GATES,  # in the ceiling: an enemy is about to come in
        "enemy_wait": 1,  # 0, when the next one comes in, to 1
        "enemy_in_play": MAX_ENEMIES,
        "enemy_x": MAX_ENEMIES,
        "enemy_y": MAX_ENEMIES,
        "enemy_vx": MAX_ENEMIES,  # 1: the speed of a dive
        "enemy_vy": MAX_ENEMIES,
        "enemy_kind": MAX_ENEMIES * ENEMY_KINDS,  # enemy by enemy, 1 for its kind
        "boss": 1,  # hits that it still takes / 16
        "shard_wait": 1,  # 0, when the boss throws, to 1
        "shard_in_play": MAX_SHARDS,
        "shard_x": MAX_SHARDS,
        "shard_y": MAX_SHARDS,
        "shard_vx": MAX_SHARDS,  # 1: its speed
        "shard_vy": MAX_SHARDS,
    },
    CORE_LENGTH,
)
FULL_LENGTH = _EXTRAS["shard_vy"].stop

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


class VectorObserver:
    """`Observer` of vectors, float32 [n, k]."""

    def __init__(self, config: Config, num_worlds: int) -> None:
        """Make the array; games without capsules and enemies have no numbers for them."""
        full = config.capsules or config.enemies
        length = FULL_LENGTH if full else CORE_LENGTH
        self.layout = _CORE | _EXTRAS if full else dict(_CORE)
        # Whether Box is generic depends on Gymnasium's version.
        self.space: Any = spaces.Box(-1.0, 1.0, (length,), np.float32)
        self.observations: NDArray[np.float32] = np.zeros((num_worlds, length), np.float32)

    def advance(self) -> None:
        """Do nothing: a vector shows the present only."""

    def recall(self, observations: NDArray[Any]) -> None:
        """Go on from these vectors; the worlds know what of them is up to date."""
        self.observations[:] = observations

    def clone(self) -> "VectorObserver":
        """Return one that shows the same in an array of its own."""
        clone = copy(self)
        clone.observations = self.observations.copy()
        return clone

    def part(self, worlds: Any, rules: Any, share: slice) -> Observe:
        """Return what observes a share of the worlds."""
        return partial(observe_worlds, worlds[share], rules, self.observations[share])


@kernel
def _across(x: float) -> float:
    """Return x on the field's scale."""
    return x * (2.0 / FIELD_WIDTH) - 1.0


@kernel
def _up(y: float) -> float:
    """Return y on the field's scale; what is a little outside is at its edge."""
    return max(-1.0, min(1.0, y * (2.0 / FIELD_HEIGHT) - 1.0))


@kernel
def observe_worlds(worlds: Any, rules: Any, rows: Any, mask: Any) -> None:
    """Observe the worlds of a mask; rows: float32 [n, k]."""
    for index in range(worlds.shape[0]):
        if mask[index]:
            observe(worlds[index], rules[0], rows[index])


@kernel
def observe(world: Any, rules: Any, row: Any) -> None:
    """Write a world's observation into a float32 row; the bricks only if they have changed."""
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
    if world.lattice_changed == 1:
        world.lattice_changed = 0
        for cell in range(CELLS):
            row[_BRICKS + cell] = rules.brick_values[world.brick_hits[cell]]
    if row.shape[0] > CORE_LENGTH:
        _observe_capsules(world, row)
        _observe_enemies(world, row)


@inlined
def _observe_capsules(world: Any, row: Any) -> None:
    """Write powers, the falling capsule and beams, if there are any or were."""
    shown = 1 if world.power + world.capsule + world.beams + world.exit_open > 0 else 0
    if shown == 0 and world.capsules_shown == 0:
        return
    world.capsules_shown = shown
    for power in range(POWERS):
        row[_POWER + power] = 1.0 if world.power == power + 1 else 0.0
    row[_EXIT] = world.exit_open
    for kind in range(CAPSULES):
        row[_CAPSULE + kind] = 1.0 if world.capsule == kind + 1 else 0.0
    falls = world.capsule != NO_CAPSULE
    row[_CAPSULE_X] = _across(world.capsule_x) if falls else 0.0
    row[_CAPSULE_Y] = _up(world.capsule_y) if falls else 0.0
    row[_BEAM_WAIT] = world.beam_wait * (1.0 / BEAM_TICKS) if shown == 1 else 0.0
    for beam in range(MAX_BEAMS):
        flies = world.beam_state[beam] != ABSENT
        row[_BEAM + beam] = 1.0 if flies else 0.0
        row[_BEAM_X + beam] = _across(world.beam_x[beam]) if flies else 0.0
        row[_BEAM_Y + beam] = _up(world.beam_y[beam]) if flies else 0.0


@inlined
def _observe_enemies(world: Any, row: Any) -> None:
    """Write the time of the next enemy; enemies, and the boss with its shards if there are any."""
    waits = world.boss_hits == 0
    row[_ENEMY_WAIT] = world.enemy_wait * (1.0 / ENEMY_TICKS_MAX) if waits else 0.0
    opens = waits and 0 < world.enemy_wait < GATE_TICKS
    for gate in range(GATES):
        row[_GATE + gate] = 1.0 if opens and gate == world.enemy_gate else 0.0
    shown = 1 if world.enemies + world.boss_hits > 0 else 0
    if shown == 0 and world.enemies_shown == 0:
        return
    world.enemies_shown = shown
    for enemy in range(MAX_ENEMIES):
        present = world.enemy_state[enemy] != ABSENT
        row[_ENEMY + enemy] = 1.0 if present else 0.0
        row[_ENEMY_X + enemy] = _across(world.enemy_x[enemy]) if present else 0.0
        row[_ENEMY_Y + enemy] = _up(world.enemy_y[enemy]) if present else 0.0
        row[_ENEMY_VX + enemy] = world.enemy_vx[enemy] * (1.0 / DIVE_SPEED)
        row[_ENEMY_VY + enemy] = world.enemy_vy[enemy] * (1.0 / DIVE_SPEED)
        for kind in range(ENEMY_KINDS):
            is_kind = present and world.enemy_kind[enemy] == kind
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
