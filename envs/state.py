"""The data of the game: one NumPy record per world, so that a snapshot is a copy of bytes.

What never changes during play is kept apart, and all worlds of a batch share it: the rules
(`rulebook.Rules`) and the levels that are played in turn (`LevelEntry`). The layout of the present
round belongs to the world, because each world may play another one.
"""

import math
from typing import Any, TypeAlias

import numpy as np

from ..physics.kernels.layouts import record_dtype
from .rules import CELLS, MAX_BALLS, MAX_BEAMS, MAX_ENEMIES, MAX_SHARDS

# The states of a ball and of an enemy. Beams and shards are either absent or flying.
ABSENT = 0
HELD = 1  # a ball that lies on the paddle
FLYING = 2
ENTERING = 1  # an enemy in the gate
DRIFTING = 2
CIRCLING = 3
DIVING = 4

# Why an episode is over (`World.done`).
GAME_OVER = 1  # the last life is lost, or the game is truncated
LIFE_LOST = 2  # with `episodic_life`: the next episode goes on with the game

# Why an episode was truncated (`Outcome.truncation`).
NOT_TRUNCATED = 0
DECISION_LIMIT = 1

# Where an episode gets its first round from (`World.start`).
AS_CONFIGURED = 0
GIVEN_LAYOUT = 1
GIVEN_SEED = 2
REPEATED_SEED = 3  # and every further round, too

# A world remembers this number of latest changes of its bricks, so that observers need not look at
# all bricks. It is a power of two.
MAX_CHANGES = 8

# Where counters stop that the rules leave without a bound. Nobody plays so long, but a state from
# outside may be there already.
MOST = 1 << 60  # points, lives
MOST_TICKS = 1 << 30  # and hits: what is counted in 32 bits
MOST_ROUNDS = 2 * 10**9  # an episode can begin with round 10**9
HIGHEST = 1e6  # of an enemy that flies up, out of the field
# The number of changes of bricks begins anew after this one, in binary all ones.
LAST_CHANGE = (1 << 53) - 1

_LINE = 64  # bytes

# What kernels take. A type checker can't tell one dtype from another, so the names do.
WorldRecord: TypeAlias = Any  # one `World`
Worlds: TypeAlias = Any  # `World` [n]
OutcomeRecord: TypeAlias = Any  # one `Outcome`
Outcomes: TypeAlias = Any  # `Outcome` [n]
Levels: TypeAlias = Any  # `LevelEntry` [n]
RulesRecord: TypeAlias = Any  # one `rulebook.Rules`
SharedRules: TypeAlias = Any  # `rulebook.Rules` [1], of all worlds of a batch


def zeros_in_lines(shape: tuple[int, ...], dtype: Any) -> Any:
    """Return a new array of zeros that begins where a line of the processor's caches does."""
    size = math.prod(shape) * np.dtype(dtype).itemsize
    memory = np.zeros(size + _LINE, np.uint8)
    first = -memory.ctypes.data % _LINE
    return memory[first : first + size].view(dtype).reshape(shape)


def copy_records(records: Any) -> Any:
    """Return a copy of records, of any shape; NumPy's own goes field by field."""
    copied = np.frombuffer(bytearray(records.tobytes()), records.dtype)
    return copied.reshape(records.shape)


# One level: the kind of brick of each cell, row by row from the top, and whether the boss is there.
LevelEntry = record_dtype([("kind", np.uint8, (CELLS,)), ("boss", np.bool_)])

