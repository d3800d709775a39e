"""The entries that play decisions in worlds, and write what came of them.

They call the very kernels that step and observe the batches of the processor, with arrays that hold
one world. So the bits are the same. A step of all worlds is a few runs of entries, one after the
other, see `STEPS`.
"""

from typing import NamedTuple

from ...physics.kernels import kernel
from ...physics.kernels.portable import Entry, array_at
from .arrays import Arrays
from .observing import draw_canvas, observe_grid, observe_vector
from .pictures import fill_pictures, slide_pictures
from .playing import begin_again, keep_number, play, report


@kernel
def step_vector(index: int, address: int) -> None:
    """Play a decision in a world that is seen as a vector."""
    arrays = array_at(address, (1,), Arrays)[0]
    played = play(index, arrays)
    if played:
        observe_vector(index, address, arrays)
    report(index, arrays, played)


@kernel
def again_vector(index: int, address: int) -> None:
    """Begin the next episode of a world that is seen as a vector, if one has ended."""
    arrays = array_at(address, (1,), Arrays)[0]
    if begin_again(index, address, arrays):
        observe_vector(index, address, arrays)


@kernel
def keep_vectors(index: int, address: int) -> None:
    """Keep a number of a vector, if it is an episode's last one."""
    arrays = array_at(address, (1,), Arrays)[0]
    keep_number(index, arrays, arrays.vectors, arrays.final_vectors, arrays.vector_size)


@kernel
def step_grid(index: int, address: int) -> None:
    """Play a decision in a world that is seen as a grid."""
    arrays = array_at(address, (1,), Arrays)[0]
    played = play(index, arrays)
    if played:
        observe_grid(index, address, arrays)
    report(index, arrays, played)


@kernel
def again_grid(index: int, address: int) -> None:
    """Begin the next episode of a world that is seen as a grid, if one has ended."""
    arrays = array_at(address, (1,), Arrays)[0]
    if begin_again(index, address, arrays):
        observe_grid(index, address, arrays)


@kernel
def keep_grids(index: int, address: int) -> None:
    """Keep a number of a grid, if it is an episode's last one."""
    arrays = array_at(address, (1,), Arrays)[0]
    keep_number(index, arrays, arrays.grids, arrays.final_grids, arrays.grid_size)


@kernel
def step_rgb(index: int, address: int) -> None:
    """Play a decision in a world that is seen as pictures."""
    arrays = array_at(address, (1,), Arrays)[0]
    played = play(index, arrays)
    if played:
        draw_canvas(index, address, arrays)
    report(index, arrays, played)


@kernel
def again_rgb(index: int, address: int) -> None:
    """Begin the next episode of a world that is seen as pictures, if one has ended."""
    arrays = array_at(address, (1,), Arrays)[0]
    if begin_again(index, address, arrays):
        draw_canvas(index, address, arrays)


@kernel
def slide(index: int, address: int) -> None:
    """Move a word of a world's pictures by one place, and put the newest one behind them."""
    slide_pictures(index, array_at(address, (1,), Arrays)[0])


@kernel
def fill(index: int, address: int) -> None:
    """Fill all places with the first picture of an episode, word by word."""
    fill_pictures(index, array_at(address, (1,), Arrays)[0])


@kernel
def step_dict(index: int, address: int) -> None:
    """Play a decision in a world that is seen as pictures and as a vector."""
    arrays = array_at(address, (1,), Arrays)[0]
    played = play(index, arrays)
    if played:
        draw_canvas(index, address, arrays)
        observe_vector(index, address, arrays)
    report(index, arrays, played)


@kernel
def again_dict(index: int, address: int) -> None:
    """Begin the next episode of a world that is seen as both, if one has ended."""
    arrays = array_at(address, (1,), Arrays)[0]
    if begin_again(index, address, arrays):
        draw_canvas(index, address, arrays)
        observe_vector(index, address, arrays)


class Run(NamedTuple):
    """A run of an entry.

    Attributes:
        entry: what runs.
        items: for each world, each number of its ``"vector"`` or ``"grid"``, or each word of a
            ``"picture"``.
        same_step: whether it is needed in same-step mode only.
    """

    entry: Entry
    items: str
    same_step: bool = False


def _entry(name: str) -> Entry:
    return Entry(__name__, name)


_KEEP_VECTORS = Run(_entry("keep_vectors"), "vector", same_step=True)
_SLIDE = Run(_entry("slide"), "picture")
_FILL = Run(_entry("fill"), "picture", same_step=True)


def _around(kind: str, *between: Run) -> tuple[Run, ...]:
    """Return the runs that play and begin again, and others between them."""
    return (
        Run(_entry(f"step_{kind}"), "world"),
        *between,
        Run(_entry(f"again_{kind}"), "world", same_step=True),
    )


# A step of all worlds, by the kind of observation.
STEPS = {
    "vector": _around("vector", _KEEP_VECTORS),
    "grid": _around("grid", Run(_entry("keep_grids"), "grid", same_step=True)),
    "rgb": (*_around("rgb", _SLIDE), _FILL),
    "dict": (*_around("dict", _SLIDE, _KEEP_VECTORS), _FILL),
}
