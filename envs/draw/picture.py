"""A picture of a world, as a fresh array."""

import numpy as np
from numpy.typing import NDArray

from ..checks import check_integer
from ..config import MAX_SIZE
from ..state import SharedRules, Worlds
from .canvas import Drawn
from .frame import draw_frame
from .scenery import make_scenery
from .view import FULL_HEIGHT, FULL_WIDTH

DEFAULT_HEIGHT = 512  # pixels: 32 per brick width


def draw_world(
    worlds: Worlds,
    rules: SharedRules,
    index: int,
    height: int = DEFAULT_HEIGHT,
    width: int | None = None,
    channels: int = 3,
) -> NDArray[np.uint8]:
    """Return a picture of one world of a batch, a fresh uint8 array [height, width, channels].

    The same state gives the same bits on every machine. No display is needed.

    Args:
        worlds: `World` records [n].
        rules: `Rules` [1].
        index: the world.
        height: in pixels.
        width: in pixels; None: as wide as the field with its walls.
        channels: 3 for red, green and blue, 1 for grey.

    Raises:
        TypeError: a size is no integer.
        ValueError: a size is out of range.
    """
    check_integer("height", height, 1, MAX_SIZE)
    if width is None:
        width = max(1, round(height * FULL_WIDTH / FULL_HEIGHT))
    check_integer("width", width, 1, MAX_SIZE)
    if channels not in (1, 3):
        raise ValueError(f"channels must be 1 (grey) or 3 (red, green, blue); got {channels!r}")
    frame = np.empty((int(height), int(width), int(channels)), np.uint8)
    lines = frame.reshape(frame.shape[0], -1)
    drawn = np.zeros(1, Drawn)
    draw_frame(frame, lines, drawn[0], make_scenery(*frame.shape), worlds[int(index)], rules[0])
    return frame
