"""What tests of the game do with a world's record."""

import numpy as np
from arkanoid.envs.state import FLYING
from shapely import box, union_all


def keep_ball_flying(world):
    """Keep the ball in flight, almost on the spot, where it hits nothing."""
    world.ball_state[0] = FLYING
    world.ball_x[0], world.ball_y[0] = 0.5, 3.0
    world.ball_vx[0], world.ball_vy[0] = 0.0, 1e-9


def union_of_bricks(world):
    """Return the union of the world's bricks."""
    cells = [divmod(int(cell), 11) for cell in np.flatnonzero(world.brick_hits)]
    return union_all([box(c, 12.5 - r / 2, c + 1, 13 - r / 2) for r, c in cells])
