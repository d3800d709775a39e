"""What a meeting of two bodies and a sandbox are, as records that kernels read and write."""

import numpy as np

from ..kernels.layouts import record_dtype
from ..shapes.records import Edge, Shape

# The most edges of a pattern, and the most corners of its outline: of a square that each edge cuts.
MAX_EDGES = 5
MAX_CORNERS = 4 + MAX_EDGES

# One of the two bodies, and what becomes of it.
Figure = record_dtype(
    [
        ("pattern", np.int64),  # its row in the table of patterns
        ("turn", np.int64),  # counterclockwise, in degrees
        ("width", np.float64),  # times the pattern's; a disc's and a polygon's only measure
        ("height", np.float64),  # of a rectangle
        ("x", np.float64),
        ("y", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
        ("mass", np.float64),  # 0: static
        ("restitution", np.float64),
        ("radius", np.float64),  # its rounding
        ("share", np.float64),  # of a separation
        ("relaxed_x", np.float64),  # where relaxation moves it
        ("relaxed_y", np.float64),
        ("impact_x", np.float64),  # where it is at the time of impact
        ("impact_y", np.float64),
        ("bounced_vx", np.float64),  # its velocity after a bounce
        ("bounced_vy", np.float64),
        ("corners", np.int64),
        ("outline", np.float64, (2 * MAX_CORNERS,)),  # x and y of each, relative to its position
    ]
)

# Two bodies, and what the engine says of them. Names are those of `operations`.
Meeting = record_dtype(
    [
        ("a", Figure),
        ("b", Figure),
        ("patterns", np.int64),  # `Shape` [number_of_patterns]
        ("pattern_edges", np.int64),  # `Edge` [number_of_edges]
        ("turns", np.int64),  # float64 [360, 2]: cosine and sine of each degree
        ("number_of_patterns", np.int64),
        ("number_of_edges", np.int64),
        ("algorithm", np.int64),  # which serves the pair, see `pairs.table`
        ("overlap", np.int64),  # whether they overlap
        ("normal_x", np.float64),  # the contact's
        ("normal_y", np.float64),
        ("depth", np.float64),
        ("point_x", np.float64),
        ("point_y", np.float64),
        ("time", np.float64),  # of impact; inf: never
        ("touching", np.int64),  # whether that is now, up to the margins of touching
        ("impact_normal_x", np.float64),
        ("impact_normal_y", np.float64),
        ("impact_point_x", np.float64),  # where they touch at that time
        ("impact_point_y", np.float64),
        ("restitution", np.float64),  # the product of both
        ("approach", np.float64),  # u, the speed of approach along the impact's normal
        ("impulse", np.float64),  # J of the bounce at that time
        ("shapes", np.uint8, (2 * Shape.itemsize,)),  # `Shape` [2], as they are
        ("edges", np.uint8, (2 * MAX_EDGES * Edge.itemsize,)),  # `Edge` [2 * MAX_EDGES]
        ("scratch", np.float64, (2 * MAX_CORNERS,)),
    ]
)

# A body of a sandbox, as it is now.
Seen = record_dtype(
    [
        ("handle", np.int64),
        ("x", np.float64),
        ("y", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
        ("mass", np.float64),  # infinite without a mass
        ("restitution", np.float64),
        ("sensor", np.int64),  # 1: a sensor
    ]
)

# A world to throw things in, with the blocks of `World`; and what a call asks and answers.
Sandbox = record_dtype(
    [
        ("workspace", np.int64),  # the blocks, uint8: see `world.state.records`
        ("workspace_size", np.int64),
        ("state", np.int64),
        ("state_size", np.int64),
        ("inside", np.int64),
        ("inside_size", np.int64),
        ("pairs", np.int64),  # that there is room for in it
        ("hits", np.int64),  # `Hit` [hits_room]
        ("hits_room", np.int64),
        ("call", np.int64),  # int64 [number_of_call], see `call_of`
        ("found", np.int64),  # int64 [room]: handles
        ("scratch", np.int64),  # float64 [room]
        ("bodies", np.int64),  # `Seen` [room]
        ("rays", np.int64),  # `Ray` [RAYS]
        ("room", np.int64),  # for bodies
        ("patterns", np.int64),  # tables, as of a meeting
        ("pattern_edges", np.int64),
        ("turns", np.int64),
        ("number_of_patterns", np.int64),
        ("number_of_edges", np.int64),
        ("figure", Figure),  # what is thrown in or changed: its numbers, and its outline
        ("sensor", np.int64),  # whether it is a sensor
        ("handle", np.int64),  # which body; -1: there is no room, or no such body
        ("dt", np.float64),  # of a step
        ("gravity", np.float64),  # how much speed downwards bodies gain in a unit of time
        ("goes_on", np.int64),  # 1: the step goes on that had no more room for hits
        ("outcome", np.int64),  # of a step: DONE, MORE, CROWDED or LOST, see `sandbox`
        ("count", np.int64),  # of the hits, the handles that were found, or the bodies
        ("x", np.float64),  # where a question is asked, or rays begin
        ("y", np.float64),
        ("reach", np.float64),  # a radius about this place, or the length of rays
        ("time", np.float64),  # so far
        ("capped", np.int64),
        ("energy", np.float64),  # of all bodies with a mass, that of their height included
        ("momentum_x", np.float64),
        ("momentum_y", np.float64),
    ]
)
RAYS = 180  # of a fan: every second degree
