"""How far a step has come, and the group that is resolved in it: scratch memory of a workspace."""

from typing import Any, TypeAlias

import numpy as np

from ...kernels.layouts import record_dtype

# How far a step has come, so that it can continue when there is more room.
Progress = record_dtype(
    [
        ("running", np.int64),  # 1: the step has begun
        ("end", np.float64),  # of the step
        ("end_low", np.float64),
        ("next_body", np.int64),  # place of the next pair of the lecture's procedure
        ("next_near", np.int64),
        ("full", np.int64),  # 1: there was no room for another hit
        ("overlapping", np.int64),  # 1: a fresh body overlaps another one
        ("crowded", np.int64),  # 1: relaxation gave up, and left overlaps for the next step
        ("hits", np.int64),  # of all bodies in this step
        ("inert", np.int64),  # 1: for a body, the hits before decide how it bounces
        ("members", np.int64),  # of the group that is resolved
        ("touches", np.int64),  # between them
        ("elastic", np.int64),  # 1: one of these bounces
        ("receding", np.int64),  # 1: the bodies of one receded at first
    ]
)

# A moving body of a group that is resolved together, while that lasts.
Member = record_dtype(
    [
        ("body", np.int64),
        ("inverse_mass", np.float64),
        ("old_vx", np.float64),  # before
        ("old_vy", np.float64),
        ("vx", np.float64),  # after, as far as it is known
        ("vy", np.float64),
        ("seen_vx", np.float64),  # when its neighbours were last tested
        ("seen_vy", np.float64),
        ("seen", np.int64),  # 1: they have been
        ("turn_x", np.float64),  # how a step along the course changes its velocity, see `solver`
        ("turn_y", np.float64),
        ("met", np.int64),  # touches, and then hits
        ("rests", np.int64),  # 1: some are inelastic
        ("due", np.int64),  # 1: it had planned to meet somebody now, or somebody to meet it
        ("first", np.int64),  # of the list of touches whose first member it is; -1 if none
        ("last", np.int64),
    ]
)

# Two bodies of a group that touch and must not approach each other any more.
Touch = record_dtype(
    [
        ("one", np.int64),  # a member
        ("other", np.int64),  # a member, or -1 for a static body
        ("next", np.int64),  # in the list of the first member
        ("a", np.int64),  # their bodies
        ("b", np.int64),
        ("normal_x", np.float64),  # from a to b
        ("normal_y", np.float64),
        ("share_a", np.float64),  # of what an impulse changes of their relative speed
        ("share_b", np.float64),
        ("restitution", np.float64),
        ("aim", np.float64),  # the speed at which they have to recede
        ("change", np.float64),  # of their relative speed, by the impulse
        ("weight", np.float64),  # see `solver`: the mass for an impulse; the most is 1
        ("slope", np.float64),
        ("course", np.float64),
        ("bend", np.float64),
    ]
)

# What kernels are passed, see `records`.
ProgressRecord: TypeAlias = Any  # one `Progress`
Members: TypeAlias = Any  # `Member` [room]
Touches: TypeAlias = Any  # `Touch` [room]
TouchRecord: TypeAlias = Any  # one `Touch`
