"""The six colliders: immutable regions in body coordinates, which a body's position translates."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import index
from typing import Any, ClassVar, Literal

from ..arguments import Vector, finite, not_negative, positive, vector
from . import records
from .boundary import BoundaryEdge, Line, boundary, boundary_edge, polygon_lines


class Collider(ABC):
    """A rounded convex region. Immutable, hashable, and equal to another one with the same data."""

    #: Its row and column in the dispatch table, one of the kinds in `records`.
    kind: ClassVar[int]

    @property
    @abstractmethod
    def edges(self) -> tuple[BoundaryEdge, ...]:
        """The edges of its core, counterclockwise; none for a disc."""

    @property
    def rounding(self) -> float:
        """How far the region reaches beyond its core: a disc's radius, 0 for the others."""
        return 0.0


@dataclass(frozen=True)
class Particle(Collider):
    """A disc about the body's position.

    Args:
        radius: not negative. With radius 0 it is a point, which hits every region with an inside.
    """

    radius: float
    kind: ClassVar[int] = records.PARTICLE

    def __post_init__(self) -> None:
        _set(self, "radius", not_negative("radius", self.radius))

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        """None: the core is a point."""
        return ()

    @property
    def rounding(self) -> float:
        """The radius."""
        return self.radius


@dataclass(frozen=True)
class HalfPlane(Collider):
    """The half-plane ``normal . p <= offset``; the normal points out of it.

    Normal and offset are both divided by the normal's length: the region stays the same.

    Args:
        normal: (x, y), of any length but 0.
        offset: the boundary's distance from the body's position, times the normal's length.
    """

    normal: Vector
    offset: float = 0.0
    kind: ClassVar[int] = records.HALF_PLANE

    def __post_init__(self) -> None:
        x, y = vector("normal", self.normal)
        length = math.hypot(x, y)
        if length == 0.0:
            raise ValueError(f"normal must have a direction, but is {self.normal!r}")
        _set(self, "normal", (x / length, y / length))
        _set(self, "offset", finite("offset", self.offset) / length)

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        """Its one edge, a whole line."""
        return (boundary_edge(Line(self.normal, self.offset), None, None),)


_DIRECTIONS: dict[str, Vector] = {
    "+x": (1.0, 0.0),
    "-x": (-1.0, 0.0),
    "+y": (0.0, 1.0),
    "-y": (0.0, -1.0),
}


@dataclass(frozen=True)
class AxisAlignedHalfPlane(Collider):
    """A half-plane whose boundary is parallel to an axis.

    Args:
        direction: where its outward normal points, ``"+x"``, ``"-x"``, ``"+y"`` or ``"-y"``. A
            floor, for instance, is ``"+y"``.
        offset: the boundary's distance from the body's position, in that direction.
    """

    direction: Literal["+x", "-x", "+y", "-y"]
    offset: float = 0.0
    kind: ClassVar[int] = records.AXIS_ALIGNED_HALF_PLANE

    def __post_init__(self) -> None:
        if not isinstance(self.direction, str) or self.direction not in _DIRECTIONS:
            raise ValueError(
                f"direction must be one of {', '.join(_DIRECTIONS)}, but is {self.direction!r}"
            )
        _set(self, "offset", finite("offset", self.offset))

    @property
    def normal(self) -> Vector:
        """The outward unit normal."""
        return _DIRECTIONS[self.direction]

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        """Its one edge, a whole line."""
        return (boundary_edge(Line(self.normal, self.offset), None, None),)


@dataclass(frozen=True)
class AxisAlignedRectangle(Collider):
    """A rectangle, centred on the body's position, whose sides are parallel to the axes.

    Args:
        width: its whole extent along x, greater than 0.
        height: its whole extent along y, greater than 0.
    """

    width: float
    height: float
    kind: ClassVar[int] = records.AXIS_ALIGNED_RECTANGLE

    def __post_init__(self) -> None:
        _set(self, "width", positive("width", self.width))
        _set(self, "height", positive("height", self.height))

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        """Right, upper, left and lower side."""
        return self._edges

    @cached_property
    def _edges(self) -> tuple[BoundaryEdge, ...]:
        return _rectangle_edges(self.width, self.height, (1.0, 0.0))


@dataclass(frozen=True)
class Rectangle(Collider):
    """A rectangle of any orientation, centred on the body's position.

    Args:
        width: its extent along its own first axis, greater than 0.
        height: its extent along its own second axis, greater than 0.
        rotation: counterclockwise, radians. Quarter turns are exact.
    """

    width: float
    height: float
    rotation: float = 0.0
    kind: ClassVar[int] = records.RECTANGLE

    def __post_init__(self) -> None:
        _set(self, "width", positive("width", self.width))
        _set(self, "height", positive("height", self.height))
        _set(self, "rotation", finite("rotation", self.rotation))

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        """Its sides, first the one toward its first axis."""
        return self._edges

    @cached_property
    def _edges(self) -> tuple[BoundaryEdge, ...]:
        return _rectangle_edges(self.width, self.height, turned_axis(self.rotation))


