"""Figures of regions at rest: the colliders, contacts, the Minkowski difference, open regions."""

import numpy as np
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
    contact,
    relax,
)
from arkanoid.physics.pairs.convex_convex import separation_along
from arkanoid.physics.pairs.table import REGISTERED
from arkanoid.physics.shapes.table import shape_table
from drawing import (
    ACCENT,
    FIRST,
    GREY,
    INK,
    PENTAGON,
    SECOND,
    TRIANGLE,
    arrow,
    dot,
    figure,
    label,
    line,
    panel,
    region,
    rounded,
)
from matplotlib.axes import Axes
from matplotlib.figure import Figure

NAMES = (
    "Particle",
    "HalfPlane",
    "AxisAligned-\nHalfPlane",
    "AxisAligned-\nRectangle",
    "Rectangle",
    "Convex",
)
ALGORITHMS = (
    "disc–disc",
    "disc–half-plane",
    "disc–box",
    "disc–convex",
    "box–box",
    "convex–convex",
)


def colliders() -> Figure:
    """Draw the six colliders, each with the body's position and the edges' outward normals."""
    shapes = (
        (Particle(1.1), "Particle(1.1)"),
        (HalfPlane((1.0, 2.0), 0.6), "HalfPlane((1, 2), 0.6)"),
        (AxisAlignedHalfPlane("+y", 0.4), 'AxisAlignedHalfPlane("+y", 0.4)'),
        (AxisAlignedRectangle(2.4, 1.4), "AxisAlignedRectangle(2.4, 1.4)"),
        (Rectangle(2.4, 1.4, 0.5), "Rectangle(2.4, 1.4, 0.5)"),
        (Convex(PENTAGON), "Convex(vertices)"),
    )
    side, across = 1.75, 2.4
    drawn = figure(3 * across + 0.2, 2 * (side + 0.34) + 0.1)
    for index, (collider, title) in enumerate(shapes):
        box = (
            0.1 + (index % 3) * across,
            0.1 + (1 - index // 3) * (side + 0.34),
            across - 0.15,
            side,
        )
        axes = panel(drawn, box, (-2.25, -1.75, 2.25, 1.75), f"collider-{index}", title)
        region(axes, "region", collider, (0.0, 0.0), FIRST)
        for number, edge in enumerate(collider.edges):
            middle = (0.5 * (edge.start_x + edge.end_x), 0.5 * (edge.start_y + edge.end_y))
            tip = (middle[0] + 0.5 * edge.normal_x, middle[1] + 0.5 * edge.normal_y)
            arrow(axes, f"normal-{number}", middle, tip)
        dot(axes, "position", (0.0, 0.0), ACCENT)
    return drawn


# One body of each kind as the first of a pair (lower left) and as the second (upper right).
AS_FIRST = (
    Body(Particle(1.0), (-0.6, -0.4)),
    Body(HalfPlane((0.45, 1.0)), (0.0, 0.05)),
    Body(AxisAlignedHalfPlane("+y"), (0.0, 0.1)),
    Body(AxisAlignedRectangle(2.1, 1.5), (-0.55, -0.55)),
    Body(Rectangle(2.1, 1.3, 0.5), (-0.55, -0.5)),
    Body(Convex(PENTAGON), (-0.6, -0.4)),
)
AS_SECOND = (
    Body(Particle(0.8), (0.45, 0.35)),
    Body(HalfPlane((-1.0, -0.6)), (-0.3, 0.0)),
    Body(AxisAlignedHalfPlane("-x"), (-0.15, 0.0)),
    Body(AxisAlignedRectangle(1.7, 1.2), (0.6, 0.3)),
    Body(Rectangle(1.8, 1.1, -0.6), (0.45, 0.3)),
    Body(Convex(TRIANGLE), (0.45, 0.35)),
)
# Two half-planes are separable only if they are back to back.
BACK_TO_BACK = {
    (1, 1): (Body(HalfPlane((0.45, 1.0)), (0.0, 0.3)), Body(HalfPlane((-0.9, -2.0)), (0.0, -0.3))),
    (1, 2): (
        Body(HalfPlane((3.0, 0.0)), (0.3, 0.0)),
        Body(AxisAlignedHalfPlane("-x"), (-0.3, 0.0)),
    ),
    (2, 2): (
        Body(AxisAlignedHalfPlane("+y"), (0.0, 0.3)),
        Body(AxisAlignedHalfPlane("-y"), (0.0, -0.3)),
    ),
}


def contacts() -> Figure:
    """Draw the contacts of all 21 pairs: normal, depth, point, and b after the separation."""
    cell, across, up, left = 1.1, 1.2, 1.3, 0.1
    drawn = figure(6 * across + 2 * left, 6 * up + 0.45)
    for first, second, algorithm in REGISTERED:
        a, b = BACK_TO_BACK.get((first, second)) or (AS_FIRST[first], AS_SECOND[second])
        box = (left + second * across, 0.25 + (5 - first) * up, cell, cell)
        axes = panel(drawn, box, (-1.8, -1.8, 1.8, 1.8), f"contact-{first}{second}")
        if first == 0:
            axes.set_title(NAMES[second], fontsize=7.5, pad=4.0)
        elif first == second:
            label(axes, (-2.0, 0.0), NAMES[first], fontsize=7.5, ha="right")
        draw_contact(axes, a, b)
        depth = contact(a, b).depth
        label(axes, (-1.8, -2.05), ALGORITHMS[algorithm], GREY, fontsize=5.8, ha="left")
        label(axes, (1.8, -2.05), f"{depth:.2f}", INK, fontsize=5.8, ha="right")
    explain_contacts(drawn)
    return drawn


def draw_contact(axes: Axes, a: Body, b: Body) -> None:
    """Draw two regions, the shortest translation that separates them, and b after it."""
    overlap = contact(a, b)
    half = 0.5 * overlap.depth * overlap.normal
    region(axes, "a", a.collider, a.position, FIRST)
    region(axes, "b", b.collider, b.position, SECOND)
    region(axes, "free", b.collider, b.position + 2.0 * half, SECOND, ghost=True)
    arrow(axes, "normal", overlap.point - half, overlap.point + half, width=1.1, head=5.0)
    dot(axes, "point", overlap.point, ACCENT, 1.2)


def explain_contacts(drawn: Figure) -> None:
    """Draw a larger contact with its parts named, into the empty corner."""
    axes = panel(drawn, (0.1, 0.25, 2.6, 2.6), (-1.8, -2.0, 1.8, 1.6), "contact-legend")
    a = Body(Particle(1.05), (-0.65, -0.3))
    b = Body(AxisAlignedRectangle(1.4, 1.1), (0.45, 0.4))
    draw_contact(axes, a, b)
    style = {"fontsize": 6.5, "ha": "left"}
    label(axes, (-1.0, -0.5), "$a$", FIRST, fontsize=11)
    label(axes, (0.8, 0.78), "$b$", SECOND, fontsize=11)
    label(axes, (-1.7, -1.85), "dashed: $b$ moved by normal · depth, touching", SECOND, **style)
    label(axes, (-1.7, -1.64), "arrow: the normal, as long as the depth", INK, **style)
    label(axes, (1.7, -1.64), "dot: the point", ACCENT, fontsize=6.5, ha="right")


def minkowski() -> Figure:
    """Draw an overlap, and the same as a point in the Minkowski difference."""
    drawn = figure(7.3, 2.65)
    a = Body(Rectangle(2.1, 1.3, 0.5), (-0.5, -0.45))
    b = Body(Convex(TRIANGLE), (0.5, 0.35))
    overlap = contact(a, b)
    view = (-2.6, -2.6, 2.6, 2.6)
    axes = panel(drawn, (0.1, 0.1, 2.3, 2.3), (-2.0, -2.0, 2.0, 2.0), "overlap", "two regions")
    draw_contact(axes, a, b)
    arrow(axes, "offset", a.position, b.position, GREY, 0.8, 5.0)
    dot(axes, "a-position", a.position, FIRST)
    dot(axes, "b-position", b.position, SECOND)
    label(axes, (-0.95, -0.75), "$a$", FIRST, fontsize=10)
    label(axes, (1.0, 0.35), "$b$", SECOND, fontsize=10)

    axes = panel(
        drawn, (2.5, 0.1, 2.3, 2.3), view, "difference", "all offsets at which they overlap"
    )
    offset = b.position - a.position
    whole = difference(a.collider, b.collider)
    region(axes, "difference", whole, (0.0, 0.0), GREY)
    own = {(edge.normal_x, edge.normal_y) for edge in a.collider.edges}
    for number, edge in enumerate(whole.edges):
        colour = FIRST if (edge.normal_x, edge.normal_y) in own else SECOND
        ends = (edge.start_x, edge.start_y), (edge.end_x, edge.end_y)
        line(axes, f"owned-{number}", *ends, colour, linewidth=1.4)
    arrow(axes, "offset", (0.0, 0.0), offset, GREY, 0.8, 5.0)
    arrow(axes, "normal", offset, offset + overlap.depth * overlap.normal, head=5.0)
    dot(axes, "origin", (0.0, 0.0), FIRST)
    dot(axes, "b-position", offset, SECOND)
    label(axes, (0.3, 0.65), "$d$", GREY, fontsize=10)

    axes = panel(
        drawn, (4.9, 0.1, 2.3, 2.3), view, "rounded", "rectangle and disc: rounded corners"
    )
    box, ball = Rectangle(2.1, 1.3, 0.5), Particle(0.8)
    rounded(axes, "difference", box, ball.radius, GREY)
    region(axes, "a", box, (0.0, 0.0), FIRST)
    for name, place in (("inside", (1.0, 1.35)), ("outside", (-1.75, 1.55))):
        region(axes, name, ball, place, SECOND, ghost=True)
        dot(axes, f"{name}-centre", place, SECOND)
    deep = contact(Body(box), Body(ball, (1.0, 1.35)))
    tip = np.array((1.0, 1.35)) + deep.depth * deep.normal
    arrow(axes, "normal", (1.0, 1.35), tip, head=5.0)
    return drawn


def difference(a: Collider, b: Collider) -> Convex:
    """Return all offsets of b from a at which the two overlap, from the engine's axes."""
    shapes, edges = shape_table((a, b))
    bounds = []
    for axis in range(len(a.edges) + len(b.edges)):
        x, y, gap = separation_along(shapes, edges, 0, 1, axis, 0.0, 0.0)
        bounds.append(HalfPlane((x, y), -gap))
    return Convex.from_half_planes(bounds)


def opened() -> Figure:
    """Draw regions with missing edges, and a pair that no finite translation separates."""
    drawn = figure(7.5, 2.1)
    trapezium = [(-1.3, -1.2), (1.3, -1.2), (0.7, 0.2), (-0.7, 0.2)]
    views = (-2.0, -2.0, 2.0, 2.0)
    cases = (
        ("all edges", ()),
        ("open_edges=(0,)", (0,)),
        ("open_edges=(2,)", (2,)),
    )
    for index, (title, missing) in enumerate(cases):
        box = (0.1 + 1.85 * index, 0.1, 1.7, 1.7)
        axes = panel(drawn, box, views, f"open-{index}", title)
        shape = Convex(trapezium, missing)
        region(axes, "region", shape, (0.0, 0.0), FIRST)
        for edge in missing:
            ends = trapezium[edge], trapezium[(edge + 1) % 4]
            line(axes, f"missing-{edge}", *ends, ACCENT, linestyle=(0, (2, 2)), linewidth=1.2)
        for number, corner in enumerate(shape.vertices):
            dot(axes, f"corner-{number}", corner, INK if corner in trapezium else ACCENT)
    axes = panel(
        drawn, (0.1 + 1.85 * 3, 0.1, 1.7, 1.7), views, "open-3", "inseparable: depth is inf"
    )
    region(axes, "a", HalfPlane((0.4, 1.0)), (0.0, -0.1), FIRST)
    region(axes, "b", HalfPlane((-1.0, 0.3)), (-0.2, 0.0), SECOND)
    return drawn


def relaxed() -> Figure:
    """Draw what relaxation does: to two masses, at a wall, at a seam and in a wedge."""
    drawn = figure(7.5, 2.05)
    titles = ("$m_a$ = 1, $m_b$ = 3", "a step into a wall", "the deepest first", "one pass each")
    panels = [
        panel(drawn, (0.1 + 1.85 * index, 0.1, 1.7, 1.7), view, f"relax-{index}", title)
        for index, (title, view) in enumerate(zip(titles, RELAX_VIEWS, strict=True))
    ]
    draw_masses(panels[0])
    draw_slide(panels[1])
    draw_seam(panels[2])
    draw_wedge(panels[3])
    return drawn


RELAX_VIEWS = (
    (-2.0, -2.0, 2.0, 2.0),
    (-1.6, -1.6, 1.6, 1.6),
    (-1.6, -1.6, 1.6, 1.6),
    (-1.6, -0.65, 0.7, 1.65),
)


def draw_masses(axes: Axes) -> None:
    """Draw two discs before (dashed) and after, and their common centre of mass."""
    a = Body(Particle(0.9), (-0.35, -0.45), mass=1)
    b = Body(Particle(0.9), (0.45, 0.25), mass=3)
    starts = a.position, b.position
    relax(a, b, contact(a, b))
    for name, body, start, colour in (("a", a, starts[0], FIRST), ("b", b, starts[1], SECOND)):
        region(axes, f"{name}-start", body.collider, start, colour, ghost=True)
        region(axes, name, body.collider, body.position, colour)
        arrow(axes, f"{name}-way", start, body.position, head=5.0)
    dot(axes, "centre", (a.position + 3 * b.position) / 4, ACCENT)
    label(axes, a.position, "$a$", FIRST, shift=(-0.45, -0.2), fontsize=10)
    label(axes, b.position, "$b$", SECOND, shift=(0.4, 0.35), fontsize=10)


def draw_slide(axes: Axes) -> None:
    """Draw a step into a wall, and the part of it that relaxation leaves."""
    wall = Body(AxisAlignedRectangle(1.2, 2.6), (0.8, 0.0))
    walker = Body(Particle(0.6), (-0.4, -0.6), mass=1)
    region(axes, "wall", wall.collider, wall.position, GREY)
    region(axes, "start", walker.collider, walker.position, FIRST, ghost=True)
    start, stepped = walker.position, walker.position + np.array((0.5, 0.7))
    walker.position = stepped
    region(axes, "stepped", walker.collider, stepped, SECOND, ghost=True)
    relax(wall, walker, contact(wall, walker))
    region(axes, "end", walker.collider, walker.position, FIRST)
    arrow(axes, "step", start, stepped, SECOND, head=5.0)
    arrow(axes, "relaxation", stepped, walker.position, head=5.0)


def draw_seam(axes: Axes) -> None:
    """Draw a disc that overlaps a tile's top and, less, the corner of the next one."""
    walker = Body(Particle(0.8), (-0.4, 0.4), mass=1)
    region(axes, "walker", walker.collider, walker.position, FIRST)
    for number, x in enumerate((-0.75, 0.75)):
        tile = Body(AxisAlignedRectangle(1.5, 1.2), (x, -0.6))
        region(axes, f"tile-{number}", tile.collider, tile.position, GREY)
        overlap = contact(tile, walker)
        tip = walker.position + 2 * overlap.depth * overlap.normal
        arrow(axes, f"normal-{number}", walker.position, tip, (INK, ACCENT)[number], head=5.0)
        words = f"depth {overlap.depth:.2f}"
        label(axes, (1.5, 1.35 - 0.3 * number), words, (INK, ACCENT)[number], ha="right")


def draw_wedge(axes: Axes) -> None:
    """Draw the ways of a disc that two walls at 60 degrees push out in turn."""
    walls = (Body(HalfPlane((-(0.75**0.5), -0.5))), Body(AxisAlignedHalfPlane("+y")))
    ball = Body(Particle(0.5), (-0.1, 0.5), mass=1)
    for number, wall in enumerate(walls):
        region(axes, f"wall-{number}", wall.collider, wall.position, GREY)
    region(axes, "start", ball.collider, ball.position, FIRST, ghost=True)
    for number in range(8):
        start = ball.position
        relax(walls[number % 2], ball, contact(walls[number % 2], ball))
        line(axes, f"way-{number}", start, ball.position, ACCENT)
    region(axes, "end", ball.collider, ball.position, FIRST)
