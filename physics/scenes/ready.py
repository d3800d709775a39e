"""Scenes of many bodies that are ready to be looked at, and the `World` of each.

They fit into `WIDTH` x `HEIGHT` about the origin, in a room of four walls.
"""

import math
from collections.abc import Iterable, Sequence
from random import Random
from typing import Literal, NamedTuple, cast

from ..body import Body
from ..shapes.colliders import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    Particle,
    Rectangle,
)
from ..world.world import World
from .patterns import POLYGONS

WIDTH, HEIGHT = 24.0, 16.0
_DIRECTIONS = ("+y", "-x", "-y", "+x")  # of a half-plane at each quarter turn
_SIN_60 = math.sqrt(0.75)


class Thing(NamedTuple):
    """A body of a scene. Its fields are the words of an address, in their order.

    Attributes:
        collider: "Particle", "AxisAlignedHalfPlane", "AxisAlignedRectangle", "Rectangle" or
            "Convex".
        x, y, vx, vy: position and velocity.
        width: a disc's radius; how many times larger than its pattern a polygon is.
        height: of a rectangle.
        turn: counterclockwise, in degrees.
        mass: 0 for none.
        restitution: of the body.
        polygon: which one, see `POLYGONS`.
        sensor: 1: a sensor.
    """

    collider: str = "Particle"
    x: float = 0.0
    y: float = 0.0
    vx: float = 0.0
    vy: float = 0.0
    width: float = 0.5
    height: float = 1.0
    turn: int = 0
    mass: float = 1.0
    restitution: float = 1.0
    polygon: str = "trapezium"
    sensor: int = 0


class Scene(NamedTuple):
    """A scene.

    Attributes:
        title, says: what it is, and what one sees.
        things: its bodies.
        gravity: how much speed downwards its bodies gain in a unit of time, before each step.
        lamp: from where rays are sent, if they are.
    """

    title: str
    says: str
    things: Sequence[Thing]
    gravity: float = 0.0
    lamp: tuple[float, float] | None = None


