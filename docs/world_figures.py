"""The figure of a world: one step from hit to hit, and the same time in ticks."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Particle,
    Rectangle,
    World,
)
from drawing import ACCENT, FIRST, GREY, SECOND, arrow, dot, figure, label, line, panel, region
from matplotlib.axes import Axes
from matplotlib.figure import Figure

WIDTH, HEIGHT = 4.0, 2.6
BALL = Body(Particle(0.16), (0.45, 0.5), (3.0, 1.35), mass=1.0)
OBSTACLES = (
    Body(AxisAlignedRectangle(0.08, 1.3), (2.05, 1.0)),
    Body(Particle(0.35), (0.75, 1.9)),
    Body(Rectangle(0.9, 0.3, -0.6), (3.15, 1.85)),
)
ROOM = (
    Body(AxisAlignedHalfPlane("+x"), (0.0, 0.0)),
    Body(AxisAlignedHalfPlane("-x"), (WIDTH, 0.0)),
    Body(AxisAlignedHalfPlane("+y"), (0.0, 0.0)),
    Body(AxisAlignedHalfPlane("-y"), (0.0, HEIGHT)),
)
DURATION = 2.0
TICKS = 6
MARGIN = 0.15  # how much of the walls is shown


def stepped() -> Figure:
    """Draw a ball's way in one exact step, and in ticks of the discrete procedure."""
    drawn = figure(7.4, 2.8)
    panels = (
        ("exact", "one step, from hit to hit", draw_step),
        ("ticks", "six ticks: move, detect, relax, bounce", draw_ticks),
    )
    for index, (name, title, draw) in enumerate(panels):
        view = (-MARGIN, -MARGIN, WIDTH + MARGIN, HEIGHT + MARGIN)
        box = (0.1 + 3.7 * index, 0.1, 3.5, 3.5 * (view[3] - view[1]) / (view[2] - view[0]))
        axes = panel(drawn, box, view, name, title)
        for number, body in enumerate(ROOM):
            region(axes, f"wall-{number}", body.collider, body.position, GREY)
        for number, body in enumerate(OBSTACLES):
            region(axes, f"obstacle-{number}", body.collider, body.position, SECOND)
        region(axes, "start", BALL.collider, BALL.position, FIRST, ghost=True)
        draw(axes)
    return drawn


def draw_step(axes: Axes) -> None:
    """Draw the ball's way through one step, and the normals of its hits."""
    world = World((*ROOM, *OBSTACLES, BALL))
    places = [BALL.position]
    for number, hit in enumerate(world.step(DURATION)):
        # The ball is the last body, so the normal points towards it.
        places.append(hit["point"] + BALL.collider.radius * hit["normal"])
        arrow(axes, f"normal-{number}", hit["point"], hit["point"] + 0.4 * hit["normal"], head=5.0)
        dot(axes, f"point-{number}", hit["point"], ACCENT)
        beside = 0.2 * hit["normal"] + 0.12 * np.array((-hit["normal"][1], hit["normal"][0]))
        label(axes, hit["point"], str(number + 1), GREY, shift=beside, fontsize=7.0)
    places.append(world.positions[-1])
    draw_way(axes, places)


def draw_ticks(axes: Axes) -> None:
    """Draw the ball after every tick."""
    world = World((*ROOM, *OBSTACLES, BALL), continuous=False)
    places = [BALL.position]
    for tick in range(TICKS):
        world.step(DURATION / TICKS)
        places.append(world.positions[-1])
        region(axes, f"tick-{tick}", BALL.collider, places[-1], FIRST, ghost=True)
    draw_way(axes, places)


def draw_way(axes: Axes, places: Sequence[np.ndarray]) -> None:
    """Draw the way from place to place, and the ball at its end."""
    for number, (start, end) in enumerate(pairwise(places)):
        line(axes, f"way-{number}", start, end, FIRST)
    region(axes, "end", BALL.collider, places[-1], FIRST)
