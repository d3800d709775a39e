"""Tools for drawing the figures: regions, arrows, panels. All geometry is the engine's.

Every artist has a name, which becomes the `id` of its group in the SVG file. A test compares the
figures by these names.
"""

import io
import math
import re
from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl

mpl.use("svg")

from arkanoid.physics import AxisAlignedHalfPlane, Collider, Convex, HalfPlane
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, Polygon

Point = Sequence[float]

# Almost everyone can distinguish blue and orange, and their brightness differs, too, for print.
FIRST = "#2f6fb0"
SECOND = "#e08a2c"
INK = "#1d2530"
GREY = "#7d8894"
FAINT = "#d6dbe1"
PAPER = "#fbfbfa"
ACCENT = "#b3262f"

# Two regions that several figures show.
PENTAGON = [(-1.0, -0.6), (0.35, -1.0), (1.1, 0.1), (0.3, 1.0), (-0.8, 0.7)]
TRIANGLE = [(-0.9, -0.8), (1.1, -0.5), (-0.1, 1.0)]

POINTS_PER_INCH = 72.0
ARC_STEPS = 16

mpl.rcParams.update(
    {
        "svg.hashsalt": "arkanoid",  # the same ids in every run
        "svg.fonttype": "path",  # the same letters on every machine
        "path.simplify": False,
        "font.family": "DejaVu Sans",  # comes with matplotlib
        "font.size": 8.0,
        "mathtext.fontset": "stix",
        "text.color": INK,
        "lines.solid_capstyle": "round",
        "axes.unicode_minus": False,
    }
)


def figure(width: float, height: float) -> Figure:
    """Return an empty figure of a size in inches."""
    return Figure(figsize=(width, height), facecolor="white")


def save(drawn: Figure, path: Path) -> None:
    """Write a figure as SVG, with few digits, and the same bytes in every run."""
    text = io.StringIO()
    drawn.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    path.write_text(shortened(text.getvalue()), encoding="utf-8")


def shortened(text: str) -> str:
    """Round the numbers of an SVG to two digits, except scale factors: letters would grow."""
    return re.sub(
        r"scale\([^)]*\)|\d+\.\d{3,}",
        lambda found: found[0] if found[0].startswith("s") else f"{float(found[0]):.2f}",
        text,
    )


def panel(
    drawn: Figure, box: Sequence[float], view: Sequence[float], name: str, title: str = ""
) -> Axes:
    """Return a framed panel.

    Args:
        drawn: the figure.
        box: left, bottom, width, height in inches.
        view: left, bottom, right and top of the part of the world that it shows.
        name: the names of all artists in the panel begin with it and a full stop.
        title: text above the panel.
    """
    width, height = drawn.get_size_inches()
    left, bottom, across, up = box
    axes = drawn.add_axes((left / width, bottom / height, across / width, up / height), label=name)
    axes.set(xlim=(view[0], view[2]), ylim=(view[1], view[3]), xticks=[], yticks=[])
    axes.set_facecolor(PAPER)
    for spine in axes.spines.values():
        spine.set(color=FAINT, linewidth=0.8)
    if title:
        axes.set_title(title, fontsize=8.0, pad=4.0)
    return axes


def named(axes: Axes, artist: Polygon | Circle | FancyArrowPatch, name: str) -> None:
    """Add an artist to a panel under a name."""
    artist.set_gid(f"{axes.get_label()}.{name}")
    axes.add_artist(artist)


def half_planes(collider: Collider, position: Point) -> list[HalfPlane]:
    """Return the half-planes that bound a region without rounding, in world coordinates."""
    return [
        HalfPlane(
            (edge.normal_x, edge.normal_y),
            edge.offset + edge.normal_x * position[0] + edge.normal_y * position[1],
        )
        for edge in collider.edges
    ]


def outline(axes: Axes, collider: Collider, position: Point) -> list[tuple[float, float]]:
    """Return the corners of a region, cut off at the panel's edges by the engine."""
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    window = [
        AxisAlignedHalfPlane("-x", -left),
        AxisAlignedHalfPlane("+x", right),
        AxisAlignedHalfPlane("-y", -bottom),
        AxisAlignedHalfPlane("+y", top),
    ]
    return list(Convex.from_half_planes(*half_planes(collider, position), *window).vertices)