def collider_of(thing: Thing) -> Collider:
    """Return the collider of a thing, as one would write it in Python."""
    angle = math.radians(thing.turn)
    if thing.collider == "AxisAlignedHalfPlane":
        direction = cast("Literal['+x', '-x', '+y', '-y']", _DIRECTIONS[thing.turn % 360 // 90])
        return AxisAlignedHalfPlane(direction)
    if thing.collider == "AxisAlignedRectangle":
        return AxisAlignedRectangle(thing.width, thing.height)
    if thing.collider == "Rectangle":
        return Rectangle(thing.width, thing.height, angle)
    if thing.collider == "Convex":
        corners = POLYGONS[thing.polygon]
        return Convex([(thing.width * x, thing.width * y) for x, y in corners], rotation=angle)
    return Particle(thing.width)


def make_world(things: Iterable[Thing]) -> World:
    """Return the world of things; the handle of each is its place in the order."""
    world = World()
    for thing in things:
        body = Body(
            collider_of(thing),
            (thing.x, thing.y),
            (thing.vx, thing.vy),
            mass=thing.mass or None,
            restitution=thing.restitution,
        )
        world.add(body, sensor=bool(thing.sensor))
    return world


def text_of(thing: Thing) -> str:
    """Return a thing as an address has it; what is usual at the end is left out."""
    words = [word if isinstance(word, str) else _number(word) for word in thing]
    usual = [word if isinstance(word, str) else _number(word) for word in Thing()]
    while len(words) > 1 and words[-1] == usual[len(words) - 1]:
        words.pop()
    return ",".join(words)


def _number(value: float) -> str:
    """Return the shortest text that is this number: JavaScript reads the same bits."""
    return str(int(value)) if value == int(value) else repr(float(value))


def room(restitution: float = 1.0, width: float = WIDTH, height: float = HEIGHT) -> list[Thing]:
    """Return four walls about the origin."""
    places = ((0.0, -height / 2, 0), (width / 2, 0.0, 90), (0.0, height / 2, 180))
    return [
        Thing("AxisAlignedHalfPlane", x, y, turn=turn, mass=0, restitution=restitution)
        for x, y, turn in (*places, (-width / 2, 0.0, 270))
    ]


def _shapes() -> list[Thing]:
    return [
        *room(),
        Thing("Particle", -7, 3, 3, 1, 1.2, mass=2),
        Thing("Particle", 0, 6.5, -1, -4, 0),
        Thing("AxisAlignedRectangle", 6, 3.5, -2, -1, 2.4, 1.6),
        Thing("Rectangle", -6, -3.5, 1, 2, 2.6, 1.4, 30),
        Thing("Convex", 0.5, -5, -1.5, 1, 1.3, polygon="pentagon"),
        Thing("Convex", 6, -4, 1, 1.5, 1.2, turn=20),
        Thing("Convex", -9.5, -1, 2, -1, 1, polygon="triangle"),
        Thing("Particle", 0, 0.5, 0, 0, 1.6, mass=0),
        Thing("Rectangle", 10, 0, width=4, height=0.6, turn=60, mass=0),
    ]


def _cradle() -> list[Thing]:
    row = [Thing("Particle", 1.6 * place, width=0.8) for place in range(-2, 3)]
    return [*room(), Thing("Particle", -8.0, 0, 6, 0, 0.8), *row]


def _three() -> list[Thing]:
    return [
        *room(),
        Thing("Particle", -8, 0, 5, 0, 1),
        Thing("Particle", 0, 1, width=1),
        Thing("Particle", 0, -1, width=1),
    ]


def _billiards() -> list[Thing]:
    """Return a table with six pockets, which notice balls, and a rack of fifteen balls."""
    pockets = [
        Thing("Particle", x, y, width=0.8, mass=0, sensor=1)
        for x in (-10.8, 0, 10.8)
        for y in (-5.4, 5.4)
    ]
    rack = [
        Thing("Particle", 3 + row * _SIN_60, place - row / 2, width=0.5, restitution=0.97)
        for row in range(5)
        for place in range(row + 1)
    ]
    cue = Thing("Particle", -7, 0.2, 18, 0, width=0.5, restitution=0.97)
    return [*room(0.9, 21.6, 10.8), *pockets, *rack, cue]


def _tiles() -> list[Thing]:
    tiles = [
        Thing("AxisAlignedRectangle", 1.5 * column, -4, width=1.5, height=1.5, mass=0)
        for column in range(-7, 8)
    ]
    return [
        *room(),
        *tiles,
        Thing("AxisAlignedRectangle", -6, -2.45, 4, 0, 1.6, 1.6, restitution=0),
        Thing("Particle", 2, 2, -2, 0, 0.7),
        Thing("Convex", 7, -2, -3, 0, 0.9, restitution=0),
    ]


def _pile() -> list[Thing]:
    crates = [
        Thing(
            *("AxisAlignedRectangle", 2 + 1.6 * (place - (6 - row) / 2), -7.2 + 1.6 * row),
            width=1.6,
            height=1.6,
            restitution=0,
        )
        for row in range(6)
        for place in range(7 - row)
    ]
    ball = Thing("Particle", -10, -2, 14, 6, 0.9, mass=4, restitution=0.5)
    return [*room(), *crates, ball]


def _pi(mass: float) -> list[Thing]:
    return [
        Thing("AxisAlignedHalfPlane", -11, 0, turn=270, mass=0),
        Thing("AxisAlignedRectangle", -7, -1.1, width=1.8, height=1.8),
        Thing("AxisAlignedRectangle", 3, 0, -1.5, 0, 4, 4, mass=mass),
    ]


def _rays() -> list[Thing]:
    return [
        *room(),
        Thing("Particle", -6, 3.5, 1, 0.6, 1.3),
        Thing("Convex", 6, 3, -0.8, 0.5, 1.6, polygon="pentagon"),
        Thing("Rectangle", 6, -4, 0.5, 0.7, 3, 1.4, 35),
        Thing("AxisAlignedRectangle", -5, -4, 0.7, -0.4, 2.6, 1.6),
        Thing("Convex", 0.5, 5, -1, -0.4, 1.2, polygon="triangle"),
        Thing("Particle", 3, 0, -0.6, 0.8, 0.5),
    ]


def _gate() -> list[Thing]:
    """Return a sensor in the middle, and discs that pass it."""
    gate = Thing("AxisAlignedRectangle", width=3, height=10, mass=0, sensor=1)
    discs = [
        Thing("Particle", -9 + 2 * place, 4 - 2 * place, 3, 0.8 * place - 1, 0.6)
        for place in range(5)
    ]
    return [*room(), gate, *discs]


def _crowd() -> list[Thing]:
    """Return a thousand discs on a lattice, each with a speed of its own."""
    luck = Random(1)
    discs = [
        Thing(
            *("Particle", round(0.58 * column - 11.31, 2), round(0.61 * row - 7.32, 2)),
            *(float(luck.randint(-30, 30)) / 10, float(luck.randint(-30, 30)) / 10),
            width=0.14,
        )
        for row in range(25)
        for column in range(40)
    ]
    return [*room(), *discs]


def _thin() -> list[Thing]:
    """Return the scene of the figure of `World` in the documentation, five times as large."""
    return [
        *room(width=20.0, height=13.0),
        Thing("AxisAlignedRectangle", 0.25, -1.5, width=0.4, height=6.5, mass=0),
        Thing("Particle", -6.25, 3, width=1.75, mass=0),
        Thing("Rectangle", 5.75, 2.75, width=4.5, height=1.5, turn=326, mass=0),
        Thing("Particle", -7.75, -4, 15, 6.75, 0.8),
    ]


SCENES: dict[str, Scene] = {
    "shapes": Scene("All shapes", "Fling them. No energy appears.", _shapes()),
    "empty": Scene("An empty room", "Throw things in.", room()),
    "cradle": Scene("Newton's cradle", "The speed passes on, ball by ball.", _cradle()),
    "three": Scene("A break of three", "Two balls are hit at once.", _three()),
    "billiards": Scene("Billiards", "The pockets are sensors.", _billiards()),
    "tiles": Scene("A box over tiles", "No seam stops it.", _tiles(), gravity=10.0),
    "pile": Scene("A pile of crates", "It stands until it is hit.", _pile(), gravity=10.0),
    "pi": Scene("Digits of π", "Count the hits: there are 314.", _pi(10_000.0)),
    "rays": Scene(
        "A fan of rays", "Drag the lamp, or take the arrow keys.", _rays(), lamp=(0.0, 0.0)
    ),
    "gate": Scene("A sensor", "It notices who enters and leaves.", _gate()),
    "world": Scene("Exact steps", "It is fast, and the wall is thin.", _thin()),
    "crowd": Scene("A crowd", "A thousand discs.", _crowd()),
}
