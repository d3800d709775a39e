"""Box2D 2.3 as a sandbox, through pybox2d; with the iterations of its manual."""

import math
from collections.abc import Sequence
from typing import Any

import Box2D

from .sandbox import STEP, Pair


class Box2D2Sandbox:
    """Each body has one fixture."""

    def __init__(self, gravity: float = 0.0, restitution: float = 1.0) -> None:
        self.world = Box2D.b2World(gravity=(0, -gravity), doSleep=False)
        self.restitution = restitution

    def _dynamic(self, position: Pair, velocity: Pair) -> Any:
        return self.world.CreateDynamicBody(
            position=position, linearVelocity=velocity, fixedRotation=True, allowSleep=False
        )

    def disc(self, position: Pair, velocity: Pair, radius: float) -> Any:
        body = self._dynamic(position, velocity)
        body.CreateCircleFixture(radius=radius, density=1, friction=0, restitution=self.restitution)
        return body

    def _box(self, body: Any, size: Pair) -> Any:
        half = (size[0] / 2, size[1] / 2)
        body.CreatePolygonFixture(box=half, density=1, friction=0, restitution=self.restitution)
        return body

    def crate(self, position: Pair, velocity: Pair, size: Pair) -> Any:
        return self._box(self._dynamic(position, velocity), size)

    def tile(self, position: Pair, size: Pair) -> Any:
        return self._box(self.world.CreateStaticBody(position=position), size)

    def remove(self, handle: Any) -> None:
        self.world.DestroyBody(handle)

    def position(self, handle: Any) -> Pair:
        return tuple(handle.position)

    def velocity(self, handle: Any) -> Pair:
        return tuple(handle.linearVelocity)

    def push(self, handle: Any, velocity: Pair) -> None:
        handle.linearVelocity = velocity

    def step(self) -> None:
        self.world.Step(STEP, 8, 3)

    def rays(self, rays: Sequence[tuple[Pair, Pair]]) -> list[float]:
        fractions: list[float] = []
        for start, end in rays:
            nearest = Nearest()
            self.world.RayCast(nearest, start, end)
            fractions.append(nearest.fraction)
        return fractions


class Nearest(Box2D.b2RayCastCallback):
    """Keeps the first fixture of a ray."""

    fraction = math.inf

    def ReportFixture(self, fixture: Any, point: Any, normal: Any, fraction: float) -> float:  # noqa: N802
        self.fraction = fraction
        return fraction


SANDBOX = Box2D2Sandbox
