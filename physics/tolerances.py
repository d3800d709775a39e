"""Every tolerance of the engine, with its unit and its reason."""

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

# A fraction of the coordinates of two bodies and of their sizes, along an axis: 4096 roundings of
# these numbers. Up to this gap, and up to this overlap, the two touch. Finding the gap takes about
# 16 roundings, and each step in which a body slides down a slope adds one. A body that is deeper
# was put there, and is relaxed.
TOUCH = 2.0**-41

# A fraction of the bodies' speeds. Bodies that approach more slowly only seem to, by the rounding
# of the bounce before. Over a way L they come closer by L * 1e-15.
NO_APPROACH = 1e-15

# Rounds of relaxation at the beginning of a step. In a pile where each body pushes the next one,
# each round reduces the overlaps by a constant factor; where there is no room, this limit ends it.
RELAX_ROUNDS = 64

# A fraction of the coordinates of where two bodies meet. Points closer than this count as one:
# which of two static bodies is met first there is a matter of rounding.
SAME_POINT = 1e-15
