"""The status of the game in small pictures: a strip along the field's lower edge.

Small pictures have no score line. There the lowest two rows of cells, below the paddle, show as
bars and as bits what a player must know. Nothing else is drawn in the strip.
"""

from typing import NamedTuple

from ...physics.kernels import inlined, inner
from ..rules import IDLE_TICKS
from ..state import RulesRecord, WorldRecord
from .canvas import DrawnRecord, Lines, copy_bytes
from .palette import STATUS_BAR, STATUS_BIT
from .raster import Image, fill_rectangle
from .scenery import Scenery
from .view import make_view


class StatusPart(NamedTuple):
    """A part of the strip, which has two lines of 22 units; a unit is half a brick wide.

    Attributes:
        name: what it shows.
        line: 0 is the upper line, 1 the lower one.
        first, units: its units, from the left.
        meaning: how to read it, for the documentation.
    """

    name: str
    line: int
    first: int
    units: int
    meaning: str


_BITS = "a bright unit is 1, the highest bit is on the left"
STATUS_PARTS = (
    StatusPart("idle_clock", 0, 0, 6, "bar from the left: ticks without damage / 3600"),
    StatusPart("decision_clock", 0, 6, 6, "bar from the left: decisions / `max_decisions`"),
    StatusPart("lives", 0, 12, 4, f"lives, at most 15, in binary: {_BITS}"),
    StatusPart("round", 0, 16, 6, "the round's number, at most 63, in binary"),
    StatusPart("score", 1, 0, 22, "points / 10, at most 4,194,303, in binary"),
)
_IDLE, _DECISIONS, _LIVES, _ROUND, _SCORE = STATUS_PARTS
_IDLE_UNIT, _DECISIONS_UNIT, _LIVES_UNIT = _IDLE.first, _DECISIONS.first, _LIVES.first
_ROUND_UNIT, _SCORE_UNIT = _ROUND.first, _SCORE.first
_IDLE_UNITS, _DECISIONS_UNITS, _LIVES_UNITS = _IDLE.units, _DECISIONS.units, _LIVES.units
_ROUND_UNITS, _SCORE_UNITS = _ROUND.units, _SCORE.units


def status_layout(height: int, width: int) -> dict[str, tuple[slice, slice]]:
    """Return where a picture shows each part of the status: its rows and columns of pixels.

    Pictures with a score line have no strip: the dictionary is empty. In pictures of less than
    about 40 pixels units are narrower than a pixel or two, and some cannot be read.

    Args:
        height, width: of the picture, in pixels.
    """
    view = make_view(height, width)[0]
    if view.header:
        return {}
    return {
        part.name: (
            slice(int(view.lines[part.line]), int(view.lines[part.line + 1])),
            slice(int(view.units[part.first]), int(view.units[part.first + part.units])),
        )
        for part in STATUS_PARTS
    }


@inlined
def draw_status(
    picture: Image,
    lines: Lines,
    drawn: DrawnRecord,
    scenery: Scenery,
    world: WorldRecord,
    rules: RulesRecord,
) -> None:
    """Draw those parts of the strip again that are out of date."""
    if drawn.idle != world.idle or drawn.decisions != world.decisions:
        drawn.idle = world.idle
        drawn.decisions = world.decisions
        _clear(lines, scenery, 0, _IDLE_UNIT, _LIVES_UNIT)
        idle = min(1.0, world.idle * (1.0 / IDLE_TICKS))
        _draw_bar(picture, scenery, _IDLE_UNIT, _IDLE_UNITS, idle)
        decisions = min(1.0, world.decisions / rules.max_decisions)
        _draw_bar(picture, scenery, _DECISIONS_UNIT, _DECISIONS_UNITS, decisions)
    if drawn.lives != world.lives or drawn.header_round != world.round_number:
        drawn.lives = world.lives
        drawn.header_round = world.round_number
        _clear(lines, scenery, 0, _LIVES_UNIT, _ROUND_UNIT + _ROUND_UNITS)
        _draw_bits(picture, scenery, 0, _LIVES_UNIT, _LIVES_UNITS, world.lives)
        _draw_bits(picture, scenery, 0, _ROUND_UNIT, _ROUND_UNITS, world.round_number)
    if drawn.score != world.score:
        drawn.score = world.score
        _clear(lines, scenery, 1, _SCORE_UNIT, _SCORE_UNIT + _SCORE_UNITS)
        _draw_bits(picture, scenery, 1, _SCORE_UNIT, _SCORE_UNITS, world.score // 10)


@inner
def _clear(lines: Lines, scenery: Scenery, line: int, first: int, end: int) -> None:
    """Copy the background of some units of a line."""
    view, channels = scenery.views[0], scenery.palette.shape[1]
    left, right = view.units[first] * channels, view.units[end] * channels
    for row in range(view.lines[line], view.lines[line + 1]):
        copy_bytes(lines[row, left:right], scenery.background[row, left:right])


@inner
def _fill(
    picture: Image, scenery: Scenery, line: int, left: float, right: float, colour: int
) -> None:
    """Fill a part of a line between two columns."""
    view, rgb = scenery.views[0], scenery.palette[colour]
    top, bottom = float(view.lines[line]), float(view.lines[line + 1])
    fill_rectangle(picture, left, top, right, bottom, rgb, rgb)


@inner
def _draw_bar(picture: Image, scenery: Scenery, first: int, units: int, part: float) -> None:
    """Fill a part of the units of the upper line, from the left."""
    view = scenery.views[0]
    left, right = float(view.units[first]), float(view.units[first + units])
    _fill(picture, scenery, 0, left, left + part * (right - left), STATUS_BAR)


@inner
def _draw_bits(
    picture: Image, scenery: Scenery, line: int, first: int, units: int, value: int
) -> None:
    """Fill those units whose bits are 1 in a number; one that is too large has ones only."""
    view = scenery.views[0]
    shown = min(value, (1 << units) - 1)
    for unit in range(units):
        if (shown >> (units - 1 - unit)) & 1 == 1:
            left, right = view.units[first + unit], view.units[first + unit + 1]
            _fill(picture, scenery, line, float(left), float(right), STATUS_BIT)
