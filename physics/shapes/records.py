"""The data of the engine: what a shape is, as records that kernels read.

Every collider is a *rounded convex region*: the points at most ``radius`` from a convex core, which
is an intersection of half-planes, closed or open towards infinity. A disc is a rounded point; a
box is four half-planes and no radius. Shapes are in one array, their edges in another one, and a
shape names its slice of the edges. Coordinates are relative to the position of the body.
"""

from typing import Any, TypeAlias

import numpy as np

from ..kernels.layouts import record_dtype

# The kinds of colliders, in the order of the dispatch table.
PARTICLE = 0
HALF_PLANE = 1
AXIS_ALIGNED_HALF_PLANE = 2
AXIS_ALIGNED_RECTANGLE = 3
RECTANGLE = 4
CONVEX = 5
KINDS = 6

# One collider. `lower` and `upper` are its bounding box, infinite for an unbounded region.
Shape = record_dtype(
    [
        ("kind", np.int64),
        ("first", np.int64),  # index of its first edge; edges run counterclockwise
        ("count", np.int64),  # number of its edges; 0 for a disc
        ("radius", np.float64),
        ("lower_x", np.float64),
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
    ]
)

# One edge of a convex core: the core lies in `normal . p <= offset`, and the edge is the part of
# that line which belongs to the core. Its direction is the normal turned by +90 degrees. Where an
# end is missing (the edge runs to infinity there), `has_start` or `has_end` is 0, and `start` and
# `end` both name a finite point of the edge: the other end or, on a whole line, the point nearest
# to the origin.
Edge = record_dtype(
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
    ]
)

# What kernels are passed. Numba types it; to a type checker it is anything.
Shapes: TypeAlias = Any  # `Shape` [shapes]
Edges: TypeAlias = Any  # `Edge` [edges], of all shapes
ShapeRecord: TypeAlias = Any  # one `Shape`
EdgeRecord: TypeAlias = Any  # one `Edge`
