"""The data of the game: one record a world, so that a batch is an array and a snapshot its bytes.

What never changes during play is not in it: the rules (`rules.Rules`) and the levels (`Level`) are
shared by all worlds of a batch.
"""

import numpy as np

from .rules import CELLS, MAX_BALLS

# Where a ball is.
ABSENT = 0
HELD = 1  # lies on the paddle
FLYING = 2

# Why an episode was cut (`Outcome.truncation`).
NOT_TRUNCATED = 0
DECISION_LIMIT = 1
IDLE = 2

# The layout of one round: the kind of brick of each cell, row by row from the top.
Level = np.dtype((np.record, [("kind", np.uint8, (CELLS,))]))

World = np.dtype(
    (
        np.record,
        [
            ("random", np.uint64),  # the generator's state, see random.py
            ("done", np.int64),  # the episode is over; the next step resets in next-step mode
            ("decisions", np.int64),  # of this episode
            ("idle", np.int64),  # ticks since a brick was damaged
            ("score", np.int64),
            ("lives", np.int64),
            ("next_life", np.int64),  # the score that brings the next extra life
            ("round_number", np.int64),  # from 1
            ("level", np.int64),  # index of the round's layout in the batch's levels
            ("needed", np.int64),  # hits that clear the round, at its beginning
            ("hits_left", np.int64),  # hits that still clear the round
            ("bricks_left", np.int64),  # breakable bricks
            ("speed_stage", np.int64),
            ("hits_since_serve", np.int64),
            ("held_ticks", np.int64),  # since the ball lies on the paddle
            ("capped", np.int64),  # ticks of this episode that met more hits than are resolved
            ("lattice_changed", np.int64),  # the observation's bricks are stale
            ("paddle_x", np.float64),
            ("paddle_vx", np.float64),  # of the latest tick
            ("move", np.float64),  # the latest command, for sticky actions
            ("fire", np.float64),
            ("ball_state", np.int64, (MAX_BALLS,)),
            ("ball_x", np.float64, (MAX_BALLS,)),
            ("ball_y", np.float64, (MAX_BALLS,)),
            ("ball_vx", np.float64, (MAX_BALLS,)),  # per tick
            ("ball_vy", np.float64, (MAX_BALLS,)),
            ("ball_offset", np.float64, (MAX_BALLS,)),  # of a held ball, from the paddle's middle
            ("ball_bounces", np.int64, (MAX_BALLS,)),  # without damage or paddle contact
            ("brick_hits", np.uint8, (CELLS,)),  # that each brick still takes; 0: there is none
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
            ("hits", np.int64),  # of this decision: hits on bricks that need them
            ("truncation", np.int64),
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
    "hits": "hits",
    "truncation": "truncation",
}
