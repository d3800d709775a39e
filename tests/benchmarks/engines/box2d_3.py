"""Box2D 3.1 through pyb2d3."""

import numpy as np
import pyb2d3

from .scene import FloatArray, Scene

STEP = 1 / 60  # seconds; shorter steps improve no scene, and make some worse


class Box2D3:
    """Box2D 3.1, single precision, soft contacts, no bullets.

    Fast: discs of 1/2 m. Accurate: discs of 2.5 m. Four sub-steps, as in its manual. No threshold
    of restitution and no highest speed; other contact tunings conserve energy no better.
    """

    def __init__(self, scene: Scene, *, accurate: bool = False, count: bool = False) -> None:
        self.count = count
        self.unit = (2.5 if accurate else 0.5) / scene.radius  # metres per unit
        self.world = pyb2d3.World(
            gravity=(0, 0), restitution_threshold=0.0, maximum_linear_speed=1e9
        )
        self.world.sleeping_enabled = False
        self.shape = pyb2d3.shape_def(
            density=1.0,
            material=pyb2d3.surface_material(restitution=1.0, friction=0.0),
            enable_contact_events=count,
        )
        self.discs = [
            self._disc(scene, position * self.unit, velocity * self.unit / STEP)
            for position, velocity in zip(scene.positions, scene.velocities, strict=True)
        ]
        for box in scene.boxes + scene.thick_walls():
            x, y, width, height = (self.unit * number for number in box)
            body = self.world.create_static_body(position=(x, y))
            body.create_shape(self.shape, pyb2d3.box(width / 2, height / 2))

    def _disc(self, scene: Scene, position: FloatArray, velocity: FloatArray) -> pyb2d3.Body:
        body = self.world.create_dynamic_body(
            position=tuple(position.tolist()),
            linear_velocity=tuple(velocity.tolist()),
            fixed_rotation=True,
            enable_sleep=False,
        )
        body.create_shape(self.shape, pyb2d3.circle(radius=scene.radius * self.unit))
        return body

    def run(self, steps: int) -> int:
        step, contacts = self.world.step, 0
        for _ in range(steps):
            step(STEP, 4)
            if self.count:
                contacts += sum(1 for _ in self.world.get_contact_events().begin_events())
        return contacts

    def state(self) -> tuple[FloatArray, FloatArray]:
        positions = np.array([tuple(body.position) for body in self.discs]) / self.unit
        velocities = np.array([tuple(body.linear_velocity) for body in self.discs])
        return positions, velocities * (STEP / self.unit)


ENGINE = Box2D3
