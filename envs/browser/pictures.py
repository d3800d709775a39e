"""Pictures of any size, in memory that their user gives them."""

from typing import Any

from ...physics.kernels import inlined, kernel
from ...physics.kernels.borrowed import BYTE
from ...physics.kernels.portable import array_at
from ..draw.canvas import Drawn
from ..draw.frame import draw_frame
from ..draw.scenery import LOOKS, Scenery, draw_scenery, lattice_size
from ..draw.view import View, lay_view
from ..game.rulebook import Rules
from ..state import World
from ..tensors.playing import FLOAT64
from .records import Picture

_PLACE = int(Picture.fields["place"][1])  # type: ignore[index]
_DRAWN = int(Picture.fields["drawn"][1])  # type: ignore[index]
_WORD = 8  # bytes


@inlined
def _in_words(size: int) -> int:
    """Return a size in bytes, rounded up to whole words."""
    return (size + _WORD - 1) // _WORD * _WORD


@kernel
def measure_picture(picture: Any) -> None:
    """Write where the field lies, and how much memory the picture takes."""
    lay_view(picture.place, picture.height, picture.width)
    rows, columns = lattice_size(picture.place)
    pixels = _in_words(picture.height * picture.width * picture.channels)
    picture.length = 2 * pixels + LOOKS * rows * columns * picture.channels


@kernel
def begin_picture(address: int, picture: Any) -> None:
    """Draw what does not change, into a measured picture's memory."""
    height, width, channels = picture.height, picture.width, picture.channels
    rows, columns = lattice_size(picture.place)
    first = picture.memory + _in_words(height * width * channels)
    draw_scenery(
        array_at(first, (height, width, channels), BYTE),
        array_at(_looks(picture), (LOOKS, rows, columns, channels), BYTE),
        array_at(address + _PLACE, (1,), View),
        array_at(_palette(picture), (picture.num_colours, channels), FLOAT64),
    )
    picture.drawn.begun = 0


@kernel
def draw_picture(address: int, picture: Any) -> None:
    """Let the pixels show the game as it is."""
    height, width, channels = picture.height, picture.width, picture.channels
    rows, columns = lattice_size(picture.place)
    first = picture.memory + _in_words(height * width * channels)
    scenery = Scenery(
        array_at(address + _PLACE, (1,), View),
        array_at(_palette(picture), (picture.num_colours, channels), FLOAT64),
        array_at(first, (height, width * channels), BYTE),
        array_at(_looks(picture), (LOOKS, rows, columns * channels), BYTE),
    )
    draw_frame(
        array_at(picture.memory, (height, width, channels), BYTE),
        array_at(picture.memory, (height, width * channels), BYTE),
        array_at(address + _DRAWN, (1,), Drawn)[0],
        scenery,
        array_at(picture.worlds, (1,), World)[0],
        array_at(picture.rules, (1,), Rules)[0],
    )


@inlined
def _looks(picture: Any) -> int:
    """Return where the looks of bricks lie: behind pixels and background."""
    pixels = _in_words(picture.height * picture.width * picture.channels)
    return int(picture.memory + 2 * pixels)


@inlined
def _palette(picture: Any) -> int:
    """Return where the palette lies."""
    return int(picture.palettes[1 - picture.place.header, picture.channels])
