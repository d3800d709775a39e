"""The colours of the pictures: float64 [n, 3], red, green and blue from 0 to 255.

The brightness of the eight brick colours differs by at least 20 from one to the next, and so does
that of the seven capsules: they can be told apart in grey, and by colour-blind players. In small
pictures, where the ball is one or two pixels, nothing is as bright as the ball.
"""

import numpy as np
from numpy.typing import NDArray

from ..rules import BRICK_LETTERS, CAPSULES, ENEMY_KINDS, GOLD, POWERS, SILVER

# Brightness of red, green and blue (ITU-R BT.601), the weights of most greyscale conversions.
LUMA = np.array([0.299, 0.587, 0.114])

# Each constant is the index of a row, or of the first of several rows.
# Bricks (add the kind): the body's colour at its upper and lower edge, its lit and shaded edges.
_KINDS = len(BRICK_LETTERS)
BRICK_BODY = 0
BRICK_FOOT = BRICK_BODY + _KINDS
BRICK_LIT = BRICK_FOOT + _KINDS
BRICK_SHADED = BRICK_LIT + _KINDS
# Capsules (add the kind): body, lit edge, shaded edge, and the letter.
CAPSULE_BODY = BRICK_SHADED + _KINDS
CAPSULE_LIT = CAPSULE_BODY + CAPSULES + 1
CAPSULE_SHADED = CAPSULE_LIT + CAPSULES + 1
LETTER = CAPSULE_SHADED + CAPSULES + 1
# The paddle (add the power): its body and its ends, each at the upper and lower side.
PADDLE_LIT = LETTER + CAPSULES + 1
PADDLE_SHADED = PADDLE_LIT + POWERS + 1
GRIP_LIT = PADDLE_SHADED + POWERS + 1
GRIP_SHADED = GRIP_LIT + POWERS + 1
# Enemies (add the kind): upper and lower side, and rim.
ENEMY_LIT = GRIP_SHADED + POWERS + 1
ENEMY_SHADED = ENEMY_LIT + ENEMY_KINDS
ENEMY_RIM = ENEMY_SHADED + ENEMY_KINDS
# The boss (add the step of its damage): upper and lower side.
BOSS_STEPS = 4
BOSS_LIT = ENEMY_RIM + ENEMY_KINDS
BOSS_SHADED = BOSS_LIT + BOSS_STEPS
# One row for each of these, in the order of `_OTHERS`.
_FIRST = BOSS_SHADED + BOSS_STEPS
FRAME = _FIRST
FIELD_UPPER = _FIRST + 1
FIELD_LOWER = _FIRST + 2
PATTERN = _FIRST + 3
WALL_LIT = _FIRST + 4
WALL = _FIRST + 5
WALL_SHADED = _FIRST + 6
RIVET = _FIRST + 7
BALL = _FIRST + 8
BALL_RIM = _FIRST + 9
LABEL = _FIRST + 10
VALUE = _FIRST + 11
SHINE = _FIRST + 12
CRACK = _FIRST + 13
MUZZLE = _FIRST + 14
BEAM = _FIRST + 15
BEAM_CORE = _FIRST + 16
EYE = _FIRST + 17
PUPIL = _FIRST + 18
BOSS_RIM = _FIRST + 19
BOSS_FACE = _FIRST + 20
BOSS_BROW = _FIRST + 21
BOSS_EYE = _FIRST + 22
BOSS_GLOW = _FIRST + 23
SHARD_RIM = _FIRST + 24
SHARD = _FIRST + 25
DOOR = _FIRST + 26
SEAM = _FIRST + 27
OPENING = _FIRST + 28
LAMP = _FIRST + 29
ARROW = _FIRST + 30
STATUS = _FIRST + 31
STATUS_BAR = _FIRST + 32
STATUS_BIT = _FIRST + 33

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
_CAPSULES = [
    (0, 0, 0),  # no capsule
    (34, 176, 84),  # catch
    (52, 98, 250),  # enlarge
    (200, 22, 36),  # laser
    (255, 160, 52),  # slow
    (130, 240, 255),  # disrupt
    (236, 100, 212),  # break
    (238, 238, 240),  # player
]
_PADDLES = [
    # The body at its upper and lower side, the ends at their upper and lower side.
    [(226, 232, 242), (98, 108, 134), (255, 122, 92), (158, 22, 34)],  # no power
    [(128, 232, 150), (26, 96, 66), (236, 255, 214), (60, 140, 70)],  # catch
    [(226, 232, 242), (98, 108, 134), (120, 176, 255), (30, 52, 190)],  # enlarge
    [(124, 126, 146), (44, 44, 62), (255, 122, 92), (158, 22, 34)],  # laser
]
_ENEMIES = [
    # Upper and lower side.
    [(190, 250, 90), (70, 150, 30)],
    [(196, 140, 255), (96, 40, 200)],
    [(255, 150, 96), (196, 52, 40)],
    [(120, 246, 226), (20, 140, 150)],
]
_BOSS = [
    # Upper and lower side, from unhurt to nearly beaten.
    [(150, 140, 206), (70, 58, 124)],
    [(172, 132, 178), (92, 52, 104)],
    [(202, 122, 142), (122, 44, 78)],
    [(238, 116, 100), (156, 36, 48)],
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
    (255, 252, 240),  # BALL
    (172, 208, 255),  # BALL_RIM
    (128, 138, 176),  # LABEL
    (244, 244, 250),  # VALUE
    (255, 255, 255),  # SHINE
    (30, 32, 46),  # CRACK
    (255, 196, 120),  # MUZZLE
    (255, 84, 72),  # BEAM
    (255, 240, 204),  # BEAM_CORE
    (250, 252, 255),  # EYE
    (14, 12, 26),  # PUPIL
    (104, 92, 150),  # BOSS_RIM
    (44, 34, 78),  # BOSS_FACE
    (96, 84, 148),  # BOSS_BROW
    (255, 226, 110),  # BOSS_EYE
    (255, 140, 60),  # BOSS_GLOW
    (204, 62, 40),  # SHARD_RIM
    (255, 206, 120),  # SHARD
    (78, 84, 108),  # DOOR
    (30, 32, 48),  # SEAM
    (4, 4, 10),  # OPENING
    (255, 206, 96),  # LAMP
    (255, 120, 220),  # ARROW
    (4, 4, 10),  # STATUS
    (214, 150, 80),  # STATUS_BAR
    (130, 200, 226),  # STATUS_BIT
]

