"""This project's engine as a sandbox."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from arkanoid.physics import AxisAlignedRectangle, Body, Particle, World

from .sandbox import STEP, Pair


class ArkanoidSandbox:
    """The engine knows no gravity: a game writes it into the velocities."""

    def __init__(self, gravity: float = 0.0, restitution: float = 1.0) -> None:
        self.world = World()
        self.fall = gravity * STEP
        self.restitution = restitution
        self.crates: list[Any] = []

    def _add(self, collider: Any, position: Pair, velocity: Pair, mass: float | None) -> Any:
        return self.world.add(Body(collider, position, velocity, mass, self.restitution))

    def disc(self, position: Pair, velocity: Pair, radius: float) -> Any:
        return self._add(Particle(radius), position, velocity, 1.0)

    def crate(self, position: Pair, velocity: Pair, size: Pair) -> Any:
        self.crates.append(self._add(AxisAlignedRectangle(*size), position, velocity, 1.0))
        return self.crates[-1]

    def tile(self, position: Pair, size: Pair) -> Any:
        return self._add(AxisAlignedRectangle(*size), position, (0.0, 0.0), None)

    def remove(self, handle: Any) -> None:
        self.world.remove(handle)
        if handle in self.crates:
            self.crates.remove(handle)

    def position(self, handle: Any) -> Pair:
        return tuple(self.world.position(handle).tolist())

    def velocity(self, handle: Any) -> Pair:
        return tuple(self.world.velocity(handle).tolist())

    def push(self, handle: Any, velocity: Pair) -> None:
        self.world.place(handle, velocity=velocity)

    def step(self) -> None:
        if self.fall:
            speeds = self.world.velocity(self.crates)
            speeds[:, 1] -= self.fall
            self.world.place(self.crates, velocity=speeds)
        self.world.step(STEP)

    def rays(self, rays: Sequence[tuple[Pair, Pair]]) -> list[float]:
        starts, ends = np.array(rays).swapaxes(0, 1)
        fractions: list[float] = self.world.query_rays(starts, ends).fractions.tolist()
        return fractions


SANDBOX = ArkanoidSandbox
