"""Times of impact against an oracle in 40 digits, which tries every feature against every other.

Two separate regions first touch with a vertex on an edge or, if rounded, with two vertices at a
distance of the radii. The oracle computes all of these times, from the numbers that the colliders
were made of, and takes the least. It uses no separating axis, no farthest face, and none of the
engine's edges.
"""

import math
from dataclasses import dataclass
from itertools import product

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Collider,
    Convex,
    HalfPlane,
    Particle,
    Rectangle,
)
from arkanoid.physics.pairs.table import contact_between, impact_between
from arkanoid.physics.shapes.table import shape_table
from mpmath import mp, mpf

FAR = 10**6  # where the oracle ends open edges, in units of the scale
UNIT_ROUNDOFF = 2.0**-53

Point = tuple[mpf, mpf]
ORIGIN = (mpf(0), mpf(0))


@dataclass(frozen=True)
class Exact:
    """A collider, and its boundary to 40 digits."""

    collider: Collider
    corners: tuple[Point, ...]
    segments: tuple[tuple[Point, Point, Point], ...] = ()  # start, end, outward unit normal
    size: float = 0.0  # the largest coordinate from which the collider was made
    slope: float = 1.0  # the same in lengths of the shortest edge, if edges are made from corners

    @property
    def radius(self) -> mpf:
        return mpf(self.collider.rounding)


@dataclass(frozen=True)
class Touch:
    """When two regions meet, the normal from a to b, and whether two corners meet."""

    time: mpf
    normal: Point
    corners: bool


@pytest.fixture(autouse=True)
def forty_digits() -> object:
    with mp.workdps(40):
        yield


def exact_region(
    collider: Collider,
    half_planes: list[tuple[mpf, mpf, mpf]],
    scale: float,
    size: float,
    slope: float = 1.0,
) -> Exact:
    """Return the boundary of an intersection of half-planes x nx + y ny <= offset."""
    segments = []
    for nx, ny, offset in half_planes:
        length = mp.hypot(nx, ny)
        nx, ny, offset = nx / length, ny / length, offset / length
        low, high = mpf(-FAR * scale), mpf(FAR * scale)
        for mx, my, other in half_planes:
            rise = my * nx - mx * ny
            if abs(rise) > mpf(10) ** -30:
                cut = (other - offset * (mx * nx + my * ny)) / rise
                low, high = (low, min(high, cut)) if rise > 0 else (max(low, cut), high)
        if low < high:
            start, end = (
                (offset * nx - along * ny, offset * ny + along * nx) for along in (low, high)
            )
            segments.append((start, end, (nx, ny)))
    corners = tuple(start for start, _, _ in segments) + tuple(end for _, end, _ in segments)
    return Exact(collider, corners, tuple(segments), size, slope)


def turned(points: np.ndarray, rotation: float) -> list[Point]:
    """Return points turned by an angle; within rounding of a quarter turn it counts as one."""
    quarters = round(rotation / (math.pi / 2))
    is_quarter = abs(rotation - quarters * math.pi / 2) < 1e-12
    angle = quarters * mp.pi / 2 if is_quarter else mpf(rotation)
    c, s = mp.cos(angle), mp.sin(angle)
    return [(c * mpf(x) - s * mpf(y), s * mpf(x) + c * mpf(y)) for x, y in points.tolist()]


def polygon_half_planes(
    vertices: list[Point], missing: tuple[int, ...] = ()
) -> list[tuple[mpf, mpf, mpf]]:
    half_planes = []
    for index, (x, y) in enumerate(vertices):
        if index not in missing:
            next_x, next_y = vertices[(index + 1) % len(vertices)]
            nx, ny = next_y - y, x - next_x
            half_planes.append((nx, ny, nx * x + ny * y))
    return half_planes


def box(width: float, height: float) -> np.ndarray:
    return 0.5 * np.array([[width, height], [-width, height], [-width, -height], [width, -height]])


