"""The scenes: equal discs among boxes, in a room. Every engine builds the same ones."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

BALL = 1 / 8  # radius of the game's ball, in widths of a brick
BALL_SPEED = 0.176  # units a tick
FIELD = (11.0, 14.0)
THICK = 10.0  # units: walls of a room as a peer builds them, so that nothing is soon behind them


class Scene(NamedTuple):
    """What there is at the start. One step is one unit of time; all bounces are elastic.

    positions: float64 [n, 2], the centres of the discs.
    velocities: float64 [n, 2], units a step.
    radius: of every disc; each has mass 1.
    boxes: (x, y, width, height) each, static, (x, y) being the centre.
    room: (width, height) of the rectangle from (0, 0) that the discs are in; None: no walls.
    """

    positions: FloatArray
    velocities: FloatArray
    radius: float
    boxes: tuple[tuple[float, float, float, float], ...] = ()
    room: tuple[float, float] | None = None

    @property
    def speed(self) -> float:
        """The speed of the fastest disc, units a step."""
        return float(np.hypot(*self.velocities.T).max())

    def thick_walls(self) -> tuple[tuple[float, float, float, float], ...]:
        """The walls of the room as boxes (x, y, width, height) that close its corners too."""
        if self.room is None:
            return ()
        width, height = self.room
        thick = max(THICK, 10 * self.speed)
        return (
            (-thick / 2, height / 2, thick, height + 2 * thick),
            (width + thick / 2, height / 2, thick, height + 2 * thick),
            (width / 2, -thick / 2, width, thick),
            (width / 2, height + thick / 2, width, thick),
        )

    def lost(self, positions: FloatArray) -> int:
        """Return how many of the discs are no longer in the room."""
        inside = ((positions >= 0) & (positions <= self.room)).all(axis=1)  # NaN is not inside
        return int((~inside).sum())


def breakout(heading: float) -> Scene:
    """The game's ball at its base speed; ten by ten bricks at the left wall leave a channel.

    heading: of the ball, radians from the vertical.
    """
    direction = np.array([[math.sin(heading), math.cos(heading)]])
    return Scene(
        positions=np.array([[5.5, 3.0]]),
        velocities=BALL_SPEED * direction,
        radius=BALL,
        boxes=tuple(
            (column + 0.5, 12.75 - row / 2, 1.0, 0.5) for row in range(10) for column in range(10)
        ),
        room=FIELD,
    )


def headings(count: int) -> FloatArray:
    """Return headings, radians: 20 to 70 degrees from the vertical, to both sides in turn."""
    return np.radians(np.linspace(20, 70, count)) * np.where(np.arange(count) % 2, -1, 1)


def billiards(count: int = 1000, packing: float = 0.22, path: float = 0.1) -> Scene:
    """Discs that fill a share ``packing`` of a square room, all equally fast.

    path: what a disc moves in a step, in radii.
    """
    rng = np.random.default_rng(0)
    radius = 0.5
    side = math.sqrt(count * math.pi * radius**2 / packing)
    columns = math.ceil(math.sqrt(count))
    cell = side / columns
    cells = rng.permutation(np.stack(np.divmod(np.arange(columns**2), columns), axis=1))[:count]
    jitter = rng.uniform(-0.9, 0.9, (count, 2)) * (cell / 2 - radius)  # of them none overlap
    angle = rng.uniform(0, 2 * math.pi, count)
    return Scene(
        positions=(cells + 0.5) * cell + jitter,
        velocities=path * radius * np.stack([np.cos(angle), np.sin(angle)], axis=1),
        radius=radius,
        room=(side, side),
    )


def volley(count: int = 200) -> Scene:
    """Balls in lanes of their own, from 1 to 50 units a step fast, before a wall at x = 0."""
    rng = np.random.default_rng(0)
    speeds = np.linspace(1.0, 50.0, count)
    return Scene(
        positions=np.stack([-rng.uniform(1, 20, count), np.arange(count)], axis=1).astype(float),
        velocities=np.stack([speeds, np.zeros(count)], axis=1),
        radius=BALL,
        boxes=((0.0, count / 2, 0.5, count + 10.0),),
    )


def reflected(scene: Scene, steps: int) -> FloatArray:
    """Return where the balls of a volley are after some steps: x of each, in closed form."""
    surface = -scene.boxes[0][2] / 2 - scene.radius
    flown = scene.positions[:, 0] + steps * scene.velocities[:, 0]
    return np.where(flown > surface, 2 * surface - flown, flown)


CORRIDOR = 9.6  # units that a ball's centre has from wall to wall


def corridor(speed: float) -> Scene:
    """One ball, in the middle between two walls that it flies to and fro between."""
    width = CORRIDOR + 2 * BALL
    return Scene(
        positions=np.array([[width / 2, width / 2]]),
        velocities=np.array([[speed, 0.0]]),
        radius=BALL,
        room=(width, width),
    )


def bounces_due(speed: float, steps: int) -> int:
    """Return how many bounces the ball of a corridor has made after some steps."""
    return math.floor((CORRIDOR / 2 + speed * steps) / CORRIDOR)
