"""The `rgb` observation: pictures, uint8 [stack * channels, height, width].

Channels come first, as a network of convolutions takes them, or last, with ``channels="last"``:
red, green and blue, or the brightness alone. Each is, bit for bit, a channel of the picture that
`render` gives for the same size. In a stack the latest picture is the last; the first picture of an
episode fills all places.

A stack is a window that slides over a longer row of pictures, by one place per step. Pictures are
moved only when it has reached the row's end.
"""

from copy import copy
from functools import lru_cache
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ...physics.kernels import kernel
from ..config import Config
from ..draw.canvas import Drawn, copy_bytes
from ..draw.frame import draw_frame
from ..draw.scenery import Scenery, make_scenery
from ..state import SharedRules, Worlds, copy_records
from .protocol import Mask, Observe

# The length of a row in stacks. A longer row reaches its end less often, and takes more memory.
STACKS_PER_ROW = 2


@kernel
def draw_pictures(
    worlds: Worlds,
    rules: SharedRules,
    mask: Any,
    sheets: Any,
    pictures: Any,
    lines: Any,
    drawn: Any,
    channel: int,
    first: int,
    newest: int,
    moved: int,
) -> None:
    """Draw a channel of the worlds of a mask into the newest places of their stacks.

    Args:
        mask: bool [n], all worlds in a step, and those that begin an episode at other times.
        sheets: the channel's `Scenery`.
        pictures: uint8 [n, places, channels, height, width, 1]; lines: the same bytes, without the
            last axis; drawn: `Drawn` records [n, places, channels].
        first, newest: the places of the stack's pictures.
        moved: how many places the stack was moved back in this step; 0 if it was not.
    """
    for index in range(worlds.shape[0]):
        if not mask[index]:
            continue
        row, shown = lines[index], drawn[index]
        if moved > 0:
            for place in range(first, newest):
                _copy_picture(row, shown, channel, place + moved, place)
        draw_frame(
            pictures[index, newest, channel],
            row[newest, channel],
            shown[newest, channel],
            sheets,
            worlds[index],
            rules[0],
        )
        if worlds[index].decisions == worlds[index].first_decision:
            for place in range(first, newest):
                _copy_picture(row, shown, channel, newest, place)


@kernel
def _copy_picture(row: Any, shown: Any, channel: int, source: int, target: int) -> None:
    """Copy a picture of a row, and what is known of it, to another place."""
    for line in range(row.shape[2]):
        copy_bytes(row[target, channel, line], row[source, channel, line])
    shown[target, channel] = shown[source, channel]


class PixelObserver:
    """`Observer` of pictures, uint8 [n, stack * channels, height, width], or the channels last.

    Attributes:
        sheets: the `Scenery` of each channel.
        stack: how many pictures an observation has; channels_last: where its channels are.
    """

    def __init__(self, config: Config, num_worlds: int) -> None:
        """Make the arrays, and draw what is the same in all pictures."""
        height, width = config.picture_size
        self.sheets = channel_sheets(height, width, config.grey)
        self.stack = config.stack
        self.channels_last = config.channels == "last"
        places = STACKS_PER_ROW * config.stack if config.stack > 1 else 1
        channels = len(self.sheets)
        self._row = np.zeros((num_worlds, places, channels, height, width), np.uint8)
        self._drawn = np.zeros((num_worlds, places, channels), Drawn)
        self._place(self.stack - 1)
        count = self.stack * channels
        # Whether Box is generic depends on Gymnasium's version.
        self.space: Any = spaces.Box(0, 255, self.observations.shape[1:], np.uint8)
        names = ("grey",) if config.grey else ("red", "green", "blue")
        self.layout = {name: slice(index, None, channels) for index, name in enumerate(names)}
        self.layout["oldest"] = slice(0, channels)
        self.layout["newest"] = slice(count - channels, count)

    def advance(self) -> None:
        """Move the stack by one place, or from the row's end to its beginning."""
        previous = self._newest
        if self.stack > 1:
            self._place(previous + 1 if previous + 1 < self._row.shape[1] else self.stack - 1)
            self._moved = max(0, previous + 1 - self._newest)

    def check(self, observations: NDArray[Any]) -> None:
        """Raise a ValueError if no world could be observed like this."""
        # Any byte is a legal pixel.

    def recall(self, observations: NDArray[Any]) -> None:
        """Go on from these pictures."""
        self.observations[:] = observations
        self._drawn["begun"] = 0

    def clone(self) -> "PixelObserver":
        """Return one that shows the same in arrays of its own."""
        clone = copy(self)
        clone._row = self._row.copy()
        clone._drawn = copy_records(self._drawn)
        clone._place(self._newest)
        return clone

    def part(self, worlds: Worlds, rules: SharedRules, share: slice) -> Observe:
        """Return what observes a share of the worlds."""
        lines, drawn = self._row[share], self._drawn[share]
        always = worlds[share], rules
        places = lines[..., np.newaxis], lines, drawn

        def observe(mask: Mask) -> None:
            window = self._newest + 1 - self.stack, self._newest, self._moved
            for channel, sheets in enumerate(self.sheets):
                draw_pictures(*always, mask, sheets, *places, channel, *window)

        return observe

    def _place(self, newest: int) -> None:
        """Let the stack's newest picture be at a place of the row."""
        self._newest = newest
        self._moved = 0
        channels = len(self.sheets)
        window = slice((newest + 1 - self.stack) * channels, (newest + 1) * channels)
        pictures = self._row.reshape(len(self._row), -1, *self._row.shape[3:])
        shown = pictures[:, window]
        self.observations: NDArray[np.uint8] = (
            np.moveaxis(shown, 1, -1) if self.channels_last else shown
        )


@lru_cache(maxsize=8)
def channel_sheets(height: int, width: int, grey: bool) -> tuple[Scenery, ...]:
    """Return the `Scenery` of each channel of pictures, as of pictures in one colour."""
    if grey:
        return (make_scenery(height, width, 1),)
    shared = make_scenery(height, width, 3)
    arrays = shared.palette, shared.background, shared.looks
    return tuple(
        Scenery(shared.views, *(_channel(array, index) for array in arrays)) for index in range(3)
    )


def _channel(array: NDArray[Any], index: int) -> NDArray[Any]:
    """Return a channel of what `Scenery` holds, of which the last axis has three."""
    channel = np.ascontiguousarray(array[..., index::3])
    # Kernels are compiled anew for arrays that may be written.
    channel.flags.writeable = False
    return channel