def random_exact(rng: np.random.Generator, kind: int, scale: float) -> Exact:
    """Return a random region of one of the six kinds; 6 is an open convex."""
    sizes = scale * rng.uniform(0.1, 2, 2)
    rotation = float(rng.choice([rng.uniform(-7, 7), rng.integers(-4, 5) * np.pi / 2]))
    if kind == 0:
        radius = float(sizes[0] * rng.choice([1.0, 1e-3]))
        return Exact(Particle(radius), (ORIGIN,), size=radius)
    if kind == 1:
        nx, ny = rng.normal(size=2)
        offset = float(scale * rng.normal())
        size = abs(offset) / math.hypot(nx, ny)
        half_plane = (mpf(nx), mpf(ny), mpf(offset))
        return exact_region(HalfPlane((nx, ny), offset), [half_plane], scale, size)
    if kind == 2:
        name = str(rng.choice(["+x", "-x", "+y", "-y"]))
        sign = mpf(name[0] + "1")
        offset = float(scale * rng.normal())
        collider = AxisAlignedHalfPlane(name, offset)  # type: ignore[arg-type]
        half_plane = (sign * (name[1] == "x"), sign * (name[1] == "y"), mpf(offset))
        return exact_region(collider, [half_plane], scale, abs(offset))
    if kind == 3:
        vertices = turned(box(*sizes), 0.0)
        collider = AxisAlignedRectangle(*sizes)
        return exact_region(collider, polygon_half_planes(vertices), scale, max(sizes))
    if kind == 4:
        vertices = turned(box(*sizes), rotation)
        collider = Rectangle(*sizes, rotation)
        return exact_region(collider, polygon_half_planes(vertices), scale, max(sizes))
    count = int(rng.integers(3, 7))
    angles = (np.arange(count) + rng.uniform(0, 0.7, count)) * 2 * np.pi / count
    points = np.column_stack([np.cos(angles), np.sin(angles)]) * sizes + rng.normal(
        0, 0.3 * scale, 2
    )
    missing = () if kind == 5 else tuple(rng.permutation(count)[: rng.integers(1, count)].tolist())
    collider = Convex(points.tolist(), missing, rotation)
    size = float(np.hypot(*points.T).max())
    shortest = float(np.hypot(*(points - np.roll(points, 1, axis=0)).T).min())
    half_planes = polygon_half_planes(turned(points, rotation), missing)
    return exact_region(collider, half_planes, scale, size, max(1.0, size / shortest))


def first_touch(a: Exact, b: Exact, d: Point, v: Point) -> Touch | None:
    """Return the first touch of any feature of a with any of b, which is at d and moves with v."""
    reach = a.radius + b.radius
    touches: list[Touch] = []
    if reach > 0:
        for (ax, ay), (bx, by) in product(a.corners, b.corners):
            x, y = d[0] + bx - ax, d[1] + by - ay
            touches += (Touch(*hit, True) for hit in vertex_on_vertex(x, y, v, reach))
    for vertex, segment in product(a.corners, b.segments):
        x, y = vertex[0] - d[0], vertex[1] - d[1]
        for time, (nx, ny) in vertex_on_edge(x, y, (-v[0], -v[1]), segment, reach):
            touches.append(Touch(time, (-nx, -ny), False))
    for vertex, segment in product(b.corners, a.segments):
        hits = vertex_on_edge(vertex[0] + d[0], vertex[1] + d[1], v, segment, reach)
        touches += (Touch(*hit, False) for hit in hits)
    return min(touches, default=None, key=lambda touch: touch.time)


def vertex_on_vertex(x: mpf, y: mpf, v: Point, reach: mpf) -> list[tuple[mpf, Point]]:
    square = v[0] ** 2 + v[1] ** 2
    half = x * v[0] + y * v[1]
    discriminant = half**2 - square * (x**2 + y**2 - reach**2)
    if discriminant <= 0 or half >= 0:
        return []
    time = (-half - mp.sqrt(discriminant)) / square
    return [(time, ((x + v[0] * time) / reach, (y + v[1] * time) / reach))] if time >= 0 else []


def vertex_on_edge(
    x: mpf, y: mpf, v: Point, segment: tuple[Point, Point, Point], reach: mpf
) -> list[tuple[mpf, Point]]:
    (start, end, (nx, ny)) = segment
    speed = nx * v[0] + ny * v[1]
    gap = nx * (x - start[0]) + ny * (y - start[1]) - reach
    if gap < 0 or speed >= 0:
        return []
    time = -gap / speed
    along = -ny * (x + v[0] * time) + nx * (y + v[1] * time)
    low = -ny * start[0] + nx * start[1]
    high = -ny * end[0] + nx * end[1]
    return [(time, (nx, ny))] if low <= along <= high else []


def rounding(a: Exact, b: Exact, flight: float) -> float:
    """Return by how much doubles may misplace a vertex of one region beside an edge of the other.

    Both are made from coordinates no larger than the regions' sizes and the positions on the path.
    Turning the corners costs at most 6 roundings of a coordinate, finding the normals 4 (multiplied
    by the ratio of coordinates to edge length), the sums of two products for vertex, edge and
    position 3 each, and adding these 2: 16 roundings of the sum of all sizes cover everything
    (Higham, Accuracy and Stability of Numerical Algorithms, 3.1).
    """
    return 16 * UNIT_ROUNDOFF * max(a.slope, b.slope) * (a.size + b.size + flight)