def region(
    axes: Axes,
    name: str,
    collider: Collider,
    position: Point,
    colour: str,
    *,
    ghost: bool = False,
    fill: float = 0.22,
) -> None:
    """Draw a region at a position; a ghost (a past or future place) is a dashed outline."""
    style = {"linewidth": 0.9, "linestyle": (0, (2.5, 1.8))} if ghost else {"linewidth": 1.4}
    if collider.rounding:
        named(axes, Circle(position, collider.rounding, fc="none", ec=colour, **style), name)
        if not ghost:
            disc = Circle(position, collider.rounding, fc=colour, alpha=fill, ec="none")
            named(axes, disc, f"{name}.fill")
        return
    if not ghost:
        corners = outline(axes, collider, position)
        named(axes, Polygon(corners, fc=colour, alpha=fill, ec="none"), f"{name}.fill")
    for index, edge in enumerate(collider.edges):
        start = (position[0] + edge.start_x, position[1] + edge.start_y)
        end = (position[0] + edge.end_x, position[1] + edge.end_y)
        if not edge.has_start:
            start = border(axes, start, (edge.normal_y, -edge.normal_x))
        if not edge.has_end:
            end = border(axes, end, (-edge.normal_y, edge.normal_x))
        line(axes, f"{name}.{index}", start, end, colour, **style)


def border(axes: Axes, start: Point, direction: Point) -> tuple[float, float]:
    """Return where a ray that starts in a panel leaves it."""
    way = math.inf
    for begin, step, limits in zip(
        start, direction, (axes.get_xlim(), axes.get_ylim()), strict=True
    ):
        if step:
            way = min(way, (limits[step > 0.0] - begin) / step)
    return start[0] + way * direction[0], start[1] + way * direction[1]


def rounded(axes: Axes, name: str, collider: Collider, radius: float, colour: str) -> None:
    """Draw a closed region about the origin, rounded by a radius: its corners become arcs."""
    corners = []
    for index, edge in enumerate(collider.edges):
        following = collider.edges[(index + 1) % len(collider.edges)]
        begin = math.atan2(edge.normal_y, edge.normal_x)
        turn = (math.atan2(following.normal_y, following.normal_x) - begin) % math.tau
        for step in range(ARC_STEPS + 1):
            angle = begin + turn * step / ARC_STEPS
            corners.append(
                (edge.end_x + radius * math.cos(angle), edge.end_y + radius * math.sin(angle))
            )
    named(axes, Polygon(corners, fc=colour, alpha=0.15, ec="none"), f"{name}.fill")
    named(axes, Polygon(corners, fc="none", ec=colour, linewidth=0.9), name)


def line(
    axes: Axes, name: str, start: Point, end: Point, colour: str = GREY, **style: object
) -> None:
    """Draw a straight line."""
    settings = {"linewidth": 0.8, "color": colour, **style}
    axes.plot([start[0], end[0]], [start[1], end[1]], gid=f"{axes.get_label()}.{name}", **settings)


def arrow(
    axes: Axes,
    name: str,
    start: Point,
    end: Point,
    colour: str = INK,
    width: float = 1.3,
    head: float = 7.0,
) -> None:
    """Draw an arrow from start to end."""
    shape = FancyArrowPatch(
        start,
        end,
        arrowstyle="-|>,head_width=0.28,head_length=0.5",
        mutation_scale=head,
        shrinkA=0,
        shrinkB=0,
        color=colour,
        linewidth=width,
        joinstyle="miter",
        capstyle="butt",
        zorder=5,
    )
    named(axes, shape, name)


def dot(axes: Axes, name: str, at: Point, colour: str = INK, size: float = 1.7) -> None:
    """Draw a dot; its size is a radius in points, independent of the panel's scale."""
    left, right = axes.get_xlim()
    across = axes.get_position().width * axes.figure.get_size_inches()[0] * POINTS_PER_INCH
    named(
        axes,
        Circle(at, size * (right - left) / across, fc=colour, ec="white", lw=0.4, zorder=6),
        name,
    )


def label(
    axes: Axes,
    at: Point,
    text: str,
    colour: str = INK,
    *,
    shift: Point = (0.0, 0.0),
    **style: object,
) -> None:
    """Write text at a point of the world, moved by a shift."""
    settings = {"fontsize": 7.5, "ha": "center", "va": "center", "zorder": 7, **style}
    axes.text(at[0] + shift[0], at[1] + shift[1], text, color=colour, **settings)
