"""Contacts against an oracle that shares nothing with the engine: GEOS, through Shapely.

Two convex regions overlap exactly if the difference of their positions is in their Minkowski
difference, and the shortest separating translation goes to its boundary. The oracle builds that
polygon as the convex hull of vertex differences, and GEOS measures distances. Open regions are cut
off far away; discs are points about which the polygon is rounded.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numba
import numpy as np
import numpy.typing as npt
import pytest
import shapely
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
)
from arkanoid.physics.pairs.table import contact_between, overlap_between
from arkanoid.physics.shapes.table import shape_table
from scipy.optimize import linprog

Array = npt.NDArray[Any]

# Where the oracle cuts off open regions: at two distances, to recognise a depth due to the cut.
FAR = (1e3, 2e3)
DISAGREEMENT = 1e-9  # depths at which the engine and the oracle may disagree on overlap


@dataclass(frozen=True)
class Region:
    """A collider and, built another way, its core: the vertices, cut off far and farther away."""

    collider: Collider
    cores: tuple[Array, ...]  # of [n, 2]
    radius: float = 0.0
    is_open: bool = False


def turn(points: Array, angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def cut(normals: Array, offsets: Array, scale: float) -> tuple[Array, ...]:
    """Return the vertices of an intersection of half-planes, cut off far and farther away."""
    cores = []
    for far in np.multiply(FAR, scale):
        region = shapely.box(-far, -far, far, far)
        for normal, offset in zip(normals, offsets, strict=True):
            along = np.array([-normal[1], normal[0]])
            foot = normal * offset
            strip = [foot - 4 * far * along, foot + 4 * far * along]
            behind = [corner - 4 * far * normal for corner in reversed(strip)]
            region = region.intersection(shapely.Polygon([*strip, *behind]))
        cores.append(shapely.get_coordinates(region)[:-1])
    return tuple(cores)


def random_particle(rng: np.random.Generator, scale: float) -> Region:
    radius = scale * rng.uniform(0.05, 1.5)
    return Region(Particle(radius), (np.zeros((1, 2)),), radius)


def random_half_plane(rng: np.random.Generator, scale: float) -> Region:
    normal = turn(np.array([1.0, 0.0]), rng.uniform(0, 2 * np.pi))
    offset, length = scale * rng.normal(), rng.uniform(0.1, 9)
    collider = HalfPlane(normal * length, offset * length)
    return Region(collider, cut(normal[None], np.array([offset]), scale), is_open=True)


def random_axis_aligned_half_plane(rng: np.random.Generator, scale: float) -> Region:
    name = str(rng.choice(["+x", "-x", "+y", "-y"]))
    sign = 1.0 if name[0] == "+" else -1.0
    normal = sign * np.array([name[1] == "x", name[1] == "y"], float)
    offset = scale * rng.normal()
    collider = AxisAlignedHalfPlane(name, offset)  # type: ignore[arg-type]
    return Region(collider, cut(normal[None], np.array([offset]), scale), is_open=True)


def box_corners(width: float, height: float) -> Array:
    return 0.5 * np.array([[width, height], [-width, height], [-width, -height], [width, -height]])


def random_box(rng: np.random.Generator, scale: float) -> Region:
    width, height = scale * rng.uniform(0.05, 3, 2)
    return Region(AxisAlignedRectangle(width, height), (box_corners(width, height),))


def random_rectangle(rng: np.random.Generator, scale: float) -> Region:
    width, height = scale * rng.uniform(0.05, 3, 2)
    rotation = rng.choice([rng.uniform(-7, 7), rng.integers(-4, 5) * np.pi / 2])
    return Region(Rectangle(width, height, rotation), (turn(box_corners(width, height), rotation),))


def ellipse_polygon(rng: np.random.Generator, count: int) -> Array:
    """Return a convex polygon with no nearly straight corners, not about its centre."""
    while True:
        angles = np.sort(rng.uniform(0, 2 * np.pi, count))
        if np.diff(angles, append=angles[0] + 2 * np.pi).min() > 0.2:
            break
    points = np.column_stack([np.cos(angles), np.sin(angles)]) * rng.uniform(0.2, 2, 2)
    return points + rng.normal(0, 0.5, 2)


def random_convex(rng: np.random.Generator, scale: float) -> Region:
    points = scale * ellipse_polygon(rng, int(rng.integers(3, 9)))
    rotation = rng.uniform(-7, 7)
    return Region(Convex(points.tolist(), rotation=rotation), (turn(points, rotation),))


def random_open_convex(rng: np.random.Generator, scale: float) -> Region:
    """Return a polygon without some edges; sometimes the others meet again, or form a strip."""
    count = int(rng.integers(3, 8))
    points = ellipse_polygon(rng, count)
    if rng.random() < 0.2:
        count, points = 4, box_corners(*rng.uniform(0.2, 3, 2)) + rng.normal(0, 0.5, 2)
    points = scale * points
    missing = rng.permutation(count)[: rng.integers(1, count)].tolist()
    rotation = rng.choice([rng.uniform(-7, 7), rng.integers(-4, 5) * np.pi / 2])
    turned = turn(points, rotation)
    edges = np.roll(turned, -1, axis=0) - turned
    normals = np.column_stack([edges[:, 1], -edges[:, 0]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = (normals * turned).sum(axis=1)
    there = [i for i in range(count) if i not in missing]
    collider = Convex(points.tolist(), missing, rotation)
    return Region(collider, cut(normals[there], offsets[there], scale), is_open=collider.is_open)


BOUNDED = (random_particle, random_box, random_rectangle, random_convex)
OPEN = (random_half_plane, random_axis_aligned_half_plane, random_open_convex)


class Pairs:
    """Random pairs from a pool of random regions, with the engine's and the oracle's answers."""

    def __init__(
        self,
        seed: int,
        count: int,
        makers: tuple[Callable[[np.random.Generator, float], Region], ...],
        pool: int = 6,
        scale: float = 1.0,
    ) -> None:
        rng = np.random.default_rng(seed)
        self.regions = [maker(rng, scale) for maker in makers for _ in range(pool)]
        self.scale = scale
        self.shapes, self.edges = shape_table(region.collider for region in self.regions)
        size = len(self.regions)
        self.a, self.b = rng.integers(0, size, (2, count))
        self.offset = rng.normal(0, 1.2 * scale, (count, 2))
        self.contacts = contacts(self.shapes, self.edges, self.a, self.b, self.offset)
        self.radius = np.array([region.radius for region in self.regions])
        self.differences = [np.empty((size, size), object) for _ in FAR]
        for i, first in enumerate(self.regions):
            for j, second in enumerate(self.regions):
                for cut, difference in enumerate(self.differences):
                    one, other = (
                        first.cores[cut % len(first.cores)],
                        second.cores[cut % len(second.cores)],
                    )
                    points = (one[:, None] - other[None]).reshape(-1, 2)
                    difference[i, j] = shapely.MultiPoint(points).convex_hull

    def penetration(self, offset: Array, cut: int = 0) -> Array:
        """Return the oracle's depth for bodies b at these offsets from a; negative if apart."""
        points = shapely.points(offset)
        difference = self.differences[cut][self.a, self.b]
        shapely.prepare(difference)
        distance = shapely.distance(shapely.boundary(difference), points)
        is_point = shapely.get_type_id(difference) == 0
        distance = np.where(is_point, shapely.distance(difference, points), distance)
        inside = shapely.contains_properly(difference, points) & ~is_point
        return self.radius[self.a] + self.radius[self.b] + np.where(inside, distance, -distance)


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def contacts(shapes: Array, edges: Array, a: Array, b: Array, offset: Array) -> Array:
    """Return contact_between's results for pairs, [n, 6]."""
    results = np.zeros((len(a), 6))
    for i in range(len(a)):
        found, nx, ny, depth, x, y = contact_between(
            shapes, edges, a[i], b[i], offset[i, 0], offset[i, 1]
        )
        if found != overlap_between(shapes, edges, a[i], b[i], offset[i, 0], offset[i, 1]):
            raise ValueError("detection and contact disagree")
        results[i] = (1.0 if found else 0.0, nx, ny, depth, x, y)
    return results