def check(seed: int, count: int, scale: float = 1.0) -> None:
    """Compare random motions of all pairs of kinds, to a relative error of 1e-12.

    The rounding of the coordinates is unavoidable. It changes the time by the rounding divided by
    the closing speed: more than 1e-12 only for very short times. It turns the normal at a corner by
    the rounding divided by the radius, and more for grazing hits: more than 1e-12 only for small
    discs that graze.
    """
    rng = np.random.default_rng(seed)
    pool = [random_exact(rng, kind, scale) for kind in range(7) for _ in range(6)]
    shapes, edges = shape_table(region.collider for region in pool)
    hits = misses = 0
    while hits + misses < count:
        a, b = rng.integers(0, len(pool), 2)
        dx, dy = rng.normal(0, 3 * scale, 2).tolist()
        if contact_between(shapes, edges, a, b, dx, dy)[0]:
            continue
        speed = 10 ** rng.uniform(-3, 3)
        vx, vy = (speed * (rng.normal(0, scale, 2) - 0.4 * np.array([dx, dy]))).tolist()
        time, nx, ny = impact_between(shapes, edges, a, b, dx, dy, vx, vy, math.inf)
        touch = first_touch(pool[a], pool[b], (mpf(dx), mpf(dy)), (mpf(vx), mpf(vy)))
        if touch is None:
            assert time == math.inf
            misses += 1
            continue
        exact_x, exact_y = touch.normal
        closing = float(-(exact_x * mpf(vx) + exact_y * mpf(vy)))
        speed = math.hypot(vx, vy)
        flight = math.hypot(dx, dy) + speed * float(touch.time)
        misplaced = rounding(pool[a], pool[b], flight)
        assert abs(time - touch.time) <= max(1e-12 * touch.time, misplaced / closing)
        turn = 0.0
        if touch.corners:
            turn = misplaced / float(pool[a].radius + pool[b].radius) * speed / closing
        assert abs(nx - exact_x) <= max(1e-12, turn)
        assert abs(ny - exact_y) <= max(1e-12, turn)
        hits += 1
        # The duration cuts exactly there.
        assert impact_between(shapes, edges, a, b, dx, dy, vx, vy, time)[0] == time
        sooner = time * (1 - 1e-15)
        assert impact_between(shapes, edges, a, b, dx, dy, vx, vy, sooner)[0] == math.inf
    assert min(hits, misses) > count / 4


@pytest.mark.parametrize("seed", range(2))
def test_times_of_impact_to_twelve_digits(seed: int) -> None:
    check(seed, 2_000)


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_times_of_impact_of_tiny_and_enormous_shapes(scale: float) -> None:
    check(2, 1_000, scale)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 120))
def test_times_of_impact_to_twelve_digits_at_length(seed: int) -> None:
    check(seed, 20_000)


