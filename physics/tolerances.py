"""Every tolerance of the engine, with its unit and its reason.

Whether two discs, boxes or a disc and a face overlap, and when they meet, is decided by comparing
floating-point numbers as they are.
"""

# Radians. Two directions closer than this count as parallel. Turning a polygon leaves errors of
# some 1e-16 in its normals, and two strips meant to be parallel must not become inseparable (the
# regions of a wedge 1e-16 wide) for that. Over a length L it hides a gap of L * 1e-12.
PARALLEL = 1e-12

# (length / time)^2. A relative velocity whose square is less counts as rest: squares of still
# smaller numbers lose their digits to underflow. It is a speed of 1e-145.
REST = 1e-290

# A fraction of the polygon's size (or of the farthest half-plane's distance from the origin). An
# edge shorter than this is a corner: rounding alone can make or unmake it.
NO_LENGTH = 1e-12

# A fraction of a place's coordinates (plus the overlap itself). What flew to where it touches may
# overlap by a few of the last digits, 1e-16; what overlaps by more was put there, and is relaxed.
NO_DEPTH = 1e-12

# A fraction of the bodies' speeds. What approaches more slowly than that only seems to, by the
# rounding of the bounce before, and has been stopped already.
NO_APPROACH = 1e-15

# Rounds of relaxation at the beginning of a step. A pile in which each body pushes the next one
# settles by a constant factor a round; this is for what has room, and ends where there is none.
RELAX_ROUNDS = 64

# A fraction of the coordinates of where two bodies meet. Places closer than that are one: so close,
# which of two static bodies is met first is a matter of rounding.
SAME_PLACE = 1e-15
