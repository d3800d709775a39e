"""Figures of motion: flights until the first touch, how its time is found, and the bounce."""

import math

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
    bounce,
    time_of_impact,
)
from arkanoid.physics.pairs.convex_convex import separation_along
from arkanoid.physics.pairs.touching_point import touching_point
from arkanoid.physics.shapes.table import shape_table
from drawing import (
    ACCENT,
    FAINT,
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

FLIGHTS = (
    (
        "disc, disc",
        Body(Particle(0.8), (-1.4, -1.3), (0.35, 0.9)),
        Body(Particle(0.6), (1.6, 1.4), (-0.8, -0.3)),
    ),
    (
        "disc, half-plane",
        Body(Particle(0.6), (-1.5, 1.4), (0.9, -0.7)),
        Body(HalfPlane((-0.3, 1.0)), (0.0, -1.0)),
    ),
    (
        "disc, box: face",
        Body(Particle(0.5), (-1.7, 1.5), (1.1, -0.7)),
        Body(AxisAlignedRectangle(2.6, 1.2), (0.5, -0.7)),
    ),
    (
        "disc, box: corner",
        Body(Particle(0.5), (-1.8, 1.4), (1.0, -0.68)),
        Body(AxisAlignedRectangle(2.0, 1.6), (0.9, -0.9)),
    ),
    (
        "box, box",
        Body(AxisAlignedRectangle(1.3, 0.8), (-1.5, -1.2), (0.7, 0.35)),
        Body(AxisAlignedRectangle(1.0, 1.4), (1.2, 1.0), (-0.2, -0.5)),
    ),
    (
        "convex, convex",
        Body(Convex(PENTAGON), (-1.0, -1.0)),
        Body(Convex(TRIANGLE, rotation=0.4), (1.2, 1.0), (-1.0, -0.6)),
    ),
    (
        "rectangle, half-plane",
        Body(Rectangle(1.5, 0.8, 0.7), (-1.2, 1.3), (0.6, -1.0)),
        Body(AxisAlignedHalfPlane("+y"), (0.0, -1.0)),
    ),
    (
        "disc, open convex",
        Body(Particle(0.45), (-1.9, -1.0), (1.0, 0.4)),
        Body(Convex([(-0.6, 0.4), (-0.4, -0.6), (1.0, -0.9), (1.6, 1.0)], (2, 3)), (0.5, 0.3)),
    ),
)


def impacts() -> Figure:
    """Draw flights until the first touch, each with its start, its way and the normal."""
    drawn = figure(7.5, 4.15)
    for index, (title, a, b) in enumerate(FLIGHTS):
        box = (0.1 + 1.85 * (index % 4), 0.1 + 2.1 * (1 - index // 4), 1.7, 1.7)
        axes = panel(drawn, box, (-2.4, -2.4, 2.4, 2.4), f"impact-{index}", title)
        time = draw_flight(axes, a, b)
        label(axes, (2.2, -2.1), f"$t$ = {time:.3f}", fontsize=7.0, ha="right")
    return drawn


def draw_flight(axes: Axes, a: Body, b: Body) -> float:
    """Draw two bodies that fly until they touch, and return the time."""
    impact = time_of_impact(a, b)
    ends = []
    for name, body, colour in (("a", a, FIRST), ("b", b, SECOND)):
        end = body.position + impact.time * body.velocity
        if body.velocity.any():
            region(axes, f"{name}-start", body.collider, body.position, colour, ghost=True)
            line(axes, f"{name}-way", body.position, end, colour)
            dot(axes, f"{name}-from", body.position, colour, 1.2)
        region(axes, name, body.collider, end, colour)
        ends.append(end)
    point = touch(a.collider, b.collider, ends[0], ends[1], impact.normal)
    arrow(axes, "normal", point, point + 0.75 * impact.normal, width=1.1, head=6.0)
    dot(axes, "point", point, ACCENT, 1.4)
    return impact.time


def touch(
    a: Collider, b: Collider, position_a: np.ndarray, position_b: np.ndarray, normal: np.ndarray
) -> np.ndarray:
    """Return where two regions touch."""
    shapes, edges = shape_table((a, b))
    offset = position_b - position_a
    return position_a + touching_point(shapes, edges, 0, 1, *offset, *normal)


def disc_disc() -> Figure:
    """Draw the closed form: a point against the disc of both radii."""
    drawn = figure(6.6, 2.9)
    a = Body(Particle(0.9), (0.0, 0.0))
    b = Body(Particle(0.6), (-3.1, 1.75), (1.0, -0.25))
    view = (-4.1, -2.0, 2.1, 2.9)
    axes = panel(drawn, (0.1, 0.1, 3.15, 2.49), view, "discs", "two discs")
    draw_flight(axes, a, b)
    axes = panel(drawn, (3.35, 0.1, 3.15, 2.49), view, "point", "a point and a disc of both radii")
    reach = a.collider.radius + b.collider.radius
    impact = time_of_impact(a, b)
    course = b.velocity / math.hypot(*b.velocity)
    foot = b.position - course * (b.position @ course)
    enter = b.position + b.velocity * impact.time
    region(axes, "sum", Particle(reach), (0.0, 0.0), GREY)
    line(axes, "way", b.position, enter, SECOND, linewidth=1.3)
    line(axes, "half-chord", enter, foot, INK, linewidth=1.3)
    line(axes, "miss", (0.0, 0.0), foot, FIRST, linewidth=1.3)
    line(axes, "radius", (0.0, 0.0), enter, GREY)
    arrow(axes, "normal", enter, enter + 0.8 * reach * impact.normal, head=6.0)
    for name, at, colour in (
        ("start", b.position, SECOND),
        ("enter", enter, ACCENT),
        ("foot", foot, INK),
        ("centre", (0.0, 0.0), FIRST),
    ):
        dot(axes, name, at, colour)
    label(axes, b.position, "$p$", SECOND, shift=(0.0, 0.25), fontsize=10)
    label(axes, 0.5 * (enter + foot), "$h$", INK, shift=(0.05, 0.22), fontsize=10)
    tip = enter + 0.8 * reach * impact.normal
    label(axes, tip, "$n$", INK, shift=(0.22, 0.1), fontsize=10)
    label(axes, 0.5 * foot, "$m$", FIRST, shift=(0.22, -0.08), fontsize=10)
    label(axes, 0.5 * enter, "$R$", GREY, shift=(-0.05, -0.22), fontsize=10)
    middle = 0.5 * (b.position + enter)
    label(axes, middle, "$t\\,v$", SECOND, shift=(0.1, 0.25), fontsize=10)
    return drawn


QUADRILATERAL = Convex([(-1.2, -0.9), (1.3, -1.1), (1.0, 0.7), (-0.6, 1.0)])


def disc_convex() -> Figure:
    """Draw a disc against a face, against the corner beyond it, and past both."""
    drawn = figure(7.5, 2.75)
    flights = (
        ("the last line, crossed at its face", (1.0, -0.9)),
        ("beyond its end: the corner is hit", (1.0, -0.52)),
        ("beyond its end: the corner is missed", (0.4, -1.16)),
    )
    start = (-3.1, 2.6)
    radius = 0.55
    for index, (title, velocity) in enumerate(flights):
        box = (0.1 + 2.47 * index, 0.1, 2.37, 2.37)
        axes = panel(drawn, box, (-3.9, -2.5, 1.9, 3.3), f"face-{index}", title)
        rounded(axes, "sum", QUADRILATERAL, radius, GREY)
        region(axes, "b", QUADRILATERAL, (0.0, 0.0), SECOND)
        ball = Body(Particle(radius), start, velocity)
        draw_line_crossings(axes, ball)
        impact = time_of_impact(ball, Body(QUADRILATERAL))
        region(axes, "start", ball.collider, ball.position, FIRST, ghost=True)
        time = impact.time if impact else 4.2
        end = ball.position + time * ball.velocity
        line(axes, "way", ball.position, end, FIRST)
        if impact:
            region(axes, "a", ball.collider, end, FIRST)
            surface = end + radius * impact.normal
            arrow(axes, "normal", surface, surface + 0.9 * impact.normal, head=6.0)
    return drawn


def draw_line_crossings(axes: Axes, ball: Body) -> None:
    """Draw where the centre crosses each face's line, moved by the radius. The last one decides."""
    times = {}
    for index, edge in enumerate(QUADRILATERAL.edges):
        normal = np.array((edge.normal_x, edge.normal_y))
        gap = normal @ ball.position - edge.offset - ball.collider.radius
        if gap >= 0.0:
            times[index] = gap / -(normal @ ball.velocity)
    last = max(times, key=times.__getitem__)
    for index, time in times.items():
        edge = QUADRILATERAL.edges[index]
        shift = ball.collider.radius * np.array((edge.normal_x, edge.normal_y))
        along = np.array((-edge.normal_y, edge.normal_x)) * 9.0
        middle = shift + np.array((edge.start_x, edge.start_y))
        style = {"linestyle": (0, (4, 2)), "linewidth": 1.0 if index == last else 0.6}
        line(
            axes,
            f"line-{index}",
            middle - along,
            middle + along,
            INK if index == last else GREY,
            **style,
        )
        colour, size = (ACCENT, 2.4) if index == last else (GREY, 1.6)
        dot(axes, f"crossing-{index}", ball.position + time * ball.velocity, colour, size)


def axes_in_time() -> Figure:
    """Draw when each separating axis has no gap. The impact is when the last gap closes."""
    drawn = figure(7.4, 2.9)
    a = Body(Rectangle(1.8, 1.1, 0.45), (-0.9, -0.9))
    b = Body(Convex(TRIANGLE, rotation=0.3), (1.1, 1.0), (-0.8, -0.65))
    axes = panel(drawn, (0.1, 0.35, 2.4, 2.2), (-2.4, -2.2, 2.4, 2.2), "flight", "convex, convex")
    time = draw_flight(axes, a, b)
    span = 5.5
    axes = panel(
        drawn, (3.1, 0.35, 4.2, 2.2), (0.0, -0.7, span, 6.7), "times", "when each axis has no gap"
    )
    shapes, edges = shape_table((a.collider, b.collider))
    count = len(a.collider.edges)
    leaves = []
    for axis in range(count + len(b.collider.edges)):
        x, y, gap = separation_along(shapes, edges, 0, 1, axis, *(b.position - a.position))
        speed = x * b.velocity[0] + y * b.velocity[1]
        enter, leave = 0.0, span
        if gap >= 0.0:
            enter = gap / -speed
        elif speed > 0.0:
            leave = min(leave, gap / -speed)
            leaves.append(leave)
        level, colour = 6.0 - axis, FIRST if axis < count else SECOND
        width = {"linewidth": 5.0, "solid_capstyle": "butt"}
        line(axes, f"axis-{axis}", (enter, level), (leave, level), colour, **width)
        owner = f"$a$, edge {axis}" if axis < count else f"$b$, edge {axis - count}"
        label(axes, (-0.1, level), owner, colour, fontsize=7.0, ha="right")
    line(axes, "impact", (time, -0.7), (time, 6.7), ACCENT, linewidth=1.1)
    line(axes, "apart", (min(leaves), -0.7), (min(leaves), 6.7), GREY, linewidth=1.1)
    label(axes, (time, -1.05), f"$t$ = {time:.3f}: the last gap closes", ACCENT, fontsize=7.0)
    label(axes, (min(leaves), -1.05), "the first opens again", GREY, fontsize=7.0)
    return drawn


def bounces() -> Figure:
    """Draw velocities before and after a bounce, with their parts along the normal."""
    drawn = figure(6.6, 2.75)
    heavy = Body(Particle(0.8), (-0.65, -0.25), (0.45, -0.6), mass=2.0)
    light = Body(Particle(0.55), (0.65, 0.1105), (-0.85, 0.3), mass=1.0)
    normal = (light.position - heavy.position) / math.hypot(*(light.position - heavy.position))
    for index, title in enumerate(("before", "after")):
        if index:
            bounce(heavy, light, normal)
        box = (0.1 + 3.25 * index, 0.1, 3.1, 2.32)
        axes = panel(drawn, box, (-2.2, -1.5, 2.2, 1.8), title, title)
        line(axes, "along", heavy.position - 2 * normal, heavy.position + 4 * normal, FAINT)
        for name, body, colour in (("1", heavy, FIRST), ("2", light, SECOND)):
            region(axes, name, body.collider, body.position, colour)
            part = body.position + (body.velocity @ normal) * normal
            tip = body.position + body.velocity
            line(axes, f"{name}-across", part, tip, colour, linestyle=(0, (2, 2)))
            arrow(axes, f"{name}-part", body.position, part, colour, 2.2, 8.0)
            arrow(axes, f"{name}-velocity", body.position, tip, INK, 1.0, 6.0)
            above = math.copysign(0.18, body.velocity[1])
            label(axes, tip, f"$v_{name}$", shift=(0.0, above), fontsize=9)
    return drawn
