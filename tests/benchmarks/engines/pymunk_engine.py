"""pymunk 7: Python's binding of the Chipmunk engine."""

from typing import Any

import numpy as np
import pymunk

from .scene import FloatArray, Scene

STEP = 1 / 60  # seconds; Chipmunk's constants are made for it, and no other step is faster


class Pymunk:
    """Chipmunk. A disc moves first, and overlaps are found then: it can fly over a thin box.

    Fast: the defaults, 10 iterations. Accurate: 1000; with fewer, the energy changes when a ball
    hits two bricks at once. One static body holds all boxes. The spatial hash is slower here than
    the default tree, and another slop or bias conserves energy no better.
    """

    def __init__(self, scene: Scene, *, accurate: bool = False, count: bool = False) -> None:
        self.space = pymunk.Space()
        if accurate:
            self.space.iterations = 1000
        self.discs = [
            self._disc(scene, position, velocity)
            for position, velocity in zip(scene.positions, scene.velocities, strict=True)
        ]
        for x, y, width, height in scene.boxes + scene.thick_walls():
            move = pymunk.Transform(tx=x, ty=y)
            corners = [(-width / 2, -height / 2), (width / 2, -height / 2)]
            corners += [(-x, -y) for x, y in corners]
            self._add(pymunk.Poly(self.space.static_body, corners, move))
        self.contacts = 0
        if count:
            self.space.on_collision(begin=self._begin)

    def _disc(self, scene: Scene, position: FloatArray, velocity: FloatArray) -> pymunk.Body:
        body = pymunk.Body(mass=1.0, moment=float("inf"))
        body.position = tuple(position.tolist())
        body.velocity = tuple((velocity / STEP).tolist())
        self.space.add(body)
        self._add(pymunk.Circle(body, scene.radius))
        return body

    def _add(self, shape: pymunk.Shape) -> None:
        shape.elasticity = 1.0
        shape.friction = 0.0
        self.space.add(shape)

    def _begin(self, arbiter: Any, space: Any, data: Any) -> None:
        self.contacts += 1

    def run(self, steps: int) -> int:
        step, before = self.space.step, self.contacts
        for _ in range(steps):
            step(STEP)
        return self.contacts - before

    def state(self) -> tuple[FloatArray, FloatArray]:
        positions = np.array([body.position for body in self.discs])
        return positions, np.array([body.velocity for body in self.discs]) * STEP


ENGINE = Pymunk