# A capsule's letter is white, or dark if the body is brighter than this.
_BRIGHT = 140.0


def _palette() -> NDArray[np.float64]:
    bricks = np.array(_BRICKS, np.float64)
    capsules = np.array(_CAPSULES, np.float64)
    paddles = np.array(_PADDLES, np.float64)
    enemies = np.array(_ENEMIES, np.float64)
    boss = np.array(_BOSS, np.float64)
    bright = (capsules @ LUMA > _BRIGHT)[:, np.newaxis]
    return np.concatenate(
        [
            bricks,
            bricks * 0.82,
            bricks + (255.0 - bricks) * 0.45,
            bricks * 0.55,
            capsules,
            capsules + (255.0 - capsules) * 0.5,
            capsules * 0.5,
            np.where(bright, (24.0, 24.0, 40.0), (255.0, 255.0, 255.0)),
            *paddles.transpose(1, 0, 2),
            *enemies.transpose(1, 0, 2),
            enemies[:, 1] * 0.65,
            *boss.transpose(1, 0, 2),
            np.array(_OTHERS, np.float64),
        ]
    )


PALETTE = _palette()
# In small pictures everything is darker by this factor, except the ball, which is white.
DIMMING = 0.88
# There silver is the brightest kind of brick and gold the darkest: their bands of light and shadow
# are too narrow to tell them from the eight colours in grey.
_SMALL_METALS = {
    # The body's colour at its upper and lower edge, its lit and shaded edges.
    SILVER: [(244, 249, 255), (232, 240, 255), (250, 252, 255), (130, 138, 154)],
    GOLD: [(104, 62, 0), (88, 50, 0), (124, 78, 8), (44, 24, 0)],
}


def palette_for(small: bool, channels: int) -> NDArray[np.float64]:
    """Return the palette of pictures, float64 [n, channels].

    Args:
        small: whether they are too small for a score line.
        channels: 3 for red, green and blue, 1 for grey.
    """
    palette = PALETTE.copy()
    if small:
        for kind, colours in _SMALL_METALS.items():
            rows = [first + kind for first in (BRICK_BODY, BRICK_FOOT, BRICK_LIT, BRICK_SHADED)]
            palette[rows] = colours
        palette *= DIMMING
        palette[BALL] = 255.0
    if channels == 3:
        return palette
    # No product of matrices: its rounding may differ from machine to machine.
    return np.asarray((palette * LUMA).sum(axis=1, keepdims=True))
