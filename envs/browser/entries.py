"""The entries that a browser calls: each does one thing with the record at its address.

They call the very kernels that play, observe and draw on the processor. So the bits are the same.
The index has no meaning: a record is of one game, tick, picture, board, block, network, meeting
or sandbox.
"""

from ...physics.kernels import kernel
from ...physics.kernels.borrowed import BYTE
from ...physics.kernels.portable import Entry, array_at
from ...physics.scenes.meeting import meet_figures
from ...physics.scenes.records import Meeting, Sandbox
from ...physics.scenes.sandbox import (
    add_figure,
    begin_sandbox,
    change_figure,
    find_figures,
    look_around,
    move_figure,
    remove_figure,
    see_sandbox,
    step_sandbox,
)
from ..tensors.observing import observe_grid, observe_vector
from ..tensors.playing import play
from .boards import lay_board, plan_board, search_board
from .checksums import checksum_of
from .network import think
from .pictures import begin_picture, draw_picture, measure_picture
from .playing import (
    begin_game,
    fit_game,
    forget_game,
    hear_tick,
    note_game,
    seed_game,
    steer_game,
)
from .records import Block, Board, Game, Hearing, Network, Picture


@kernel
def seed(index: int, address: int) -> None:
    """Seed a game's random numbers."""
    seed_game(array_at(address, (1,), Game)[0])


@kernel
def reset(index: int, address: int) -> None:
    """Begin a game, or its next life."""
    begin_game(address, array_at(address, (1,), Game)[0])


@kernel
def step(index: int, address: int) -> None:
    """Play a decision with the action that the game's arrays hold."""
    play(0, array_at(address, (1,), Game)[0].arrays)


@kernel
def steer(index: int, address: int) -> None:
    """Play a decision with the game's velocity and fire."""
    steer_game(address, array_at(address, (1,), Game)[0])


@kernel
def fit(index: int, address: int) -> None:
    """Let a game's paddle be as wide as the game says."""
    fit_game(array_at(address, (1,), Game)[0])


@kernel
def forget(index: int, address: int) -> None:
    """Note that a game's state was changed from outside."""
    forget_game(array_at(address, (1,), Game)[0])


@kernel
def note(index: int, address: int) -> None:
    """Take a game's state into its checksum."""
    note_game(array_at(address, (1,), Game)[0])


@kernel
def hear(index: int, address: int) -> None:
    """Find the tones of a tick."""
    hear_tick(array_at(address, (1,), Hearing)[0])


@kernel
def vector(index: int, address: int) -> None:
    """Observe a game as a vector."""
    observe_vector(0, address, array_at(address, (1,), Game)[0].arrays)


@kernel
def grid(index: int, address: int) -> None:
    """Observe a game as a grid."""
    observe_grid(0, address, array_at(address, (1,), Game)[0].arrays)


@kernel
def measure(index: int, address: int) -> None:
    """Find out how much memory a picture takes."""
    measure_picture(array_at(address, (1,), Picture)[0])


@kernel
def begin(index: int, address: int) -> None:
    """Draw what does not change in a picture."""
    begin_picture(address, array_at(address, (1,), Picture)[0])


@kernel
def draw(index: int, address: int) -> None:
    """Draw a picture."""
    draw_picture(address, array_at(address, (1,), Picture)[0])


@kernel
def plan(index: int, address: int) -> None:
    """Find a board's recipe."""
    plan_board(array_at(address, (1,), Board)[0])


@kernel
def lay(index: int, address: int) -> None:
    """Lay the level of a board's recipe."""
    lay_board(address, array_at(address, (1,), Board)[0])


@kernel
def search(index: int, address: int) -> None:
    """Search a board for bricks that no ball can reach."""
    search_board(array_at(address, (1,), Board)[0])


@kernel
def add(index: int, address: int) -> None:
    """Take a block's bytes into its checksum."""
    block = array_at(address, (1,), Block)[0]
    block.checksum = checksum_of(array_at(block.address, (block.length,), BYTE), block.checksum)


@kernel
def judge(index: int, address: int) -> None:
    """Let a network judge what it observes."""
    think(array_at(address, (1,), Network)[0])


@kernel
def meet(index: int, address: int) -> None:
    """Find all that the engine says of two bodies."""
    meet_figures(address, array_at(address, (1,), Meeting)[0])


@kernel
def begin_world(index: int, address: int) -> None:
    """Empty a world to throw things in."""
    begin_sandbox(array_at(address, (1,), Sandbox)[0])


@kernel
def add_body(index: int, address: int) -> None:
    """Throw a body in."""
    add_figure(array_at(address, (1,), Sandbox)[0])


@kernel
def remove_body(index: int, address: int) -> None:
    """Remove a body."""
    remove_figure(array_at(address, (1,), Sandbox)[0])


@kernel
def move_body(index: int, address: int) -> None:
    """Put a body somewhere, with another velocity."""
    move_figure(array_at(address, (1,), Sandbox)[0])


@kernel
def change_body(index: int, address: int) -> None:
    """Change what a body is."""
    change_figure(array_at(address, (1,), Sandbox)[0])


@kernel
def step_world(index: int, address: int) -> None:
    """Step a world."""
    step_sandbox(array_at(address, (1,), Sandbox)[0])


@kernel
def see_world(index: int, address: int) -> None:
    """Find all bodies, and their energy and momentum."""
    see_sandbox(array_at(address, (1,), Sandbox)[0])


@kernel
def find_bodies(index: int, address: int) -> None:
    """Find the bodies at a place."""
    find_figures(array_at(address, (1,), Sandbox)[0])


@kernel
def cast_rays(index: int, address: int) -> None:
    """Find what rays in all directions meet."""
    look_around(array_at(address, (1,), Sandbox)[0])


_NAMES = (
    *("seed", "reset", "step", "steer", "fit", "forget", "note", "hear"),
    *("vector", "grid"),
    *("measure", "begin", "draw", "plan", "lay", "search", "add", "judge"),
    "meet",
    *("begin_world", "add_body", "remove_body", "move_body", "change_body"),
    *("step_world", "see_world", "find_bodies", "cast_rays"),
)
ENTRIES = tuple(Entry(__name__, name) for name in _NAMES)
