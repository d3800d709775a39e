"""A crowd: some hundred discs start on a square and wander through a town.

In each tick everyone turns a little and walks on at the same speed. Who meets a house or somebody
else is turned back at the exact time, so nobody is ever inside anything. The broad phase finds who
may meet whom: each step tests neighbours, not all pairs. The program writes a picture, crowd.svg.
"""

import math
from itertools import combinations
from pathlib import Path
from random import Random

from arkanoid.physics import AxisAlignedRectangle, Body, Particle, World

PEOPLE, RADII = 400, (0.15, 0.24)
SPACING = 0.55  # from one to the next at the start
STREET, HOUSES, HOUSE = 4.0, 7, 2.2  # from house to house; houses in a row; the side of one
SPEED, TURN, TICK = 1.4, 0.15, 1 / 20  # a second; radians a tick; seconds
SECONDS, TAIL, FRAME = 20, 6, 5  # how long they wander; lines of a way drawn, and ticks of each


def town() -> World:
    """Return houses around a square."""
    middle = (HOUSES - 1) / 2
    places = [(x - middle, y - middle) for x in range(HOUSES) for y in range(HOUSES)]
    house = AxisAlignedRectangle(HOUSE, HOUSE)
    return World(
        Body(house, (STREET * x, STREET * y)) for x, y in places if max(abs(x), abs(y)) > 1
    )


def crowd(world: World, random: Random) -> list[int]:
    """Add the people, in rows on the square, and return their handles."""
    side = math.isqrt(PEOPLE)
    people = []
    for number in range(PEOPLE):
        place = [SPACING * (part - (side - 1) / 2) for part in divmod(number, side)]
        angle = random.uniform(-math.pi, math.pi)
        velocity = (SPEED * math.cos(angle), SPEED * math.sin(angle))
        people.append(world.add(Body(Particle(random.choice(RADII)), place, velocity, mass=1)))
    return people


def turn(world: World, people: list[int], random: Random) -> None:
    """Let everyone turn a little, and walk on at the usual speed."""
    for person in people:
        x, y = world.body(person).velocity
        angle = math.atan2(y, x) + random.gauss(0.0, TURN)
        world.place(person, velocity=(SPEED * math.cos(angle), SPEED * math.sin(angle)))


def main() -> None:
    """Let the crowd wander, print how far it is, and draw it."""
    random = Random(0)
    world = town()
    people = crowd(world, random)
    hits, places = 0, []
    for tick in range(1, round(SECONDS / TICK) + 1):
        turn(world, people, random)
        hits += len(world.step(TICK))
        if tick % FRAME == 0:
            places.append(world.positions)
        if tick % 100 == 0:
            bodies = [world.body(person) for person in people]
            way = sum(float(body.position @ body.position) for body in bodies) / PEOPLE
            # Nobody overlaps anybody, except for the rounding of the last touch.
            closest = min(
                math.dist(a.position, b.position) - a.collider.radius - b.collider.radius
                for a, b in combinations(bodies, 2)
            )
            print(
                f"{tick * TICK:4.0f} s: {math.sqrt(way):4.1f} away, {hits:6} hits, "
                f"closest {closest:.4f}"
            )
    picture = world.draw(paths=places[-TAIL - 1 :], width=640)
    Path("crowd.svg").write_text(picture, encoding="utf-8")


if __name__ == "__main__":
    main()
