"""The help card: a picture over the game that says what its things are, and what the keys do."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..config import Config
from ..draw.overlay import write_line
from ..draw.palette import LABEL, VALUE, WALL_LIT
from ..draw.view import FULL_HEIGHT
from .things import BRICK_THINGS, CAPSULE_THINGS, ENEMY_THINGS, SHARD_THING, Thing, draw_things

# Lengths in brick widths, from the picture's upper left corner.
_TOP = 0.45
_TITLE = 0.6  # the height of letters
_HEADING, _TEXT = 0.34, 0.3
_ROW = 0.66  # from one row to the next
_ICON_X = 1.0  # the middle of a row's first picture
_ICON_STEP = 0.95  # from one picture to the next
_TEXT_X = 2.0  # where a row's text begins, if it has one picture
_DIMMING = 7  # the game's pixels are divided by this

_METAL = 2  # of the kinds of bricks, the last ones


class _Row(NamedTuple):
    things: Sequence[Thing]
    text: str


class Card:
    """The help card of a game.

    Args:
        config: of the game; what it lacks is left out.
        keys: what the keys do, line by line.
        height: of the pictures, in pixels.
    """

    def __init__(self, config: Config, keys: Sequence[str], height: int) -> None:
        self._scale = height / FULL_HEIGHT
        self._sections = _sections(config)
        self._keys = keys
        things = [thing for rows in self._sections.values() for row in rows for thing in row.things]
        pictures = draw_things(things, max(1, round(self._scale)))
        self._pictures = list(zip(*pictures, strict=True))

    def draw(self, picture: NDArray[np.uint8]) -> None:
        """Draw the card over a picture, uint8 [height, width, 3]."""
        picture //= _DIMMING
        write_line(picture, "WHAT IS WHAT", _TOP, _TITLE, VALUE)
        top = _TOP + _TITLE + 0.35
        pictures = iter(self._pictures)
        for heading, rows in self._sections.items():
            write_line(picture, heading, top, _HEADING, LABEL, left=_ICON_X - 0.5)
            top += _HEADING + 0.2
            for row in rows:
                for index, _ in enumerate(row.things):
                    icon, mask = next(pictures)
                    self._place(picture, icon, mask, _ICON_X + index * _ICON_STEP, top + _ROW / 2)
                left = _TEXT_X + (len(row.things) - 1) * _ICON_STEP
                write_line(picture, row.text, top + (_ROW - _TEXT) / 2, _TEXT, WALL_LIT, left=left)
                top += _ROW
            top += 0.2
        for line in self._keys:
            write_line(picture, line, top, _TEXT, VALUE)
            top += _TEXT + 0.22

    def _place(
        self,
        picture: NDArray[np.uint8],
        icon: NDArray[np.uint8],
        mask: NDArray[np.bool_],
        x: float,
        y: float,
    ) -> None:
        """Copy a thing's pixels, centred on (x, y) in brick widths."""
        height, width = mask.shape
        top = round(y * self._scale - height / 2)
        left = round(x * self._scale - width / 2)
        target = picture[top : top + height, left : left + width]
        target[mask] = icon[mask]


def _sections(config: Config) -> dict[str, list[_Row]]:
    """Return what the card shows: headings, and the rows below each."""
    colours, silver, gold = BRICK_THINGS[0], *BRICK_THINGS[-_METAL:]
    coloured = _Row(BRICK_THINGS[1:8:3], f"colours: {colours.meaning}")
    sections = {}
    if config.capsules:
        sections["CAPSULES: CATCH THEM"] = [
            _Row((thing,), f"{thing.name[2:]}: {thing.meaning}") for thing in CAPSULE_THINGS
        ]
    sections["BRICKS"] = [
        coloured,
        _Row((silver,), f"{silver.name}: {silver.meaning}"),
        _Row((gold,), f"{gold.name}: {gold.meaning}"),
    ]
    if config.enemies:
        sections["ENEMIES AND THE BOSS"] = [
            _Row(ENEMY_THINGS, ENEMY_THINGS[0].meaning),
            _Row((SHARD_THING,), SHARD_THING.meaning),
        ]
    return sections