@pytest.mark.parametrize("excess", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
def test_grazing_discs_touch_where_they_say(excess: float) -> None:
    """For a grazing hit the time is ill-conditioned, but the distance at that time is not."""
    rng = np.random.default_rng(5)
    hits = 0
    for _ in range(200):
        a, b = rng.uniform(0.1, 2, 2).tolist()
        angle = rng.uniform(0, 2 * np.pi)
        forward = np.array([np.cos(angle), np.sin(angle)])
        sideways = np.array([-forward[1], forward[0]])
        miss = (a + b) * (1 - excess * rng.choice([-1, 1]))
        d = miss * sideways - rng.uniform(3, 9) * forward
        v = forward * 10 ** rng.uniform(-2, 2)
        shapes, edges = shape_table((Particle(a), Particle(b)))
        time, nx, ny = impact_between(shapes, edges, 0, 1, *d, *v, math.inf)
        touch = first_touch(
            Exact(Particle(a), (ORIGIN,)),
            Exact(Particle(b), (ORIGIN,)),
            (mpf(d[0]), mpf(d[1])),
            (mpf(v[0]), mpf(v[1])),
        )
        if excess > 1e-14:
            assert (touch is None) == (time == math.inf)
        if time < math.inf:
            hits += 1
            at = (mpf(d[0]) + mpf(time) * mpf(v[0]), mpf(d[1]) + mpf(time) * mpf(v[1]))
            assert abs(mp.hypot(*at) - (mpf(a) + mpf(b))) < 1e-14 * (a + b + 9)
            assert mp.hypot(nx, ny) == pytest.approx(1, abs=1e-15)
            assert nx * v[0] + ny * v[1] < 0
    assert hits > 50


def test_a_disc_hit_from_a_billion_radii_away() -> None:
    """A distant start spoils neither the decision whether it hits nor the normal."""
    rng = np.random.default_rng(6)
    shapes, edges = shape_table((Particle(0.5), Particle(0.5)))
    for _ in range(500):
        d = rng.normal(0, 1e9, 2)
        # It moves to within about a radius of the other's centre; whole numbers keep it exact.
        d = np.round(d)
        v = -d + rng.normal(0, 0.7, 2).round(3)
        time, nx, ny = impact_between(shapes, edges, 0, 1, *d, *v, math.inf)
        point = Exact(Particle(0.5), (ORIGIN,))
        touch = first_touch(point, point, (mpf(d[0]), mpf(d[1])), (mpf(v[0]), mpf(v[1])))
        assert (touch is None) == (time == math.inf)
        if touch is not None:
            assert abs(time - touch.time) <= 1e-12 * touch.time
            assert abs(nx - touch.normal[0]) <= 1e-12
            assert abs(ny - touch.normal[1]) <= 1e-12


def test_a_disc_moving_almost_along_a_face_does_not_slip_in_behind_its_corner() -> None:
    """Rounding once made it miss both the face and the face's corner.

    It meets the face's line just before the corner, and passes the corner at a distance of its
    radius, to the last digit: it then sank into the wall. The number that excludes the face also
    says that such a disc cannot miss.
    """
    rng = np.random.default_rng(7)
    for _ in range(3_000):
        radius = rng.uniform(0.05, 1)
        rotation = rng.uniform(-0.5, 0.5)
        along = np.array([np.cos(rotation), np.sin(rotation)])
        up = np.array([-along[1], along[0]])
        shapes, edges = shape_table((Particle(radius), Rectangle(200.0, 2.0, rotation)))
        # It comes from beyond the left end, and would be just inside the upper face in the middle.
        sink = 10 ** rng.uniform(-17, -10)
        start = -(100 + 10 ** rng.uniform(-6, 0)) * along + (1 + radius) * up
        velocity = along * 1.0 - sink * up
        time, nx, ny = impact_between(shapes, edges, 0, 1, *-start, *-velocity, math.inf)
        depth_later = contact_between(shapes, edges, 0, 1, *-(start + 150 * velocity))[3]
        assert depth_later < 1e-7
        if depth_later > 1e-12:
            assert time < 150
            assert nx * velocity[0] + ny * velocity[1] > 0


def test_a_disc_passes_a_sharp_corner() -> None:
    """A disc was once thought unable to miss a corner because it flew inward along the face.

    It had met the face's line beyond the corner; but the corner is sharp, and the disc leaves past
    the other face long before it reaches the corner.
    """
    wedge = Convex([(1.789, 0.723), (0.077, 0.276), (-0.148, -1.471)])
    shapes, edges = shape_table((Particle(0.0013), wedge))
    flight = (2.88, 3.87, -0.667, -0.216)
    assert impact_between(shapes, edges, 0, 1, *flight, math.inf)[0] == math.inf


@pytest.mark.parametrize("gap", [1.0, 2.0**-10, 2.0**-30, 0.0])
@pytest.mark.parametrize(
    "above",
    [
        Particle(0.5),
        AxisAlignedRectangle(1, 1),
        Rectangle(1, 1, math.pi / 2),
        Convex([(-1, -0.5), (1, -0.5), (0, 0.5)]),
        AxisAlignedHalfPlane("-y", 0.5),
    ],
)
@pytest.mark.parametrize(
    "below",
    [
        AxisAlignedHalfPlane("+y", 0.5),
        HalfPlane((0, 3), 1.5),
        AxisAlignedRectangle(9, 1),
        Rectangle(1, 9, math.pi / 2),
        Convex([(-9, 0.5), (-9, 0), (9, 0), (9, 0.5)], [1]),
    ],
)
def test_touching_in_passing_is_no_impact(above: Collider, below: Collider, gap: float) -> None:
    """Staying, sliding and separating are no impacts; touching and approaching is one at time 0."""
    shapes, edges = shape_table((above, below))
    place = (0.125, -1.0 - gap)
    assert not contact_between(shapes, edges, 0, 1, *place)[0]
    for velocity in ((0.0, 0.0), (0.25, 0.0), (0.0, -1.0), (0.25, -1e-9)):
        time, _, _ = impact_between(shapes, edges, 0, 1, *place, *velocity, math.inf)
        assert time == math.inf
    approach = impact_between(shapes, edges, 0, 1, *place, 0.25, 2.0, math.inf)
    assert approach == (gap / 2, 0.0, -1.0)
