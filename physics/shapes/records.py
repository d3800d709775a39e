"""The data of the engine: what a shape is, as records that kernels read.

Every collider is a *rounded convex region*: the points at most ``radius`` from a convex core, which
is an intersection of half-planes, closed or open towards infinity. A disc is a point rounded; a
box is four half-planes and no radius. Shapes lie in one array, their edges in another one, and a
shape names its slice of the edges. Coordinates are the body's: the shape lies where its body's
position translates it.
"""

import numpy as np

# The kinds of colliders, in the order of the dispatch table.
PARTICLE = 0
HALF_PLANE = 1
AXIS_ALIGNED_HALF_PLANE = 2
AXIS_ALIGNED_RECTANGLE = 3
RECTANGLE = 4
CONVEX = 5
KINDS = 6

# One collider. `lower` and `upper` are its bounding box; an unbounded region's are infinite.
Shape = np.dtype(
    (
        np.record,
        [
            ("kind", np.int64),
            ("first", np.int64),  # index of its first edge; edges run counterclockwise
            ("count", np.int64),  # number of its edges; 0 for a disc
            ("radius", np.float64),
            ("lower_x", np.float64),
            ("lower_y", np.float64),
            ("upper_x", np.float64),
            ("upper_y", np.float64),
        ],
    )
)

# One edge of a convex core: the core lies in `normal . p <= offset`, and the edge is that part of
# the line's points which belongs to the core. Its direction is the normal turned by +90 degrees.
# A missing end (the edge runs to infinity there) has `has_start` or `has_end` 0, and `start` and
# `end` both name a finite point of the edge: the other end or, on a whole line, the foot.
Edge = np.dtype(
    (
        np.record,
        [
            ("normal_x", np.float64),
            ("normal_y", np.float64),
            ("offset", np.float64),
            ("start_x", np.float64),
            ("start_y", np.float64),
            ("end_x", np.float64),
            ("end_y", np.float64),
            ("has_start", np.int64),
            ("has_end", np.int64),
        ],
    )
)
