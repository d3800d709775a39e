"""A platformer on tiles: run, jump, ride on a moving floor, and flee over tiles that fall.

The world finds each contact at its exact time, so the hero neither sinks into a tile nor stops
where two tiles meet. Gravity changes his velocity between the ticks. A hit says on what he stands.
The program writes a film, platformer.svg.
"""

from pathlib import Path

from arkanoid.physics import BEGIN, HIT, AxisAlignedRectangle, Body, World

LEVEL = """
......................o.............
....o.....o........o...#............
.........###..........##...........#
.P..#....###..........##...o...o.o.#
#############===....#####~~~~~######
"""
# The keys that the player holds down, and for how many ticks.
HELD = (
    ("right", 50),  # into the first wall
    ("right jump", 25),  # over it
    ("right", 60),  # into the second
    ("right jump", 38),  # up along it
    ("right", 32),  # down again
    ("no key", 100),  # the moving floor comes back
    ("right", 15),
    ("no key", 90),  # it carries him
    ("right", 30),
    ("right jump", 87),  # to the shore, and up the stairs
    ("right", 190),  # over tiles that fall
)
TICK, FRAME = 1 / 60, 4  # seconds; ticks from picture to picture
WALK, JUMP, GRAVITY = 4.0, 12.0, 30.0  # tiles per second; gravity per second
RIDE, RIDE_TICKS = 1.5, 150  # how fast and how long a moving tile goes in one direction
FALL, HOLD_TICKS = 6.0, 18  # how fast a loose tile falls, and how long it holds before
MARKS = {  # of LEVEL: colour, width and height
    "#": ("#d6dbe1", 1, 1),
    "=": ("#7d8894", 1, 1),  # moves
    "~": ("#b3262f", 1, 1),  # loose
    "o": ("#e08a2c", 0.4, 0.4),  # a coin
    "P": ("#2f6fb0", 0.6, 0.9),  # the hero
}


class Game:
    """A world made from LEVEL, and what the rules of the game add to it."""

    def __init__(self) -> None:
        self.world, self.ticks = World(), 0
        self.marks: dict[int, str] = {}  # of each body, by its handle
        for y, row in enumerate(reversed(LEVEL.split())):
            for x, mark in enumerate(row):
                if mark in MARKS:
                    box, mass = AxisAlignedRectangle(*MARKS[mark][1:]), 1 if mark == "P" else None
                    body = Body(box, (x, y), mass=mass, restitution=0)
                    self.marks[self.world.add(body, sensor=mark == "o")] = mark
        (self.hero,) = self.marked("P")
        self.ground: int | None = None  # the body on which he stands
        self.held = dict.fromkeys(self.marked("~"), HOLD_TICKS)
        self.taken: dict[int, int] = {}  # when he took each coin

    def marked(self, mark: str) -> list[int]:
        """Return the handles of the bodies with a mark in LEVEL."""
        return [body for body, its in self.marks.items() if its == mark]

    def tick(self, keys: str) -> None:
        """Apply the keys and the rules of the tiles, and step the world."""
        if self.ticks % RIDE_TICKS == 0:
            ride = RIDE if self.ticks % (2 * RIDE_TICKS) == 0 else -RIDE
            for tile in self.marked("="):
                self.world.place(tile, velocity=(ride, 0))
        if self.ground in self.held:
            self.held[self.ground] -= 1
            if self.held[self.ground] == 0:
                self.world.place(self.ground, velocity=(0, -FALL))
        self.steer(keys)
        self.ground = None
        for hit in self.world.step(TICK):
            # Normals point from a to b: make them point to the hero.
            first = hit["a"] == self.hero
            other, up = int(hit["b" if first else "a"]), hit["normal"][1] * (-1 if first else 1)
            if hit["kind"] == BEGIN:
                self.taken[other] = self.ticks
            elif hit["kind"] == HIT and up > 0.5:
                self.ground = other
        self.ticks += 1

    def steer(self, keys: str) -> None:
        """Give the hero his velocity for a tick: the keys, what carries him, and gravity."""
        x = WALK * (("right" in keys) - ("left" in keys))
        y = self.world.body(self.hero).velocity[1] - GRAVITY * TICK
        if self.ground is not None:
            x += self.world.body(self.ground).velocity[0]
            y = JUMP if "jump" in keys else y
        self.world.place(self.hero, velocity=(x, y))


def film(game: Game, ways: dict[int, list[tuple[float, float]]]) -> str:
    """Return an animated picture as SVG, in which each body follows its way. y points up."""
    parts, cycle = [], f'dur="{game.ticks * TICK:.2f}s" repeatCount="indefinite"'
    for body, way in ways.items():
        (colour, width, height), (x, y), moves = MARKS[game.marks[body]], way[0], ""
        if body in game.taken:
            end = f'values="1;0" keyTimes="0;{game.taken[body] / game.ticks:.3f}"'
            moves = f'<animate attributeName="opacity" {end} calcMode="discrete" {cycle}/>'
        elif len(set(way)) > 1:
            steps = ";".join(f"{there[0] - x:.2f},{there[1] - y:.2f}" for there in way)
            moves = f'<animateMotion values="{steps}" calcMode="linear" {cycle}/>'
        box = f'x="{x - width / 2:g}" y="{y - height / 2:g}" width="{width}" height="{height}"'
        parts.append(f'<rect {box} fill="{colour}">{moves}</rect>')
    across, up = len(LEVEL.split()[0]), len(LEVEL.split()) + 1
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-.5 {0.5 - up} {across} {up}">'
        f'<g transform="scale(1 -1)" stroke="#fff" stroke-width=".04">{"".join(parts)}</g></svg>\n'
    )


def main() -> None:
    """Play, print where each combination of keys led, and write the film."""
    game = Game()
    ways = {body: [] for body in game.marks}
    for keys, ticks in HELD:
        for _ in range(ticks):
            game.tick(keys)
            if game.ticks % FRAME == 0:
                for body, way in ways.items():
                    way.append(tuple(game.world.body(body).position))
        x, y = game.world.body(game.hero).position
        print(f"{keys:10} leads to ({x:5.2f}, {y:.2f}), {len(game.taken)} coins taken")
    Path("platformer.svg").write_text(film(game, ways), encoding="utf-8")


if __name__ == "__main__":
    main()
