"""What a meeting of two bodies is, as records that kernels read and write."""

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
