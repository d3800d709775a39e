"""Every tolerance of the engine, with its unit and its reason.

Detection, contacts and times of impact use none: they compare floating-point numbers as they are.
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
