"""A ball among bricks: the discrete procedure of move, detect, relax and bounce, in own classes.

The ball has a velocity and a mass: it is moved and bounces. Walls and bricks have only a collider
and a position: static. The paddle has a velocity but no mass: it moves as it is told, nothing moves
it, and what bounces off it notices its speed.
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
    """A half-plane beside the field."""

    def __init__(self, collider: Collider, position: tuple[float, float]) -> None:
        self.collider = collider
        self.position = position


class Brick:
    """Gone when it was hit."""

    collider = AxisAlignedRectangle(1, 0.5)

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position


class Paddle:
    """Kinematic: a velocity, and no mass. Its ends slope away, which sends the ball sideways."""

    collider = Convex([(-1.2, -0.125), (1.2, -0.125), (0.6, 0.125), (-0.6, 0.125)])
    speed = 12.0

    def __init__(self) -> None:
        self.position = (WIDTH / 2, 1.5)
        self.velocity = (0.0, 0.0)

    def follow(self, x: float) -> None:
        """Go under a place, as far as a tick's way leads."""
        way = x - self.position[0]
        reach = self.speed * TICK
        self.velocity = (max(-reach, min(reach, way)) / TICK, 0.0)
        self.position = (self.position[0] + self.velocity[0] * TICK, self.position[1])


class Ball:
    """Dynamic: moved by its velocity, pushed and reflected by what it meets."""

    collider = Particle(0.125)
    mass = 1.0

    def __init__(self) -> None:
        self.position = (WIDTH / 2, 2.0)
        self.velocity = (4.0, 9.0)

    def fly(self) -> None:
        """Move on by one tick, with the speed that the game's rules give it."""
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
        # Half a paddle to and fro: with its flat and with its slopes.
        paddle.follow(ball.position[0] + 0.9 * math.sin(0.05 * ticks))
        bounces += sum(collide(ball, thing) for thing in (*walls, paddle))
        bricks = [brick for brick in bricks if not collide(ball, brick)]
        if ball.position[1] < 0:
            ball, balls = Ball(), balls + 1
    print(f"{len(bricks)} bricks are left after {ticks * TICK:.1f} s and {bounces} other bounces")


if __name__ == "__main__":
    main()
