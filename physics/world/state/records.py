"""The data of a simulation: bodies, what they are about to do, and what happened to them.

Three blocks of memory hold a world. Each is one array of bytes, so that a kernel call costs little:

- its *state*, which steps change: `Clock`, the `Course` of every moving body, the `Plan` of each
  with the order of these plans in time, and the grid of their boxes. A batch is a matrix with one
  such row per world.
- which bodies are *inside* which sensor, see `lookup.inside`: it grows with what is inside.
- the *workspace* in which it is stepped: what only edits change (`Header`, the bodies' `Trait`
  records, shapes, the tree of static bodies) and scratch memory. The worlds of a batch share one
  workspace per thread, one after the other, until a world is edited: then it gets its own.

All parts have room for more. Where there is none, Python makes a larger block between two steps.
"""

from typing import Any, TypeAlias

import numpy as np

from ...kernels.layouts import record_dtype

# What an event is (`Hit.kind`).
HIT = 0  # two bodies bounced off each other
BEGIN = 1  # a body entered a sensor
END = 2  # a body left a sensor; the normal is zero where the direction is not known

# What a body plans (`Plan.kind`).
NOTHING = 0  # to move straight on until the step ends
LEAVE = 1  # to leave its box
MEET = 2  # to meet its partner
LOOK = 3  # to look again what it slides into

# What a body's hits of this step have made of it (`Plan.stage`).
FREE = 0  # it bounces
INERT = 1  # it has used up `max_hits`: it bounces no more
CRUSHED = 2  # it has no room: what touches it moves into it
HELD = 3  # it has used up as many again: it stays where it is, as if it had no mass

# Whether plans hold (`Clock.planned`).
NEW = -1  # there are none yet: all bodies are fresh
UNPLANNED = 0  # they have to be made
PLANNED = 1  # they hold, but for fresh bodies and those that users moved

# Whether there are fresh bodies, see `Course` (`Clock.fresh`).
OLD = 0  # none
FRESH = 1
GROUND_GONE = 2  # and one has gone that may have been a part of a moving ground

# Whether an index has a body (`Entry.state`).
UNUSED = 0  # none
ON = 1
OFF = 2  # one that meets nothing, and stays where it is

# The index of a body has so many bits: in a handle, and in the number of a pair (`Plan.pair`).
INDEX_BITS = 32
INDEX_MASK = (1 << INDEX_BITS) - 1

# With so few moving bodies there is no grid of them.
FEW_MOVING = 8

# Times are sums of two numbers, of which the second is small: see `clock_time`.
Clock = record_dtype(
    [
        ("time", np.float64),  # simulated so far
        ("time_low", np.float64),
        ("capped", np.int64),  # how often a body used up its hits of a step, or had no room
        ("planned", np.int64),  # NEW, UNPLANNED or PLANNED
        ("fresh", np.int64),  # OLD, FRESH or GROUND_GONE
    ]
)

