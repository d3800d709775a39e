"""What the kernels of pairs return where there is nothing to return.

Kernels return plain tuples. These are compiled as constants.
"""

import math

# (found, normal_x, normal_y, depth, point_x, point_y): the two do not overlap.
NO_CONTACT = (False, 0.0, 0.0, 0.0, 0.0, 0.0)
# (found, normal_x, normal_y, depth): the same for algorithms that find no point.
NO_OVERLAP = (False, 0.0, 0.0, 0.0)
# (time, normal_x, normal_y): the two do not meet.
NO_IMPACT = (math.inf, 0.0, 0.0)
