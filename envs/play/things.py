"""What there is in the game: capsules, bricks and opponents, each with its name and its picture."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..batch.batch import Batch
from ..config import Config
from ..draw.canvas import Drawn
from ..draw.frame import draw_frame
from ..draw.scenery import make_scenery
from ..draw.view import FULL_HEIGHT, FULL_WIDTH
from ..rules import (
    BOSS_HITS,
    BOSS_X,
    BOSS_Y,
    CAPSULE_LETTERS,
    CAPSULES,
    COLOURS,
    COLUMNS,
    ENEMY_KINDS,
    ENEMY_TICKS_MAX,
    GOLD,
    PADDLE_TOP,
    ROWS,
    SILVER,
    UNBREAKABLE,
)
from ..state import CIRCLING, FLYING

# Where things lie to be drawn, in the field: at the middle of a brick, away from all others.
_COLUMN, _ROW = COLUMNS // 2, 12
X, Y = _COLUMN + 0.5, 6.75
_HIDDEN = -9.0  # the x of a paddle that nobody shall see
ICON_SCALE = 40  # pixels per brick width, in a window's icon
_ICON_SIZE = 3.0  # brick widths
_ICON_Y = 3.05  # of its middle


class Thing(NamedTuple):
    """A thing of the game.

    Attributes:
        name: a word or two.
        meaning: what it does, in few words.
        put: puts it into an empty world, a `World` record.
        width, height: of its picture, in brick widths.
        x, y: the picture's middle, in the field.
    """

    name: str
    meaning: str
    put: Callable[[Any], None]
    width: float
    height: float
    x: float = X
    y: float = Y


def _put_capsule(kind: int, world: Any) -> None:
    world.capsule, world.capsule_x, world.capsule_y = kind, X, Y


def _put_brick(kind: int, world: Any) -> None:
    cell = _ROW * COLUMNS + _COLUMN
    world.kind[cell], world.brick_hits[cell] = kind, UNBREAKABLE if kind == GOLD else 2


def _put_enemy(kind: int, world: Any) -> None:
    world.enemies, world.enemy_state[0], world.enemy_kind[0] = 1, CIRCLING, kind
    world.enemy_x[0], world.enemy_y[0], world.enemy_vy[0] = X, Y, -1.0


def _put_boss(world: Any) -> None:
    world.boss_hits = BOSS_HITS
    world.shard_wait = ENEMY_TICKS_MAX


def _put_shard(world: Any) -> None:
    world.shards, world.shard_state[0], world.shard_x[0], world.shard_y[0] = 1, FLYING, X, Y


_POWERS = (
    ("catch", "fire releases a caught ball"),
    ("enlarge", "a wider paddle"),
    ("laser", "fire shoots two beams"),
    ("slow", "slower balls"),
    ("disrupt", "three balls"),
    ("break", "a gate to the next round opens"),
    ("player", "one more life"),
)
_COLOUR_NAMES = ("white", "orange", "cyan", "green", "red", "blue", "magenta", "yellow")

CAPSULE_THINGS = tuple(
    Thing(f"{CAPSULE_LETTERS[kind]} {name}", meaning, partial(_put_capsule, kind), 1.0, 0.6)
    # A capsule that somebody adds is left out until it is described above.
    for kind, (name, meaning) in zip(range(1, CAPSULES + 1), _POWERS, strict=False)
)
BRICK_THINGS = tuple(
    Thing(name, meaning, partial(_put_brick, kind), 1.0, 0.5)
    for kind, name, meaning in (
        *((kind, _COLOUR_NAMES[kind - 1], "breaks at once") for kind in range(1, COLOURS + 1)),
        (SILVER, "silver", "needs several hits"),
        (GOLD, "gold", "never breaks"),
    )
)
ENEMY_THINGS = tuple(
    Thing("enemy", "deflects the ball", partial(_put_enemy, kind), 0.9, 0.9)
    for kind in range(ENEMY_KINDS)
)
BOSS_THING = Thing("boss", f"takes {BOSS_HITS} hits", _put_boss, 3.8, 3.2, BOSS_X, BOSS_Y - 0.05)
SHARD_THING = Thing("shard", "the boss throws it, it costs a life", _put_shard, 0.5, 0.6)


def draw_things(
    things: Sequence[Thing], scale: int
) -> tuple[list[NDArray[np.uint8]], list[NDArray[np.bool_]]]:
    """Return pictures of things, and which of their pixels show the thing and not the field.

    Args:
        things: what is drawn.
        scale: pixels per brick width; from 8 on, things look as in a window.

    Returns:
        Each one's picture, uint8 [height, width, 3], and mask, bool [height, width].
    """
    studio = _Studio(scale)
    pictures, masks = [], []
    for thing in things:
        area = studio.area(thing.x, thing.y, thing.width, thing.height)
        empty = studio.draw(_put_nothing)[area].copy()
        pictures.append(studio.draw(thing.put)[area].copy())
        masks.append((pictures[-1] != empty).any(axis=2))
    return pictures, masks


def draw_icon() -> NDArray[np.uint8]:
    """Return the icon of windows and of the documentation, uint8 [height, width, 3], a square."""
    studio = _Studio(ICON_SCALE)
    return studio.draw(_put_scene)[studio.area(X, _ICON_Y, _ICON_SIZE, _ICON_SIZE)].copy()


def _put_nothing(world: Any) -> None:
    """Leave the field empty."""


def _put_scene(world: Any) -> None:
    """Put bricks into the lowest row, and a ball and the paddle below."""
    for column, kind in enumerate((8, 2, 5), _COLUMN - 1):
        cell = (ROWS - 1) * COLUMNS + column
        world.kind[cell], world.brick_hits[cell] = kind, 1
    world.paddle_x = X
    world.ball_state[0], world.ball_x[0], world.ball_y[0] = FLYING, X + 0.4, PADDLE_TOP + 1.0


class _Studio:
    """Draws one small scene after the other."""

    def __init__(self, scale: int) -> None:
        self._batch = Batch(1, Config())
        height, width = round(FULL_HEIGHT * scale), round(FULL_WIDTH * scale)
        self._scenery = make_scenery(height, width, 3)
        self._frame = np.empty((height, width, 3), np.uint8)

    def draw(self, put: Callable[[Any], None]) -> NDArray[np.uint8]:
        """Return a picture of what is put into an empty world; the next call reuses its memory."""
        worlds, rules = self._batch.worlds, self._batch.rules
        worlds[:] = np.zeros(1, worlds.dtype)
        world = worlds[0]
        world.round_number, world.paddle_x = 1, _HIDDEN
        world.paddle_half = rules["paddle_half"][0]
        world.enemy_wait = ENEMY_TICKS_MAX
        put(world)
        lines = self._frame.reshape(len(self._frame), -1)
        draw_frame(self._frame, lines, np.zeros(1, Drawn)[0], self._scenery, world, rules[0])
        return self._frame

    def area(self, x: float, y: float, width: float, height: float) -> tuple[slice, slice]:
        """Return the rows and columns of pixels of an area of the field about (x, y)."""
        view = self._scenery.views[0]
        left = round(view.left + (x - width / 2) * view.scale)
        top = round(view.bottom - (y + height / 2) * view.scale)
        rows, columns = round(height * view.scale), round(width * view.scale)
        return slice(top, top + rows), slice(left, left + columns)
