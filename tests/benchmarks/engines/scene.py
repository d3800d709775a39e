"""The scenes: equal discs among boxes, in a room. Every engine builds the same scenes."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

BALL = 1 / 8  # radius of the game's ball, in widths of a brick
BALL_SPEED = 0.176  # units per tick
FIELD = (11.0, 14.0)
THICK = 10.0  # units: of the walls that peers build, so that no disc gets behind them soon


class Scene(NamedTuple):
    """What is there at the start. One step is one unit of time; all bounces are elastic.

    positions: float64 [n, 2], the centres of the discs.
    velocities: float64 [n, 2], units per step.
    radius: of every disc; each has mass 1.
    boxes: (x, y, width, height) of every static box; (x, y) is its centre.
    room: (width, height) of the rectangle from (0, 0) that holds the discs; None: no walls.
    """

    positions: FloatArray
    velocities: FloatArray
    radius: float
    boxes: tuple[tuple[float, float, float, float], ...] = ()
    room: tuple[float, float] | None = None

    @property
    def speed(self) -> float:
        """The speed of the fastest disc, units per step."""
        return float(np.hypot(*self.velocities.T).max())

    def thick_walls(self) -> tuple[tuple[float, float, float, float], ...]:
        """Return the walls as boxes (x, y, width, height), which close the corners, too."""
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
    """Return the game's ball at its base speed, and ten by ten bricks beside a channel.

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
    """Return headings in radians: 20 to 70 degrees from the vertical, on alternating sides."""
    return np.radians(np.linspace(20, 70, count)) * np.where(np.arange(count) % 2, -1, 1)


def billiards(count: int = 1000, packing: float = 0.22, path: float = 0.1) -> Scene:
    """Return equally fast discs that fill the share ``packing`` of a square room.

    path: radii that a disc moves per step.
    """
    rng = np.random.default_rng(0)
    radius = 0.5
    side = math.sqrt(count * math.pi * radius**2 / packing)
    columns = math.ceil(math.sqrt(count))
    cell = side / columns
    cells = rng.permutation(np.stack(np.divmod(np.arange(columns**2), columns), axis=1))[:count]
    jitter = rng.uniform(-0.9, 0.9, (count, 2)) * (cell / 2 - radius)  # no two overlap
    angle = rng.uniform(0, 2 * math.pi, count)
    return Scene(
        positions=(cells + 0.5) * cell + jitter,
        velocities=path * radius * np.stack([np.cos(angle), np.sin(angle)], axis=1),
        radius=radius,
        room=(side, side),
    )


def volley(count: int = 200) -> Scene:
    """Return balls in separate lanes, with 1 to 50 units per step, before a wall at x = 0."""
    rng = np.random.default_rng(0)
    speeds = np.linspace(1.0, 50.0, count)
    return Scene(
        positions=np.stack([-rng.uniform(1, 20, count), np.arange(count)], axis=1).astype(float),
        velocities=np.stack([speeds, np.zeros(count)], axis=1),
        radius=BALL,
        boxes=((0.0, count / 2, 0.5, count + 10.0),),
    )


def reflected(scene: Scene, steps: int) -> FloatArray:
    """Return x of each ball of a volley after some steps, in closed form."""
    surface = -scene.boxes[0][2] / 2 - scene.radius
    flown = scene.positions[:, 0] + steps * scene.velocities[:, 0]
    return np.where(flown > surface, 2 * surface - flown, flown)


CORRIDOR = 9.6  # units that a ball's centre moves from wall to wall


def corridor(speed: float) -> Scene:
    """Return one ball that flies to and fro between two walls, and starts in the middle."""
    width = CORRIDOR + 2 * BALL
    return Scene(
        positions=np.array([[width / 2, width / 2]]),
        velocities=np.array([[speed, 0.0]]),
        radius=BALL,
        room=(width, width),
    )


def bounces_due(speed: float, steps: int) -> int:
    """Return how many bounces the ball of a corridor makes in some steps."""
    return math.floor((CORRIDOR / 2 + speed * steps) / CORRIDOR)
