"""A ball among bricks, with classes of our own: in each tick move, detect, relax and bounce.

Walls and bricks have only a collider and a position, so they are static. The ball also has a
velocity and a mass, so it bounces. The paddle has a velocity but no mass: nothing changes its
motion, but what bounces off it feels its speed.
"""

import math

from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    Particle,
    collide,
)

WIDTH, HEIGHT = 11, 14
ROWS = 4
SPEED = 10
TICK = 1 / 240  # short: the ball must not fly through a brick between two ticks


class Wall:
    """A half-plane at one side of the field. It is static."""

    def __init__(self, collider: Collider, position: tuple[float, float]) -> None:
        self.collider = collider
        self.position = position


class Brick:
    """A rectangle that disappears when the ball hits it. It is static."""

    collider = AxisAlignedRectangle(1, 0.5)

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position


class Paddle:
    """Kinematic: it has a velocity and no mass. Its sloping ends send the ball sideways."""

    collider = Convex([(-1.2, -0.125), (1.2, -0.125), (0.6, 0.125), (-0.6, 0.125)])
    speed = 12.0

    def __init__(self) -> None:
        self.position = (WIDTH / 2, 1.5)
        self.velocity = (0.0, 0.0)

    def follow(self, x: float) -> None:
        """Move towards x, at most as far as one tick allows."""
        way = x - self.position[0]
        reach = self.speed * TICK
        self.velocity = (max(-reach, min(reach, way)) / TICK, 0.0)
        self.position = (self.position[0] + self.velocity[0] * TICK, self.position[1])


class Ball:
    """Dynamic: it has a velocity and a mass, and is pushed and reflected by what it hits."""

    collider = Particle(0.125)
    mass = 1.0

    def __init__(self) -> None:
        self.position = (WIDTH / 2, 2.0)
        self.velocity = (4.0, 9.0)

    def fly(self) -> None:
        """Move for one tick. The rules of the game fix the speed."""
        faster = SPEED / math.hypot(*self.velocity)
        self.velocity = (self.velocity[0] * faster, self.velocity[1] * faster)
        self.position = (
            self.position[0] + self.velocity[0] * TICK,
            self.position[1] + self.velocity[1] * TICK,
        )


def main() -> None:
    """Play until the bricks are gone."""
    walls = [
        Wall(AxisAlignedHalfPlane("+x"), (0, 0)),
        Wall(AxisAlignedHalfPlane("-x"), (WIDTH, 0)),
        Wall(AxisAlignedHalfPlane("-y"), (0, HEIGHT)),
    ]
    bricks = [
        Brick((column + 0.5, 10.25 + 0.5 * row)) for row in range(ROWS) for column in range(WIDTH)
    ]
    ball, paddle = Ball(), Paddle()
    ticks, balls, bounces = 0, 1, 0
    while bricks and balls <= 3:
        ticks += 1
        ball.fly()
        # Swing about the ball, so that it lands on the flat part and on the slopes.
        paddle.follow(ball.position[0] + 0.9 * math.sin(0.05 * ticks))
        bounces += sum(collide(ball, thing) for thing in (*walls, paddle))
        bricks = [brick for brick in bricks if not collide(ball, brick)]
        if ball.position[1] < 0:
            ball, balls = Ball(), balls + 1
    print(f"{len(bricks)} bricks are left after {ticks * TICK:.1f} s and {bounces} other bounces")


if __name__ == "__main__":
    main()
