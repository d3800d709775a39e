"""Pac-Man in a maze: relaxation alone makes the walls solid and lets him slide along them.

These are ordinary classes, which the engine does not know. Walls and dots have a collider and a
position, so they can be detected. Pac-Man also has a mass, so relaxation moves him. Nothing has a
velocity, and nothing bounces.
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
# The keys that the player holds down, and for how many ticks. While two keys are held, Pac-Man
# slides along the wall and round the next corner.
HELD = (
    ("right", 30),
    ("right down", 60),
    ("right up", 60),
    ("right down", 60),
    ("left", 10),
    ("left up", 110),
)
DIRECTIONS = {"up": (0, 1), "down": (0, -1), "left": (-1, 0), "right": (1, 0)}
STEP = 0.1  # how far he walks per tick; a cell of the maze is 1 wide


class Wall:
    """A solid cell of the maze."""

    collider = AxisAlignedRectangle(1, 1)

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position


class Dot:
    """Something to eat. It is only detected, so it stops nobody."""

    collider = Particle(0.1)

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position


class PacMan:
    """A disc a little smaller than the corridors."""

    collider = Particle(0.45)
    mass = 1.0  # relaxation moves what has a mass

    def __init__(self, position: tuple[float, float]) -> None:
        self.position = position

    def walk(self, keys: str, walls: list[Wall]) -> None:
        """Step where the keys point, even into a wall, and then out of all walls."""
        x, y = self.position
        for key in keys.split():
            x, y = x + STEP * DIRECTIONS[key][0], y + STEP * DIRECTIONS[key][1]
        self.position = (x, y)
        for _ in walls:
            overlaps = [(contact(self, wall), wall) for wall in walls if detect(self, wall)]
            if not overlaps:
                return
            # The deepest contact first: it is with the flat side of a wall. After that he no longer
            # overlaps the corners of the next walls in the row.
            deepest, wall = max(overlaps, key=lambda overlap: overlap[0].depth)
            relax(self, wall, deepest)


def cells(mark: str) -> list[tuple[float, float]]:
    """Return the centres of all cells with this mark. y points up."""
    rows = reversed(MAZE.split())
    return [(x, y) for y, row in enumerate(rows) for x, cell in enumerate(row) if cell == mark]


def main() -> None:
    """Walk through the maze, and print where each combination of keys led."""
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
