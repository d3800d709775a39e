"""The data of the game: one record a world, so that a batch is an array and a snapshot its bytes.

What never changes during play is not in it: the rules (`rulebook.Rules`) and the levels that are
played in turn (`Level`) are shared by all worlds of a batch. The layout of the round that is being
played is the world's own, for no two worlds need play the same.
"""

import numpy as np

from .rules import CELLS, MAX_BALLS, MAX_BEAMS, MAX_ENEMIES, MAX_SHARDS

# Where a ball is, or an enemy. Of beams and shards there are only absent and flying ones.
ABSENT = 0
HELD = 1  # a ball that lies on the paddle
FLYING = 2
ENTERING = 1  # an enemy in the gate
DRIFTING = 2
CIRCLING = 3
DIVING = 4

# Why an episode was cut (`Outcome.truncation`).
NOT_TRUNCATED = 0
DECISION_LIMIT = 1
IDLE = 2

# How the first round of an episode is found (`World.start`).
AS_CONFIGURED = 0
GIVEN_LAYOUT = 1
GIVEN_SEED = 2

# One level: the kind of brick of each cell, row by row from the top, and whether the boss is there.
Level = np.dtype((np.record, [("kind", np.uint8, (CELLS,)), ("boss", np.bool_)]))

World = np.dtype(
    (
        np.record,
        [
            ("random", np.uint64),  # the generator's state, see random.py
            ("first_random", np.uint64),  # as it was when this episode began
            ("done", np.int64),  # the episode is over; the next step resets in next-step mode
            ("decisions", np.int64),  # of this episode
            ("idle", np.int64),  # ticks since a brick or the boss was damaged
            ("score", np.int64),
            ("lives", np.int64),
            ("next_life", np.int64),  # the score that brings the next extra life
            ("round_number", np.int64),  # from 1
            ("cleared", np.int64),  # the round is won; the next begins at the end of the tick
            ("needed", np.int64),  # hits that clear the round, at its beginning
            ("hits_left", np.int64),  # hits that still clear the round
            ("bricks_left", np.int64),  # breakable bricks
            ("speed_stage", np.int64),
            ("hits_since_serve", np.int64),
            ("capped", np.int64),  # ticks of this episode that met more hits than are resolved
            ("lattice_changed", np.int64),  # the observation's bricks are stale
            ("capsules_shown", np.int64),  # the observation has numbers of them
            ("enemies_shown", np.int64),
            # What happened in this decision, see `Outcome`.
            ("bricks_broken", np.int64),
            ("capsules_caught", np.int64),
            ("enemies_destroyed", np.int64),
            ("lives_lost", np.int64),
            ("lives_gained", np.int64),
            ("rounds_cleared", np.int64),
            # The paddle.
            ("paddle_x", np.float64),
            ("paddle_vx", np.float64),  # of the latest tick
            ("paddle_half", np.float64),  # half its width
            ("paddle_shape", np.int64),
            ("move", np.float64),  # the latest command, for sticky actions
            ("fire", np.float64),
            # Balls.
            ("ball_state", np.int64, (MAX_BALLS,)),
            ("ball_x", np.float64, (MAX_BALLS,)),
            ("ball_y", np.float64, (MAX_BALLS,)),
            ("ball_vx", np.float64, (MAX_BALLS,)),  # per tick
            ("ball_vy", np.float64, (MAX_BALLS,)),
            ("ball_offset", np.float64, (MAX_BALLS,)),  # of a held ball, from the paddle's middle
            ("ball_release", np.int64, (MAX_BALLS,)),  # ticks until a held ball leaves by itself
            ("ball_caught", np.int64, (MAX_BALLS,)),  # 1: held by catch; 0: to be served
            ("ball_bounces", np.int64, (MAX_BALLS,)),  # without damage or paddle contact
            # Capsules and what they bring.
            ("power", np.int64),  # CATCH, ENLARGE or LASER, or NO_POWER
            ("exit_open", np.int64),  # the gate in the right wall
            ("capsule", np.int64),  # that falls, or NO_CAPSULE
            ("capsule_x", np.float64),  # its middle
            ("capsule_y", np.float64),
            ("beam_wait", np.int64),  # ticks until the laser can shoot again
            ("beams", np.int64),  # how many fly
            ("beam_state", np.int64, (MAX_BEAMS,)),
            ("beam_x", np.float64, (MAX_BEAMS,)),
            ("beam_y", np.float64, (MAX_BEAMS,)),
            # Enemies.
            ("enemies", np.int64),  # how many there are
            ("enemy_wait", np.int64),  # ticks until the next comes in
            ("enemy_gate", np.int64),  # through which it comes
            ("enemy_state", np.int64, (MAX_ENEMIES,)),
            ("enemy_kind", np.int64, (MAX_ENEMIES,)),
            ("enemy_x", np.float64, (MAX_ENEMIES,)),
            ("enemy_y", np.float64, (MAX_ENEMIES,)),
            ("enemy_vx", np.float64, (MAX_ENEMIES,)),  # of the latest tick
            ("enemy_vy", np.float64, (MAX_ENEMIES,)),
            # Its course as a unit vector, while it circles or dives.
            ("enemy_course_x", np.float64, (MAX_ENEMIES,)),
            ("enemy_course_y", np.float64, (MAX_ENEMIES,)),
            ("enemy_side", np.float64, (MAX_ENEMIES,)),  # -1 or 1: where it goes next, or turns
            ("enemy_clock", np.int64, (MAX_ENEMIES,)),  # ticks since it circles
            # The boss.
            ("boss_hits", np.int64),  # that it still takes; 0: there is none
            ("shard_wait", np.int64),  # ticks until the boss throws
            ("shards", np.int64),  # how many fly
            ("shard_state", np.int64, (MAX_SHARDS,)),
            ("shard_x", np.float64, (MAX_SHARDS,)),
            ("shard_y", np.float64, (MAX_SHARDS,)),
            ("shard_vx", np.float64, (MAX_SHARDS,)),
            ("shard_vy", np.float64, (MAX_SHARDS,)),
            # Bricks: the round's layout, and the hits that each still takes (0: there is none).
            ("brick_hits", np.uint8, (CELLS,)),
            ("kind", np.uint8, (CELLS,)),
            # How episodes begin, until a reset says otherwise.
            ("start", np.int64),
            ("start_round", np.int64),
            ("start_seed", np.int64),
            ("start_difficulty", np.float64),  # of generated rounds; negative: as configured
            ("start_boss", np.int64),
            ("start_kind", np.uint8, (CELLS,)),
        ],
    )
)

