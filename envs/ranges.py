"""The legal numbers of each field of the game's records, for states that come from outside.

Kernels check no index and no loop against a state: the game itself never leaves these ranges. What
a snapshot brings might. Each range is closed under play: from a state within them, no play leads
out of them. What fields have to do with each other is in
`batch.relations`.
"""

from .rules import (
    BEAM_TICKS,
    BOSS_HITS,
    BOSS_Y,
    CAPSULE_HEIGHT,
    CAPSULES,
    CATCH_TICKS,
    CELLS,
    CIRCLE_TICKS,
    DIVE_SPEED,
    ENEMY_KINDS,
    ENEMY_TICKS_MAX,
    EXTRA_LIFE_EVERY,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GATES,
    GOLD,
    IDLE_TICKS,
    LOOP_BOUNCES,
    MAX_BEAMS,
    MAX_ENEMIES,
    MAX_SHARDS,
    POWERS,
    SHARD_SPEED,
    SHARD_TICKS,
    SPEED_STAGE_MAX,
    SPEED_STAGE_MIN,
    UNBREAKABLE,
)
from .state import (
    DECISION_LIMIT,
    DIVING,
    FLYING,
    HIGHEST,
    LAST_CHANGE,
    LIFE_LOST,
    MOST,
    MOST_ROUNDS,
    MOST_TICKS,
    REPEATED_SEED,
)

Range = tuple[float, float]  # the least and the largest legal number

# Velocities and places come from sums and roots, which are rounded.
ROUNDING = 1e-9

_MOST_EVENTS = 1 << 30  # in one decision
_MOST_HITS = (UNBREAKABLE - 1) * CELLS + BOSS_HITS  # of a round

_FLAG = (0, 1)
_ACROSS = (0.0, FIELD_WIDTH)
_UNIT = (-1.0 - ROUNDING, 1.0 + ROUNDING)
_DIVE = (-DIVE_SPEED * (1.0 + ROUNDING), DIVE_SPEED * (1.0 + ROUNDING))
_SHARD = (-SHARD_SPEED * (1.0 + ROUNDING), SHARD_SPEED * (1.0 + ROUNDING))
_FAST = (-1e9, 1e9)  # the ball's speed depends on the configuration
_ANY_SEED = (1, (1 << 64) - 1)  # the generator's state is never zero

WORLD_RANGES: dict[str, Range] = {
    "random": _ANY_SEED,
    "decisions": (0, MOST),
    "score": (0, MOST),
    "lives": (0, MOST),
    "round_number": (1, MOST_ROUNDS),
    "brick_changes": (0, LAST_CHANGE),
    "changed_cells": (0, CELLS - 1),
    "paddle_x": _ACROSS,
    "paddle_vx": _FAST,
    "paddle_half": _ACROSS,
    "paddle_shape": (0, 1),  # PADDLE_SHAPE, LONG_PADDLE_SHAPE
    "move": (-1.0, 1.0),
    "fire": (0.0, 1.0),
    "power": (0, POWERS),
    "capsule": (0, CAPSULES),
    "ball_x": _ACROSS,
    "ball_y": (-ROUNDING, FIELD_HEIGHT),
    "ball_vx": _FAST,
    "ball_vy": _FAST,
    "ball_state": (0, FLYING),
    "ball_release": (0, CATCH_TICKS),
    "ball_bounces": (0, LOOP_BOUNCES),
    "idle": (0, IDLE_TICKS),
    "needed": (1, _MOST_HITS),
    "hits_left": (0, _MOST_HITS),
    "bricks_left": (0, CELLS),
    "speed_stage": (SPEED_STAGE_MIN, SPEED_STAGE_MAX),
    "beam_wait": (0, BEAM_TICKS),
    "beams": (0, MAX_BEAMS),
    "enemies": (0, MAX_ENEMIES),
    "enemy_wait": (0, ENEMY_TICKS_MAX),
    "boss_hits": (0, BOSS_HITS),
    "shards": (0, MAX_SHARDS),
    "bricks_broken": (0, _MOST_EVENTS),
    "lives_gained": (0, _MOST_EVENTS),
    "capsules_caught": (0, 32767),
    "enemies_destroyed": (0, 32767),
    "lives_lost": (0, 32767),
    "rounds_cleared": (0, 32767),
    "done": (0, LIFE_LOST),
    "cleared": (0, 0),  # the next round begins in the same tick
    "exit_open": _FLAG,
    "enemy_gate": (0, GATES - 1),
    "brick_hits": (0, UNBREAKABLE),
    "enemy_x": _ACROSS,
    # One that dives at the paddle from below may fly out of the field, and on.
    "enemy_y": (-1.0 - ROUNDING, HIGHEST),
    "enemy_vx": _DIVE,
    "enemy_vy": _DIVE,
    "enemy_course_x": _UNIT,
    "enemy_course_y": _UNIT,
    "enemy_side": (-1.0, 1.0),
    "enemy_state": (0, DIVING),
    "enemy_kind": (0, ENEMY_KINDS - 1),
    "enemy_clock": (0, CIRCLE_TICKS),
    "shard_wait": (0, SHARD_TICKS),
    "shard_x": _ACROSS,
    "shard_y": (0.0, BOSS_Y),
    "shard_vx": _SHARD,
    "shard_vy": _SHARD,
    "shard_state": (0, FLYING),
    "beam_x": _ACROSS,
    "beam_y": (0.0, FIELD_HEIGHT + 1.0),
    "beam_state": (0, FLYING),
    "capsule_x": _ACROSS,
    "capsule_y": (-CAPSULE_HEIGHT, FIELD_HEIGHT),
    "ball_offset": (-FIELD_WIDTH, FIELD_WIDTH),
    "ball_caught": _FLAG,
    "hits_since_serve": (0, MOST_TICKS),
    "next_life": (1, MOST + EXTRA_LIFE_EVERY),
    "first_random": _ANY_SEED,
    "first_decision": (0, MOST),
    "start": (0, REPEATED_SEED),
    "capped": (0, MOST_TICKS),
    "start_round": (1, 10**9),
    "start_seed": (0, (1 << 63) - 1),
    "start_difficulty": (-1.0, 1.0),
    "start_boss": _FLAG,
    "start_kind": (0, GOLD),
    "kind": (0, GOLD),
}

OUTCOME_RANGES: dict[str, Range] = {
    "reward": (-1e15, 1e15),
    "score": (0, MOST),
    "lives": (0, MOST),
    "round_number": (1, MOST_ROUNDS),
    "hits": (0, _MOST_EVENTS),
    "bricks_broken": (0, _MOST_EVENTS),
    "lives_gained": (0, _MOST_EVENTS),
    "capsules_caught": (0, 32767),
    "enemies_destroyed": (0, 32767),
    "lives_lost": (0, 32767),
    "rounds_cleared": (0, 32767),
    "bricks_left": (0, CELLS),
    "truncation": (0, DECISION_LIMIT),
    "terminated": _FLAG,
    "truncated": _FLAG,
}