Motion = record_dtype(
    [
        ("x", np.float64),
        ("y", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
    ]
)

# The course of a moving body: where it was when it last changed its motion, and since when it has
# flown straight on. 64 bytes, as a processor reads them.
Course = record_dtype(
    [
        ("x", np.float64),
        ("y", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
        ("at", np.float64),  # when it was there
        ("at_low", np.float64),
        ("speed", np.float64),  # |vx| + |vy|, the most since a user last wrote it
        ("fresh", np.int64),  # 1: its plan does not hold, and it may overlap others
    ]
)

Trait = record_dtype(
    [
        ("collider", np.int64),  # index in the shape table
        ("slot", np.int64),  # of its motion and plan; -1 for a body that is static or off
        ("home_x", np.float64),  # position of such a body
        ("home_y", np.float64),
        ("inverse_mass", np.float64),
        ("restitution", np.float64),
        ("category", np.int64),  # bits
        ("mask", np.int64),  # bits: the categories that it meets
        ("sensor", np.int64),  # 0: a sensor; -1: a solid body
        ("boundless", np.int64),  # 1: it has no bounding box, and everything is tested against it
    ]
)

# What stepping a body does not need.
Entry = record_dtype(
    [
        ("handle", np.int64),  # of the body, or of the next one that gets this index
        ("state", np.int64),  # UNUSED, ON or OFF
        ("next_free", np.int64),  # the next unused index, or -1
        ("mass", np.float64),  # infinite without a mass
        ("vx", np.float64),  # of a body that is off: its velocity when it is on again
        ("vy", np.float64),
    ]
)

# A pair, by its handles, whose restitution is not the product of its bodies' values. It is nan if
# it was taken back; a = -1: no pair.
Override = record_dtype([("a", np.int64), ("b", np.int64), ("restitution", np.float64)])

Header = record_dtype(
    [
        ("bodies", np.int64),  # indices that have, or had, a body
        ("bodies_room", np.int64),
        ("living", np.int64),  # bodies that there are
        ("free", np.int64),  # the first unused index below `bodies`, or -1
        ("movers", np.int64),  # bodies that move
        ("movers_room", np.int64),
        ("sensors", np.int64),  # 1: there is, or was, a sensor
        ("max_hits", np.int64),  # of one body in one step, see `count_hit`
        ("rest_speed", np.float64),  # up to which a pair meets without restitution
        ("continuous", np.int64),  # 1: with times of impact; 0: the lecture's procedure
        ("inelastic", np.int64),  # 1: some bodies do not bounce, or did not
        ("typical", np.float64),  # length: the median of the bodies' sizes
        ("margin", np.float64),  # of the first box of a typical body, see `lookup.boxes`
        ("cell", np.float64),  # size of the cells of the grid that suit a typical body
        ("has_grid", np.int64),  # 0: so few bodies move that a grid of them is not worth it
        # Where each part of the workspace begins, in bytes, and its number of items where that is
        # none of the numbers above.
        ("traits_at", np.int64),
        ("entries_at", np.int64),
        ("shapes_at", np.int64),
        ("shapes", np.int64),
        ("shapes_room", np.int64),
        ("edges_at", np.int64),
        ("edges", np.int64),
        ("edges_room", np.int64),
        ("moving_at", np.int64),
        ("boundless_at", np.int64),
        ("boundless", np.int64),
        ("static_tree_at", np.int64),
        ("static_nodes_at", np.int64),
        ("static_nodes", np.int64),  # two per body that there is room for
        ("overrides_at", np.int64),
        ("overrides", np.int64),  # length of the table, a power of two or 0
        ("overrides_used", np.int64),
        ("progress_at", np.int64),
        ("near_at", np.int64),
        ("found_at", np.int64),
        ("stale_at", np.int64),
        ("order_at", np.int64),
        ("stack_at", np.int64),
        ("places_at", np.int64),
        ("members_at", np.int64),
        ("members", np.int64),
        ("touches_at", np.int64),
        ("touches", np.int64),
        # The same for the state, which begins with the clock and the motions that users see.
        ("shown_after_step_at", np.int64),
        ("motions_at", np.int64),
        ("plans_at", np.int64),
        ("winners_at", np.int64),
        ("leaves", np.int64),
        ("boxes_at", np.int64),
        ("links_at", np.int64),
        ("grid_at", np.int64),
        ("level_counts_at", np.int64),
        ("heads_at", np.int64),
        ("heads", np.int64),  # a power of two
        ("state_size", np.int64),
    ]
)

# 192 bytes: what is used together is in one of three lines, as a processor reads them.
Plan = record_dtype(
    [
        ("time", np.float64),  # when it happens
        ("time_low", np.float64),
        ("kind", np.int64),
        ("partner", np.int64),  # the body to meet
        ("pair", np.int64),  # the two bodies as one number, whichever of them plans
        # The slots of the bodies that plan to meet this one are a list; -1 where it ends.
        ("suitor", np.int64),
        ("next_suitor", np.int64),
        ("previous_suitor", np.int64),
        ("normal_x", np.float64),  # from this body to its partner
        ("normal_y", np.float64),
        ("slack", np.float64),  # what rounding may add to the time until it meets its partner
        ("tied", np.int32),  # 1: it meets another body at the same time
        ("nowhere", np.int32),  # 1: it went next to nowhere to its last hit
        ("hits", np.int64),  # in this step, see `count_hit`; from 0 again at each later stage
        ("rests", np.int64),  # how often it has come to rest since it went some way
        ("series", np.int64),  # hits in a row to which it went next to nowhere
        ("stage", np.int64),  # FREE, INERT, CRUSHED or HELD
        # Its box, see `lookup.boxes`: where it was made, when, and whether it is in the grid.
        ("middle_x", np.float64),
        ("middle_y", np.float64),
        ("margin", np.float64),
        ("fitted", np.float64),
        ("near", np.int64),  # bodies that it may meet there; -1: too many for its list
        ("fixed", np.int64),  # of these, how many are not found by the grid
        ("is_linked", np.int64),
        ("previous", np.int64),  # the slot before it in the list of its cell, or -1
    ]
)

# A place in the tournament of plans: whose plan it is, and when.
Seat = record_dtype([("time", np.float64), ("slot", np.int64)])

# Where a body may be before it leaves its box, with the body's extent; and its place in the grid.
# 64 bytes, as a processor reads them.
Box = record_dtype(
    [
        ("lower_x", np.float64),
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("level", np.int64),
        ("column", np.int64),
        ("row", np.int64),
        ("next", np.int64),  # the next slot in the list of its cell, or -1
    ]
)

# The grid: the first and the last level that has bodies.
Grid = record_dtype(
    [
        ("lowest", np.int64),
        ("highest", np.int64),
        ("ready", np.int64),  # 1: every body has a box
    ]
)

# A node of a tree of boxes, see `lookup.tree`: 64 bytes, as a processor reads them.
Node = record_dtype(
    [
        ("lower_x", np.float64),
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("parent", np.int64),  # -1: the root; of an unused node, the next one of these
        ("left", np.int64),  # -1: a leaf
        ("right", np.int64),
        ("height", np.int64),
    ]
)

Tree = record_dtype([("root", np.int64), ("free", np.int64)])

# How many pairs of a sensor and a body inside there are, and the first unused record of a pair.
Inside = record_dtype([("count", np.int64), ("free", np.int64), ("room", np.int64)])

Pair = record_dtype(
    [
        ("sensor", np.int64),  # -1: unused
        ("body", np.int64),
        ("next", np.int64),  # in the body's list; of an unused pair, the next one of these
        ("next_guest", np.int64),  # in the sensor's list
        ("previous_guest", np.int64),
        ("moved", np.int64),  # 1: one of the two was placed elsewhere, and has no plan
    ]
)

# A ray, or the way of a shape, and what it meets first.
Ray = record_dtype(
    [
        ("x", np.float64),  # its start
        ("y", np.float64),
        ("way_x", np.float64),  # to its end
        ("way_y", np.float64),
        ("inverse_x", np.float64),  # 1 / way_x, but at most 1e300
        ("inverse_y", np.float64),
        ("room", np.float64),  # how far beside it bodies are met
        ("body", np.int64),  # -1: none
        ("fraction", np.float64),  # of the way
        ("normal_x", np.float64),  # to the body
        ("normal_y", np.float64),
    ]
)

Hit = record_dtype(
    [
        ("world", np.int64),  # index in the batch; 0 for a single world
        ("kind", np.int64),  # HIT, BEGIN or END
        ("time", np.float64),  # of the world
        ("a", np.int64),  # the bodies' handles; a has the lower index
        ("b", np.int64),
        ("normal", np.float64, (2,)),  # unit vector from a to b; zero if not known, see END
        ("point", np.float64, (2,)),
        ("impulse", np.float64),  # along the normal for a, the opposite for b; 0 with sensors
    ]
)

# What kernels are passed. Numba types it; to a type checker it is anything.
Block: TypeAlias = Any  # uint8 [bytes]
Indices: TypeAlias = Any  # int64 [n]
ClockRecord: TypeAlias = Any  # one `Clock`
CourseRecord: TypeAlias = Any  # one `Course`
Courses: TypeAlias = Any  # `Course` [movers]
Motions: TypeAlias = Any  # `Motion` [movers]
TraitRecord: TypeAlias = Any  # one `Trait`
Traits: TypeAlias = Any  # `Trait` [bodies]
Entries: TypeAlias = Any  # `Entry` [bodies]
Overrides: TypeAlias = Any  # `Override` [pairs]
Seats: TypeAlias = Any  # `Seat` [2 * leaves]
HeaderRecord: TypeAlias = Any  # one `Header`
BoxRecord: TypeAlias = Any  # one `Box`
Boxes: TypeAlias = Any  # `Box` [n]
GridRecord: TypeAlias = Any  # one `Grid`
RayRecord: TypeAlias = Any  # one `Ray`
Nodes: TypeAlias = Any  # `Node` [n]
TreeRecord: TypeAlias = Any  # one `Tree`
InsideRecord: TypeAlias = Any  # one `Inside`
Pairs: TypeAlias = Any  # `Pair` [room]
PlanRecord: TypeAlias = Any  # one `Plan`
Plans: TypeAlias = Any  # `Plan` [movers]
Hits: TypeAlias = Any  # `Hit` [room]
