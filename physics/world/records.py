"""The data of a simulation: bodies at work, what they are about to do, and what happened to them.

Two blocks of memory hold a world, each one array of bytes, so that a call of a kernel costs little
and a snapshot is a copy:

- its *state*, what changes: `Clock`, the `Motion` of everything that moves, each one's `Plan` with
  the order of these plans in time, and which bodies are inside of which sensor. A batch is a matrix
  of such rows.
- the *desk* at which it is stepped: what does not change, `Header`, the bodies' `Trait` records,
  shapes, the grid of what is static; and scratch paper. The worlds of a batch are stepped at one
  desk, one after the other, or at a copy of it for each thread.
"""

from typing import Any

import numpy as np

# What an event is (`Hit.kind`).
HIT = 0  # the two bounced off each other
BEGIN = 1  # a body entered a sensor
# It left the sensor. In what direction is not known of one that was moved out: by relaxation, or
# in a world that is not continuous.
END = 2

# What a body's plan is about (`Plan.kind`).
NOTHING = 0  # to fly on to the end of the step
CROSS_X = 1  # to go over into the next column of the grid
CROSS_Y = 2
MEET = 3  # to meet its partner


def _record(fields: list[tuple[Any, ...]]) -> "np.dtype[Any]":
    return np.dtype((np.record, fields))


# Times are sums of two numbers, of which the second is small: see `clock_time`.
Clock = _record(
    [
        ("time", np.float64),  # that has been simulated
        ("time_low", np.float64),
        ("capped", np.int64),  # times that a body used up its hits of a step
        ("planned", np.int64),  # the plans hold, if all motions are as the last step left them
    ]
)

Motion = _record(
    [
        ("x", np.float64),
        ("y", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
    ]
)

Trait = _record(
    [
        ("collider", np.int64),  # index in the shape table
        ("slot", np.int64),  # of its motion and plan; -1 for a static body
        ("home_x", np.float64),  # where a static body is
        ("home_y", np.float64),
        ("inverse_mass", np.float64),
        ("restitution", np.float64),
        ("category", np.int64),  # bits
        ("mask", np.int64),  # bits: the categories that it meets
        ("sensor", np.int64),  # row in the table of who is inside; -1 for what is solid
        ("roams", np.int64),  # it moves and is too large for the grid
    ]
)

# A pair whose restitution is not the product of its bodies'.
Override = _record([("a", np.int64), ("b", np.int64), ("restitution", np.float64)])

Header = _record(
    [
        ("bodies", np.int64),
        ("movers", np.int64),  # bodies that move
        ("sensors", np.int64),
        ("max_hits", np.int64),  # of one body in one step
        ("continuous", np.int64),  # with times of impact, not by steps
        ("left", np.float64),  # of the grid's cells, which reach to infinity at its border
        ("bottom", np.float64),
        ("cell", np.float64),  # size
        ("columns", np.int64),
        ("rows", np.int64),
        # Where the parts of the desk begin, in bytes, and how many items each has where that is not
        # one of the numbers above.
        ("traits_at", np.int64),
        ("shapes_at", np.int64),
        ("shapes", np.int64),
        ("edges_at", np.int64),
        ("edges", np.int64),
        ("moving_at", np.int64),
        ("sensing_at", np.int64),
        ("roaming_at", np.int64),
        ("roaming", np.int64),
        ("boundless_at", np.int64),
        ("boundless", np.int64),
        ("firsts_at", np.int64),
        ("items_at", np.int64),
        ("items", np.int64),
        ("overrides_at", np.int64),
        ("overrides", np.int64),
        ("progress_at", np.int64),
        ("near_at", np.int64),
        ("stale_at", np.int64),
        # The same of the state; the clock and the motions come first.
        ("left_as_at", np.int64),
        ("plans_at", np.int64),
        ("winners_at", np.int64),
        ("leaves", np.int64),
        ("heads_at", np.int64),
        ("heads", np.int64),  # one a cell, or none where there is little that moves
        ("inside_at", np.int64),
        ("state_size", np.int64),
    ]
)

Plan = _record(
    [
        ("time", np.float64),  # when it happens
        ("time_low", np.float64),
        ("at", np.float64),  # when the body was where its motion says
        ("at_low", np.float64),
        ("kind", np.int64),
        ("partner", np.int64),  # the body to meet
        ("normal_x", np.float64),  # from this body to its partner
        ("normal_y", np.float64),
        ("hits", np.int64),  # in this step
        ("column", np.int64),  # of the grid
        ("row", np.int64),
        ("next", np.int64),  # slots of the others in its cell, or -1
        ("previous", np.int64),
    ]
)

Progress = _record(
    [
        ("world", np.int64),  # being stepped, in a batch
        ("step", np.int64),  # of that world
        ("running", np.int64),  # the step has begun
        ("end", np.float64),  # of the step
        ("end_low", np.float64),
        ("slot", np.int64),  # of the pair to go on with, where nothing is continuous
        ("near", np.int64),
        ("full", np.int64),  # there was no room for another hit
        ("touching", np.int64),  # two bodies overlap or touch
        ("crowded", np.int64),  # relaxation gave up, with overlaps left for the next step
    ]
)

Hit = _record(
    [
        ("world", np.int64),  # of the batch; 0 for a single one
        ("kind", np.int64),  # HIT, BEGIN or END
        ("time", np.float64),  # of the world
        ("a", np.int64),  # the bodies' indices, a < b
        ("b", np.int64),
        (
            "normal",
            np.float64,
            (2,),
        ),  # unit vector from a to b; null where it is not known, see END
        ("point", np.float64, (2,)),
        ("impulse", np.float64),  # along the normal for a, the opposite for b; 0 with sensors
    ]
)
