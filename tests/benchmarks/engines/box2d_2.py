"""Box2D 2.3 through pybox2d (the package Box2D)."""

import Box2D
import numpy as np

from .scene import FloatArray, Scene

# Seconds. Box2D ends bounces slower than 1 m/s (b2_velocityThreshold, which the binding cannot
# change). Steps this short make everything faster, and its other constants count in steps.
STEP = 1e-3
FARTHEST = 2.0  # metres per step: Box2D slows down faster bodies (b2_maxTranslation)
SLOP = 0.005  # metres: no shape can be smaller (b2_linearSlop)
SIZE = 0.5  # metres: the radius of a disc; Box2D is meant for 0.1 to 10 m


class Box2D2:
    """Box2D 2.3, single precision. It needs no bullets: static boxes stop every body.

    Fast: the 8 velocity and 3 position iterations of its manual. Accurate: 1000 and 10.
    """

    def __init__(self, scene: Scene, *, accurate: bool = False, count: bool = False) -> None:
        self.iterations = (1000, 10) if accurate else (8, 3)
        # Metres per unit.
        self.unit = max(min(SIZE / scene.radius, FARTHEST / scene.speed), SLOP / scene.radius)
        self.world = Box2D.b2World(gravity=(0, 0), doSleep=False)
        self.discs = [
            self._disc(scene, position * self.unit, velocity * self.unit / STEP)
            for position, velocity in zip(scene.positions, scene.velocities, strict=True)
        ]
        for box in scene.boxes + scene.thick_walls():
            x, y, width, height = (self.unit * number for number in box)
            self.world.CreateStaticBody(position=(x, y)).CreatePolygonFixture(
                box=(width / 2, height / 2), friction=0, restitution=1
            )
        self.counter = Counter()
        if count:
            self.world.contactListener = self.counter

    def _disc(self, scene: Scene, position: FloatArray, velocity: FloatArray) -> Box2D.b2Body:
        body = self.world.CreateDynamicBody(
            position=position.tolist(),
            linearVelocity=velocity.tolist(),
            fixedRotation=True,
            allowSleep=False,
        )
        body.CreateCircleFixture(
            radius=scene.radius * self.unit, density=1, friction=0, restitution=1
        )
        return body

    def run(self, steps: int) -> int:
        step, before = self.world.Step, self.counter.contacts
        velocity_iterations, position_iterations = self.iterations
        for _ in range(steps):
            step(STEP, velocity_iterations, position_iterations)
        return self.counter.contacts - before

    def state(self) -> tuple[FloatArray, FloatArray]:
        positions = np.array([tuple(body.position) for body in self.discs]) / self.unit
        velocities = np.array([tuple(body.linearVelocity) for body in self.discs])
        return positions, velocities * (STEP / self.unit)


class Counter(Box2D.b2ContactListener):
    contacts = 0

    def BeginContact(self, contact: Box2D.b2Contact) -> None:  # noqa: N802
        self.contacts += 1


ENGINE = Box2D2