def check(pairs: Pairs) -> None:
    """Check everything that a contact claims."""
    found = pairs.contacts[:, 0] == 1.0
    normal = pairs.contacts[:, 1:3]
    depth = pairs.contacts[:, 3]
    point = pairs.contacts[:, 4:6]
    expected = pairs.penetration(pairs.offset)
    assert not np.isnan(pairs.contacts).any()

    # Which pairs overlap, and how deep: no translation shorter than the distance out separates.
    size = pairs.scale
    assert np.all((found == (expected > 0)) | (abs(expected) < DISAGREEMENT * size))
    # A depth that grows with the distance of the cut is due to it: the true one is larger.
    is_cut = pairs.penetration(pairs.offset, cut=1) > expected + 1e-9 * size
    assert np.all(depth[found & is_cut] > expected[found & is_cut])
    near = found & ~is_cut
    assert near.sum() > len(found) / 10
    # The oracle itself rounds in proportion to its coordinates.
    error = size * (1e-11 if any(region.is_open for region in pairs.regions) else 1e-12)
    np.testing.assert_allclose(depth[near], expected[near], rtol=0, atol=error)
    np.testing.assert_allclose(np.linalg.norm(normal[found], axis=1), 1, rtol=0, atol=1e-15)

    # The translation separates, and the regions just touch.
    step = normal * np.where(near, depth, 0.0)[:, None]
    left = pairs.penetration(pairs.offset + step)[near]
    assert abs(left).max() <= error

    # The point is halfway between the surfaces that separate.
    hulls = np.array([shapely.MultiPoint(region.cores[0]).convex_hull for region in pairs.regions])
    for which, surface in ((pairs.a, point + step / 2), (pairs.b, point - step / 2 - pairs.offset)):
        gap = shapely.distance(shapely.boundary(hulls[which]), shapely.points(surface))
        is_disc = pairs.radius[which] > 0
        gap = np.where(is_disc, np.linalg.norm(surface, axis=1) - pairs.radius[which], gap)
        assert abs(gap[near]).max() <= error


