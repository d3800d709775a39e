"""All that the engine says of two bodies: the steps of `operations`, by the same kernels."""

import math
from typing import Any

import numpy as np

from ..kernels import kernel
from ..kernels.portable import array_at
from ..pairs.response import bounce_velocities, shares
from ..pairs.table import ALGORITHM, contact_between, impact_between
from ..pairs.touching import margin_along, touch_margins
from ..pairs.touching_point import touching_point
from ..shapes.records import Edge, Edges, Shape, Shapes
from .patterns import TURNS
from .placing import outline_figure, place_figure
from .records import MAX_EDGES, Meeting

_FLOAT = np.dtype(np.float64)
_SHAPES = int(Meeting.fields["shapes"][1])  # type: ignore[index]
_EDGES = int(Meeting.fields["edges"][1])  # type: ignore[index]


@kernel
def meet_figures(address: int, meeting: Any) -> None:
    """Write everything that follows from the two bodies of a meeting, which lies at an address."""
    shapes = array_at(address + _SHAPES, (2,), Shape)
    edges = array_at(address + _EDGES, (2 * MAX_EDGES,), Edge)
    patterns = array_at(meeting.patterns, (meeting.number_of_patterns,), Shape)
    pattern_edges = array_at(meeting.pattern_edges, (meeting.number_of_edges,), Edge)
    turns = array_at(meeting.turns, (TURNS, 2), _FLOAT)
    a, b = meeting.a, meeting.b
    shapes[0].first = 0
    shapes[1].first = MAX_EDGES
    place_figure(a, patterns[a.pattern], pattern_edges, turns, shapes[0], edges)
    place_figure(b, patterns[b.pattern], pattern_edges, turns, shapes[1], edges)
    outline_figure(a, shapes[0], edges, meeting.scratch)
    outline_figure(b, shapes[1], edges, meeting.scratch)
    meeting.algorithm = ALGORITHM[shapes[0].kind, shapes[1].kind]
    _touch(meeting, a, b, shapes, edges)
    _relax(meeting, a, b)
    _fly(meeting, a, b, shapes, edges)
    _bounce(meeting, a, b)


@kernel
def _touch(meeting: Any, a: Any, b: Any, shapes: Shapes, edges: Edges) -> None:
    """Write whether and how the two overlap, and when and how they meet."""
    dx, dy = b.x - a.x, b.y - a.y
    margin_x, margin_y = touch_margins(shapes, edges, 0, 1, a.x, a.y, b.x, b.y)
    found, normal_x, normal_y, depth, x, y = contact_between(
        shapes, edges, 0, 1, dx, dy, margin_x, margin_y
    )
    meeting.overlap = 1 if found else 0
    meeting.normal_x = normal_x
    meeting.normal_y = normal_y
    meeting.depth = depth
    meeting.point_x = a.x + x
    meeting.point_y = a.y + y
    time, normal_x, normal_y = impact_between(
        shapes, edges, 0, 1, dx, dy, b.vx - a.vx, b.vy - a.vy, math.inf, margin_x, margin_y
    )
    meeting.time = time
    meeting.impact_normal_x = normal_x
    meeting.impact_normal_y = normal_y
    meeting.touching = 0
    if time < math.inf:
        way = time * ((a.vx - b.vx) * normal_x + (a.vy - b.vy) * normal_y)
        meeting.touching = 1 if way <= margin_along(normal_x, normal_y, margin_x, margin_y) else 0


@kernel
def _inverse(mass: float) -> float:
    """Return 1 / mass, 0 for a static body."""
    return 1.0 / mass if mass > 0.0 else 0.0


@kernel
def _relax(meeting: Any, a: Any, b: Any) -> None:
    """Write where relaxation moves the two."""
    share_a, share_b = shares(_inverse(a.mass), _inverse(b.mass))
    a.share = share_a
    b.share = share_b
    way = meeting.depth if meeting.depth < math.inf else 0.0
    a.relaxed_x = a.x - way * share_a * meeting.normal_x
    a.relaxed_y = a.y - way * share_a * meeting.normal_y
    b.relaxed_x = b.x + way * share_b * meeting.normal_x
    b.relaxed_y = b.y + way * share_b * meeting.normal_y


@kernel
def _fly(meeting: Any, a: Any, b: Any, shapes: Shapes, edges: Edges) -> None:
    """Write where the two are at the time of impact, and where they touch."""
    time = meeting.time if meeting.time < math.inf else 0.0
    a.impact_x = a.x + time * a.vx
    a.impact_y = a.y + time * a.vy
    b.impact_x = b.x + time * b.vx
    b.impact_y = b.y + time * b.vy
    meeting.impact_point_x = meeting.point_x
    meeting.impact_point_y = meeting.point_y
    if time > 0.0:
        dx, dy = b.impact_x - a.impact_x, b.impact_y - a.impact_y
        normal_x, normal_y = meeting.impact_normal_x, meeting.impact_normal_y
        x, y = touching_point(shapes, edges, 0, 1, dx, dy, normal_x, normal_y)
        meeting.impact_point_x = a.impact_x + x
        meeting.impact_point_y = a.impact_y + y


@kernel
def _bounce(meeting: Any, a: Any, b: Any) -> None:
    """Write the velocities after a bounce at the time of impact."""
    normal_x, normal_y = meeting.impact_normal_x, meeting.impact_normal_y
    meeting.restitution = a.restitution * b.restitution
    meeting.approach = (a.vx - b.vx) * normal_x + (a.vy - b.vy) * normal_y
    a.bounced_vx, a.bounced_vy, b.bounced_vx, b.bounced_vy, meeting.impulse = bounce_velocities(
        a.vx,
        a.vy,
        b.vx,
        b.vy,
        _inverse(a.mass),
        _inverse(b.mass),
        normal_x,
        normal_y,
        meeting.restitution,
    )