@dataclass(frozen=True, init=False, repr=False)
class Convex(Collider):
    """A convex polygon, closed or open to infinity: the intersection of its edges' half-planes.

    Edges on one line are joined, and redundant ones removed. An edge whose neighbour is missing
    ends where it meets the next edge, if it does. Two regions with the same edges are equal.

    Args:
        vertices: counterclockwise, in body coordinates; at least three (two for a single edge).
            Edge ``i`` runs from vertex ``i`` to the next one, the last edge to vertex 0.
        open_edges: indices of the missing edges: the region extends to infinity there.
        rotation: of the vertices about the body's position, counterclockwise, radians.

    Raises:
        ValueError: if the polygon is degenerate, clockwise or not convex, if no edge remains, or if
            the region is empty.
    """

    _edges: tuple[BoundaryEdge, ...]
    kind: ClassVar[int] = records.CONVEX

    def __init__(
        self,
        vertices: Sequence[Sequence[float]],
        open_edges: Iterable[int] = (),
        rotation: float = 0.0,
    ) -> None:
        points = [vector(f"vertices[{i}]", vertex) for i, vertex in enumerate(vertices)]
        missing = _edge_indices(open_edges, len(points))
        if len(points) < (2 if missing else 3):
            raise ValueError(
                f"vertices must be at least three (two if one edge is open), but are {len(points)}"
            )
        axis = turned_axis(finite("rotation", rotation))
        turned = [(axis[0] * x - axis[1] * y, axis[1] * x + axis[0] * y) for x, y in points]
        lines = polygon_lines(turned, missing)
        if missing:
            edges = boundary(lines)
        else:
            edges = tuple(boundary_edge(line, line.start, line.end) for line in lines)
        _set(self, "_edges", _from_least_corner(edges))

    @classmethod
    def from_half_planes(
        cls, *half_planes: HalfPlane | AxisAlignedHalfPlane | Iterable[Any]
    ) -> "Convex":
        """Return the intersection of half-planes, given one by one or in one list.

        Raises:
            ValueError: if there are none, or they have no inside in common.
        """
        given: Iterable[Any] = half_planes
        if len(half_planes) == 1 and isinstance(half_planes[0], Iterable):
            given = half_planes[0]
        lines = []
        for half_plane in given:
            if not isinstance(half_plane, HalfPlane | AxisAlignedHalfPlane):
                raise TypeError(f"half_planes must be half-planes, but one is {half_plane!r}")
            lines.append(Line(half_plane.normal, half_plane.offset))
        if not lines:
            raise ValueError("half_planes must be at least one, but there are none")
        convex = cls.__new__(cls)
        _set(convex, "_edges", _from_least_corner(boundary(lines)))
        return convex

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        """The remaining edges, counterclockwise; an open chain's from end to end."""
        return self._edges

    @cached_property
    def vertices(self) -> tuple[Vector, ...]:
        """The corners, counterclockwise: as many as there are edges, or fewer if it is open."""
        return tuple((edge.start_x, edge.start_y) for edge in self.edges if edge.has_start)

    @cached_property
    def half_planes(self) -> tuple[HalfPlane, ...]:
        """The half-planes whose intersection it is, counterclockwise and without redundant ones."""
        return tuple(HalfPlane((e.normal_x, e.normal_y), e.offset) for e in self.edges)

    @property
    def is_open(self) -> bool:
        """Whether it extends to infinity."""
        return len(self.vertices) < len(self.edges)

    @cached_property
    def _hash(self) -> int:
        return hash(self._edges)

    def __hash__(self) -> int:
        return self._hash

    def __repr__(self) -> str:
        if self.is_open:
            return f"Convex.from_half_planes({', '.join(map(repr, self.half_planes))})"
        return f"Convex(vertices={self.vertices})"


def turned_axis(rotation: float) -> Vector:
    """Return (cos, sin) of an angle in radians, exact for multiples of a quarter turn.

    An angle within rounding of such a multiple counts as that multiple.
    """
    quarters = round(rotation / (0.5 * math.pi))
    if abs(rotation - quarters * (0.5 * math.pi)) <= 4.0 * math.ulp(rotation):
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[quarters % 4]
    return math.cos(rotation), math.sin(rotation)


def _rectangle_edges(width: float, height: float, axis: Vector) -> tuple[BoundaryEdge, ...]:
    """Return the sides of a centred rectangle; ``axis`` is its own first axis, a unit vector."""
    x, y = axis
    normals = ((x, y), (-y, x), (-x, -y), (y, -x))
    offsets = (0.5 * width, 0.5 * height, 0.5 * width, 0.5 * height)
    lines = [Line(normal, offset) for normal, offset in zip(normals, offsets, strict=True)]
    corners = []
    for line, following in zip(lines, (*lines[1:], lines[0]), strict=True):
        corners.append(
            (
                line.offset * line.normal[0] + following.offset * following.normal[0],
                line.offset * line.normal[1] + following.offset * following.normal[1],
            )
        )
    return tuple(boundary_edge(line, corners[i - 1], corners[i]) for i, line in enumerate(lines))


def _from_least_corner(edges: tuple[BoundaryEdge, ...]) -> tuple[BoundaryEdge, ...]:
    """Return a closed region's edges from its leftmost corner on: equal regions compare equal."""
    if not all(edge.has_start for edge in edges):
        return edges
    first = min(range(len(edges)), key=lambda i: (edges[i].start_x, edges[i].start_y))
    return edges[first:] + edges[:first]


def _edge_indices(open_edges: Iterable[int], count: int) -> frozenset[int]:
    """Check the indices of missing edges and return them."""
    indices = [index(edge) for edge in open_edges]
    for position in indices:
        if not 0 <= position < count:
            raise ValueError(
                f"open_edges names edge {position}, but there are edges 0 to {count - 1} only"
            )
    return frozenset(indices)


def _set(collider: Collider, name: str, value: Any) -> None:
    """Set a field of an immutable collider while it is being built."""
    object.__setattr__(collider, name, value)
