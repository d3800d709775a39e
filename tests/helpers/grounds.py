"""Grounds of tiles, level or turned as a whole, and what moves on them."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from arkanoid.physics import (
    HIT,
    AxisAlignedRectangle,
    Body,
    Collider,
    Convex,
    Particle,
    Rectangle,
    World,
)

from .bodies import DISC

Rng = np.random.Generator
KINDS = ("disc", "point", "box", "rectangle", "turned", "polygon", "keel", "spike")
# Shapes that stand on a corner, and how far down it is.
CORNERS = (
    (Particle(0), 0.0),
    (Convex([(0, -1), (0.1, 1), (-0.1, 1)]), 1.0),
    (Convex([(0, -0.5), (0.4, 0), (0, 0.5), (-0.4, 0)]), 0.5),
    (Rectangle(0.5, 0.5, math.pi / 4), 0.5 * 0.5**0.5),
)
FORMS = ("box", "rectangle", "quarter turn", "convex", "vertices")


@dataclass(frozen=True)
class Frame:
    """A scene that is drawn level, and turned as a whole by an angle."""

    angle: float = 0.0

    def turn(self, x: float, y: float) -> tuple[float, float]:
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return cos * x - sin * y, sin * x + cos * y

    def back(self, x: float, y: float) -> tuple[float, float]:
        return Frame(-self.angle).turn(x, y)

    def block(self, form: str, x: float, y: float, width: float, height: float) -> Body:
        """Return a block about (x, y), made in one of several ways."""
        place = self.turn(x, y)
        right, top = width / 2, height / 2
        corners = [(-right, -top), (right, -top), (right, top), (-right, top)]
        if form == "box" and self.angle == 0.0:
            return Body(AxisAlignedRectangle(width, height), place)
        if form == "quarter turn":
            return Body(Rectangle(height, width, self.angle + math.pi / 2), place)
        if form == "convex":
            return Body(Convex(corners, rotation=self.angle), place)
        if form == "vertices":
            return Body(Convex([self.turn(x + dx, y + dy) for dx, dy in corners]))
        return Body(Rectangle(width, height, self.angle), place)


def decimal(rng: Rng, low: float, high: float) -> float:
    """Return a number with one digit after the point, as users write them."""
    return round(float(rng.uniform(low, high)), 1)


def random_frame(rng: Rng, is_level: bool) -> Frame:
    return Frame(0.0 if is_level else float(rng.uniform(-1.2, 1.2)))


def random_mover(rng: Rng, kind: str, angle: float) -> Collider:
    """Return a shape of a bounded kind; some lie flat on the ground, some stand on a corner."""
    width, height = decimal(rng, 0.2, 1.2), decimal(rng, 0.2, 1.2)
    if kind == "disc":
        return Particle(width / 2)
    if kind == "point":
        return Particle(0)
    if kind == "spike":
        x, y = width / 2, float(rng.choice([0, height]))
        return Convex([(0, -height), (x, y), (0, 1.5 * height), (-x, y)], (), angle)
    if kind == "box":
        return AxisAlignedRectangle(width, height)
    if kind == "rectangle":
        return Rectangle(width, height, angle)
    if kind == "turned":
        return Rectangle(width, height, float(rng.uniform(-3, 3)))
    if kind == "keel":
        x, y = width / 2, height
        return Convex([(-x, 0), (x, 0), (1.4 * x, 0.4 * y), (0, y), (-1.4 * x, 0.4 * y)], (), angle)
    count = int(rng.integers(3, 8))
    angles = (np.sort(rng.uniform(0, 0.8, count)) + np.arange(count)) * math.tau / count
    points = width * np.column_stack([np.cos(angles), np.sin(angles)])
    return Convex(points.tolist(), rotation=float(rng.uniform(-3, 3)))


def drop(shape: Collider, frame: Frame) -> float:
    """Return how far a shape reaches down from its position."""
    ends = [frame.back(edge.start_x, edge.start_y)[1] for edge in shape.edges]
    return shape.rounding - min(ends, default=0.0)


# What lands on the seam of two tiles of 2 by 2, the second to the right of the first.
LANDINGS = (
    (Rectangle(1, 1, math.pi / 4), (1, 2 + math.sqrt(0.5)), (0, -1)),
    (Particle(0), (0, 2), (1, -1)),
    (Particle(0), (2, 2), (-1, -1)),
)


def run_edited(bodies: list[Body], edit: Any, others: int) -> Any:
    """Return the hits of a world that is edited before they happen, among others far away."""
    far = [Body(DISC, (100 + 3 * index, 0), (0, 1), 1) for index in range(others)]
    world = World([*bodies, *far])
    assert len(world.step(0.5)) == 0
    edit(world)
    hits = world.step(2.0)
    return hits[hits["kind"] == HIT][["time", "normal", "point", "impulse"]]
