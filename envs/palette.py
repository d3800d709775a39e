"""The colours of the pictures: float64 [n, 3], red, green and blue from 0 to 255.

The eight colours of bricks are steps of one ladder of brightness, about 25 of 255 apart, so that
they can be told apart in greyscale and by eyes that confuse hues.
"""

import numpy as np
from numpy.typing import NDArray

# Brightness of red, green and blue (ITU-R BT.601), the weights of most greyscale conversions.
LUMA = np.array([0.299, 0.587, 0.114])

# The bricks' rows: a body's colour at its upper and lower edge, its lit and its shaded edges; add
# the brick's kind.
BRICK = 0
BRICK_FOOT = 11
BRICK_LIT = 22
BRICK_SHADED = 33
FRAME = 44
FIELD_UPPER = 45
FIELD_LOWER = 46
PATTERN = 47
WALL_LIT = 48
WALL = 49
WALL_SHADED = 50
RIVET = 51
PADDLE_LIT = 52
PADDLE_SHADED = 53
GRIP_LIT = 54
GRIP_SHADED = 55
BALL = 56
BALL_RIM = 57
LABEL = 58
VALUE = 59
SHINE = 60
CRACK = 61

_BRICKS = [
    (0, 0, 0),  # no brick
    (241, 240, 236),  # white
    (250, 140, 40),  # orange
    (100, 222, 245),  # cyan
    (38, 190, 104),  # green
    (208, 34, 38),  # red
    (38, 52, 196),  # blue
    (202, 58, 152),  # magenta
    (252, 222, 70),  # yellow
    (178, 187, 202),  # silver
    (196, 142, 30),  # gold
]
_OTHERS = [
    (9, 9, 20),  # FRAME
    (28, 26, 58),  # FIELD_UPPER
    (12, 16, 34),  # FIELD_LOWER
    (48, 50, 96),  # PATTERN
    (186, 194, 214),  # WALL_LIT
    (108, 116, 142),  # WALL
    (48, 52, 74),  # WALL_SHADED
    (34, 37, 56),  # RIVET
    (226, 232, 242),  # PADDLE_LIT
    (98, 108, 134),  # PADDLE_SHADED
    (255, 122, 92),  # GRIP_LIT
    (158, 22, 34),  # GRIP_SHADED
    (255, 252, 240),  # BALL
    (172, 208, 255),  # BALL_RIM
    (128, 138, 176),  # LABEL
    (244, 244, 250),  # VALUE
    (255, 255, 255),  # SHINE
    (30, 32, 46),  # CRACK
]


def _palette() -> NDArray[np.float64]:
    bricks = np.array(_BRICKS, np.float64)
    foot = bricks * 0.82
    lit = bricks + (255.0 - bricks) * 0.45
    shaded = bricks * 0.55
    return np.concatenate([bricks, foot, lit, shaded, np.array(_OTHERS, np.float64)])


PALETTE = _palette()
