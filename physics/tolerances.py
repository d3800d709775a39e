"""Every tolerance of the engine, with its unit and its reason.

Whether two discs, boxes or a disc and a face overlap, and when they meet, is decided by comparing
floating-point numbers as they are.
"""

# Radians. Two directions closer than this count as parallel. Rotating a polygon leaves errors of
# about 1e-16 in its normals; two strips that are meant to be parallel must not become inseparable
# for that. Over a length L it hides a gap of L * 1e-12.
PARALLEL = 1e-12

# (length / time)^2. A relative velocity whose square is smaller counts as 0, because the squares of
# such small numbers lose digits to underflow. It is a speed of 1e-145.
NO_SPEED_SQUARED = 1e-290

# A fraction of the polygon's size (or of the farthest half-plane's distance from the origin). An
# edge shorter than this is a corner: rounding alone can make or unmake it.
NO_LENGTH = 1e-12

# A fraction of a point's coordinates (plus the overlap itself). A body that moved to where it
# touches may overlap by a few of the last digits, 1e-16. One that overlaps by more was put there,
# and is relaxed.
NO_DEPTH = 1e-12

# A fraction of the bodies' speeds. Bodies that approach more slowly only seem to, by the rounding
# of the bounce before.
NO_APPROACH = 1e-15

# Rounds of relaxation at the beginning of a step. In a pile where each body pushes the next one,
# each round reduces the overlaps by a constant factor; where there is no room, this limit ends it.
RELAX_ROUNDS = 64

# A fraction of the coordinates of where two bodies meet. Points closer than this count as one:
# which of two static bodies is met first there is a matter of rounding.
SAME_POINT = 1e-15
