"""The break at pool, with `World`: sixteen balls, four cushions, and six pockets that are sensors.

Lengths are in metres, times in seconds. There is no friction; the balls lose energy only when they
bounce.
"""

import math

from arkanoid.physics import BEGIN, HIT, AxisAlignedHalfPlane, Body, Particle, World

WIDTH, HEIGHT = 2.54, 1.27
RADIUS = 0.0286
MASS = 0.17  # kg
POCKETS = [(x, y) for x in (0, WIDTH / 2, WIDTH) for y in (0, HEIGHT)]
FRAME = 1 / 60


def rack() -> list[tuple[float, float]]:
    """Return the places of fifteen balls: a triangle with its tip to the left, with small gaps."""
    step = 2 * RADIUS * 1.001
    return [
        (0.72 * WIDTH + row * step * math.sqrt(3) / 2, HEIGHT / 2 + step * (place - row / 2))
        for row in range(5)
        for place in range(row + 1)
    ]


def table() -> tuple[World, dict[int, str]]:
    """Return the world, and the names of its bodies by handle."""
    world = World()
    names = {}
    for direction, place in (
        ("+x", (0, 0)),
        ("-x", (WIDTH, 0)),
        ("+y", (0, 0)),
        ("-y", (0, HEIGHT)),
    ):
        cushion = Body(AxisAlignedHalfPlane(direction), place, restitution=0.8)
        names[world.add(cushion)] = f"cushion {direction}"
    for number, place in enumerate(POCKETS, 1):
        names[world.add(Body(Particle(0.04), place), sensor=True)] = f"pocket {number}"
    for number, place in enumerate(rack(), 1):
        names[world.add(ball(place))] = f"ball {number}"
    cue_ball = ball((0.25 * WIDTH, 0.5 * HEIGHT), velocity=(9.0, 0.0))
    names[world.add(cue_ball)] = "cue ball"
    return world, names


def ball(place: tuple[float, float], velocity: tuple[float, float] = (0.0, 0.0)) -> Body:
    """Return a ball."""
    return Body(Particle(RADIUS), place, velocity, MASS, restitution=0.97)


def energy(world: World) -> float:
    """Return the kinetic energy of all balls, in joules."""
    return 0.5 * MASS * float((world.velocities**2).sum())


def main() -> None:
    """Simulate ten seconds from the break on."""
    world, names = table()
    print(f"{energy(world):.2f} J before the break")
    bounces = 0
    for _ in range(600):
        hits = world.step(FRAME)
        bounces += int((hits["kind"] == HIT).sum())
        for hit in hits[hits["kind"] == BEGIN]:
            print(f"{hit['time']:.3f} s: {names[hit['b']]} in {names[hit['a']]}")
            world.remove(hit["b"])
    print(f"{bounces} bounces; {energy(world):.2f} J and {len(world) - 10} balls are left")


if __name__ == "__main__":
    main()