# A step of a batch that is larger than the processor's caches takes as long as it takes to bring
# the lines of 64 bytes that it touches. So fields that are touched together lie together, and the
# wider ones first, which leaves hardly any gaps. What may grow without bound has 64 bits, and so
# has what is passed to a kernel that also takes constants: it would be compiled a second time.
World = record_dtype(
    [
        # What every decision touches: 320 bytes.
        ("random", np.uint64),  # the generator's state, see random.py
        ("decisions", np.int64),  # of this game
        ("score", np.int64),
        ("lives", np.int64),
        ("round_number", np.int64),  # from 1
        ("brick_changes", np.int64),  # their number, earlier episodes included, see `LAST_CHANGE`
        ("changed_cells", np.uint8, (MAX_CHANGES,)),  # by change i at i % MAX_CHANGES
        ("paddle_x", np.float64),
        ("paddle_vx", np.float64),  # of the latest tick
        ("paddle_half", np.float64),  # half its width
        ("paddle_shape", np.int64),
        ("move", np.float64),  # the latest command, for sticky actions
        ("fire", np.float64),
        ("power", np.int64),  # CATCH, ENLARGE or LASER, or NO_POWER
        ("capsule", np.int64),  # the one that falls, or NO_CAPSULE
        ("ball_x", np.float64, (MAX_BALLS,)),
        ("ball_y", np.float64, (MAX_BALLS,)),
        ("ball_vx", np.float64, (MAX_BALLS,)),  # per tick
        ("ball_vy", np.float64, (MAX_BALLS,)),
        ("ball_state", np.int32, (MAX_BALLS,)),
        ("ball_release", np.int32, (MAX_BALLS,)),  # ticks until a held ball leaves by itself
        ("ball_bounces", np.int32, (MAX_BALLS,)),  # without damage or paddle contact
        ("idle", np.int32),  # ticks without damage; a new serve starts it anew
        ("needed", np.int32),  # hits that clear the round, at its beginning
        ("hits_left", np.int32),  # hits that still clear the round
        ("bricks_left", np.int32),  # breakable bricks
        ("speed_stage", np.int32),
        ("beam_wait", np.int32),  # ticks until the laser can shoot again
        ("beams", np.int32),  # how many fly
        ("enemies", np.int32),  # how many there are
        ("enemy_wait", np.int32),  # ticks until the next one comes in
        ("boss_hits", np.int32),  # that it still takes; 0: there is none
        ("shards", np.int32),  # how many fly
        # What happened in this decision, see `Outcome`.
        ("bricks_broken", np.int32),
        ("lives_gained", np.int32),
        ("capsules_caught", np.int16),
        ("enemies_destroyed", np.int16),
        ("lives_lost", np.int16),
        ("rounds_cleared", np.int16),
        # Flags, and what else is small.
        ("done", np.int16),  # the episode is over; the next step resets in next-step mode
        ("cleared", np.int16),  # the round is won; the next begins at the end of the tick
        ("exit_open", np.int16),  # the gate in the right wall
        ("enemy_gate", np.int16),  # through which the next enemy comes
        # The hits that each brick still takes (0: there is none). A ball looks at those near it.
        ("brick_hits", np.uint8, (CELLS,)),
        # What is touched only while there are such things, or when something happens to them.
        ("enemy_x", np.float64, (MAX_ENEMIES,)),
        ("enemy_y", np.float64, (MAX_ENEMIES,)),
        ("enemy_vx", np.float64, (MAX_ENEMIES,)),  # of the latest tick
        ("enemy_vy", np.float64, (MAX_ENEMIES,)),
        # Its course as a unit vector, while it circles or dives.
        ("enemy_course_x", np.float64, (MAX_ENEMIES,)),
        ("enemy_course_y", np.float64, (MAX_ENEMIES,)),
        ("enemy_side", np.float64, (MAX_ENEMIES,)),  # -1 or 1: where it goes next, or turns
        ("enemy_state", np.int32, (MAX_ENEMIES,)),
        ("enemy_kind", np.int32, (MAX_ENEMIES,)),
        ("enemy_clock", np.int32, (MAX_ENEMIES,)),  # ticks since it circles
        ("shard_wait", np.int32),  # ticks until the boss throws
        ("shard_x", np.float64, (MAX_SHARDS,)),
        ("shard_y", np.float64, (MAX_SHARDS,)),
        ("shard_vx", np.float64, (MAX_SHARDS,)),
        ("shard_vy", np.float64, (MAX_SHARDS,)),
        ("shard_state", np.int32, (MAX_SHARDS,)),
        ("beam_x", np.float64, (MAX_BEAMS,)),
        ("beam_y", np.float64, (MAX_BEAMS,)),
        ("beam_state", np.int32, (MAX_BEAMS,)),
        ("capsule_x", np.float64),  # its middle
        ("capsule_y", np.float64),
        ("ball_offset", np.float64, (MAX_BALLS,)),  # of a held ball, from the paddle's middle
        ("ball_caught", np.int32, (MAX_BALLS,)),  # 1: held by catch; 0: to be served
        ("hits_since_serve", np.int32),
        ("next_life", np.int64),  # the score that brings the next extra life
        # What the beginning of an episode touches, or of a round.
        ("first_random", np.uint64),  # the generator's state when this game began
        ("first_decision", np.int64),  # the game's decisions when this episode began
        # How episodes begin, until a reset says otherwise.
        ("start", np.int32),
        ("capped", np.int32),  # ticks of this episode with more hits than are resolved
        ("start_round", np.int64),
        ("start_seed", np.int64),
        ("start_difficulty", np.float64),  # of generated rounds; negative: as configured
        ("start_boss", np.int64),
        ("start_kind", np.uint8, (CELLS,)),
        ("kind", np.uint8, (CELLS,)),  # of each brick of the present round's layout
    ]
)

# What one decision led to, for `step`'s results and `info`: 64 bytes.
Outcome = record_dtype(
    [
        ("reward", np.float64),
        ("score", np.int64),
        ("lives", np.int64),
        ("round_number", np.int64),
        # Of this decision.
        ("hits", np.int32),  # on bricks, and the boss, that need them
        ("bricks_broken", np.int32),
        ("lives_gained", np.int32),
        ("capsules_caught", np.int16),
        ("enemies_destroyed", np.int16),
        ("lives_lost", np.int16),
        ("rounds_cleared", np.int16),
        ("bricks_left", np.int16),
        ("truncation", np.int8),
        ("terminated", np.bool_),
        ("truncated", np.bool_),
    ]
)
# The keys of `info`, in the single and in the vector environment, and what each means.
INFO_MEANINGS = {
    "score": "points",
    "lives": "balls left, the present one included",
    "round": "the number of the round, from 1",
    "bricks_left": "breakable bricks left",
    "truncation": "why the episode was truncated: 0 it was not, 1 `max_decisions`",
    "hits": "hits on bricks and the boss that the round needs, in this decision",
    "bricks_broken": "how many, in this decision",
    "capsules_caught": "how many, in this decision",
    "enemies_destroyed": "how many, in this decision",
    "lives_lost": "how many, in this decision",
    "lives_gained": "how many, in this decision",
    "rounds_cleared": "how many, in this decision",
}
# The fields of `Outcome` that they show. (Where the kernels run interpreted, NumPy's method `round`
# would hide a field of that name.)
INFO_FIELDS = {key: "round_number" if key == "round" else key for key in INFO_MEANINGS}
