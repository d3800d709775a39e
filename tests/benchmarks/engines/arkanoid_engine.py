"""This project's engine."""

import numpy as np
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Particle,
    World,
    WorldBatch,
)

from .scene import FloatArray, Scene


def build(scene: Scene) -> World:
    """Return the scene's world: the discs, then the boxes, then the walls."""
    bodies = [
        Body(Particle(scene.radius), position, velocity, mass=1.0)
        for position, velocity in zip(scene.positions, scene.velocities, strict=True)
    ]
    bodies += [
        Body(AxisAlignedRectangle(width, height), (x, y)) for x, y, width, height in scene.boxes
    ]
    if scene.room is not None:
        bodies += [Body(AxisAlignedHalfPlane(direction)) for direction in ("+x", "+y")]
        bodies += [Body(AxisAlignedHalfPlane(direction), scene.room) for direction in ("-x", "-y")]
    world = World(bodies)
    world.step(0.0)  # builds the grid, which the peers build while bodies are added
    return world


class Arkanoid:
    """One world, one step per call, as the peers have it.

    There is only one setting, and hits are always returned.
    """

    steps_per_call = 1

    def __init__(self, scene: Scene, *, accurate: bool = False, count: bool = False) -> None:
        self.world = build(scene)
        self.discs = len(scene.positions)

    def run(self, steps: int) -> int:
        step, hits = self.world.step, 0
        for _ in range(steps // self.steps_per_call):
            hits += len(step(1.0, self.steps_per_call))
        return hits

    def state(self) -> tuple[FloatArray, FloatArray]:
        return self.world.positions[: self.discs], self.world.velocities[: self.discs]


class ManySteps(Arkanoid):
    """One world, a thousand steps per call."""

    steps_per_call = 1000


class Batch:
    """Worlds stepped together: copies of the scene's, except for the discs' velocities."""

    def __init__(self, scene: Scene, velocities: FloatArray) -> None:
        """Build the batch; velocities: float64 [worlds, 2], of the only disc of each world."""
        self.batch = WorldBatch(build(scene), len(velocities))
        self.batch.velocities[:, 0] = velocities
        self.batch.step(0.0)  # as in `build`

    def run(self, steps: int) -> int:
        step, hits = self.batch.step, 0
        for _ in range(steps):
            hits += len(step(1.0))
        return hits

    def state(self) -> tuple[FloatArray, FloatArray]:
        return np.array(self.batch.positions[:, 0]), np.array(self.batch.velocities[:, 0])