# What one decision led to, for `step`'s results and `info`.
Outcome = np.dtype(
    (
        np.record,
        [
            ("reward", np.float64),
            ("terminated", np.bool_),
            ("truncated", np.bool_),
            ("score", np.int64),
            ("lives", np.int64),
            ("round_number", np.int64),
            ("bricks_left", np.int64),
            ("truncation", np.int64),
            # Of this decision.
            ("hits", np.int64),  # on bricks, and the boss, that need them
            ("bricks_broken", np.int64),
            ("capsules_caught", np.int64),
            ("enemies_destroyed", np.int64),
            ("lives_lost", np.int64),
            ("lives_gained", np.int64),
            ("rounds_cleared", np.int64),
        ],
    )
)
# The keys of `info`, in the single and in the vector env, and the fields that they show. (A field
# named `round` would be hidden by NumPy's method where the kernels run interpreted.)
INFO_FIELDS = {
    "score": "score",
    "lives": "lives",
    "round": "round_number",
    "bricks_left": "bricks_left",
    "truncation": "truncation",
    "hits": "hits",
    "bricks_broken": "bricks_broken",
    "capsules_caught": "capsules_caught",
    "enemies_destroyed": "enemies_destroyed",
    "lives_lost": "lives_lost",
    "lives_gained": "lives_gained",
    "rounds_cleared": "rounds_cleared",
}
