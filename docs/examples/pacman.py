"""Pac-Man in a maze: relaxation alone makes the walls solid and lets him slide along them.

These are ordinary classes: none inherits from the engine or is registered with it. Walls and dots
have a collider and a position, so they can be detected. Pac-Man has a mass, too, so he gives way.
Nobody has a velocity, and nothing bounces.
"""

from arkanoid.physics import AxisAlignedRectangle, Particle, contact, detect, relax

MAZE = """
#########
#P..#...#
#.#.#.#.#
#.#...#.#
#.#####.#
#.......#
#########
"""
# The keys that the player holds down, and for how many ticks. With two at once he walks along the
# wall and slips round the next corner.
HELD = (
    ("right", 30),
    ("right down", 60),
    ("right up", 60),
    ("right down", 60),
    ("left", 10),
    ("left up", 110),
)
DIRECTIONS = {"up": (0, 1), "down": (0, -1), "left": (-1, 0), "right": (1, 0)}
STEP = 0.1  # how far he walks in a tick; a cell of the maze is 1


class Wall:
    """A cell of the maze that is filled."""

    collider = AxisAlignedRectangle(1, 1)

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position


class Dot:
    """Something to eat. It is detected, but nobody ever relaxes it: it is in nobody's way."""

    collider = Particle(0.1)

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position


class PacMan:
    """A disc a little smaller than the corridors."""

    collider = Particle(0.45)
    mass = 1.0  # what has a mass gives way to what has none

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position

    def walk(self, keys: str, walls: list[Wall]) -> None:
        """Step to where the keys point, walls or not, and then out of the walls."""
        x, y = self.position
        for key in keys.split():
            x, y = x + STEP * DIRECTIONS[key][0], y + STEP * DIRECTIONS[key][1]
        self.position = (x, y)
        for _ in walls:
            overlaps = [(contact(self, wall), wall) for wall in walls if detect(self, wall)]
            if not overlaps:
                return
            # The deepest first: it is the flat of a wall, and the corners of its neighbours in the
            # same row are then out of the way.
            deepest, wall = max(overlaps, key=lambda overlap: overlap[0].depth)
            relax(self, wall, deepest)


def cells(mark: str) -> list[tuple[float, float]]:
    """Return the centres of the cells with a mark, y upwards."""
    rows = reversed(MAZE.split())
    return [(x, y) for y, row in enumerate(rows) for x, cell in enumerate(row) if cell == mark]


def main() -> None:
    """Walk through the maze, and say where each change of keys led."""
    walls = [Wall(cell) for cell in cells("#")]
    dots = [Dot(cell) for cell in cells(".")]
    pacman = PacMan(cells("P")[0])
    eaten = 0
    for keys, ticks in HELD:
        for _ in range(ticks):
            pacman.walk(keys, walls)
            left = [dot for dot in dots if not detect(pacman, dot)]
            eaten += len(dots) - len(left)
            dots = left
        x, y = pacman.position
        print(f"{keys:10} leads to ({x:.2f}, {y:.2f}), {eaten:2} dots eaten")


if __name__ == "__main__":
    main()