@pytest.mark.parametrize("seed", range(3))
def test_bounded_pairs_agree_with_geos(seed: int) -> None:
    check(Pairs(seed, 20_000, BOUNDED))


@pytest.mark.parametrize("seed", range(3))
def test_open_pairs_agree_with_geos(seed: int) -> None:
    check(Pairs(seed, 10_000, (*BOUNDED, *OPEN), pool=3))


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_tiny_and_enormous_pairs_agree_with_geos(scale: float) -> None:
    check(Pairs(11, 5_000, BOUNDED, scale=scale))
    check(Pairs(12, 5_000, (*BOUNDED, *OPEN), pool=3, scale=scale))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 110))
def test_millions_of_pairs_agree_with_geos(seed: int) -> None:
    check(Pairs(seed, 300_000, BOUNDED, pool=20))
    check(Pairs(seed, 100_000, (*BOUNDED, *OPEN), pool=10))


def room(region: Region, other: Region, offset: Array) -> float:
    """Return the radius of the largest disc in both regions, by linear programming."""
    rows, bounds = [], []
    for edges, origin in ((region.collider.edges, np.zeros(2)), (other.collider.edges, offset)):
        for edge in edges:
            normal = np.array([edge.normal_x, edge.normal_y])
            rows.append([*normal, 1.0])
            bounds.append(edge.offset + normal @ origin)
    answer = linprog([0, 0, -1], A_ub=rows, b_ub=bounds, bounds=[(None, None)] * 2 + [(None, 1)])
    return float(answer.x[2]) if answer.status == 0 else -np.inf


def test_open_pairs_agree_with_linear_programming() -> None:
    """Nothing is cut off here: two regions overlap if some disc is in both."""
    pairs = Pairs(21, 1_000, (*OPEN, random_rectangle), pool=5)
    rooms = np.array(
        [
            room(pairs.regions[a], pairs.regions[b], offset)
            for a, b, offset in zip(pairs.a, pairs.b, pairs.offset, strict=True)
        ]
    )
    found = pairs.contacts[:, 0] == 1.0
    assert 0.1 < found.mean() < 0.95
    assert np.all((found == (rooms > 0)) | (abs(rooms) < DISAGREEMENT))
    # Regions that no finite translation separates overlap at any position.
    hopeless = np.isinf(pairs.contacts[:, 3])
    assert hopeless.any()
    for index in np.flatnonzero(hopeless)[:100]:
        a, b = pairs.regions[pairs.a[index]], pairs.regions[pairs.b[index]]
        for offset in 1e6 * np.array([[1, 0], [0, 1], [-1, 0], [0, -1], [1, 1], [-1, 1.5]]):
            assert room(a, b, offset) > 0
