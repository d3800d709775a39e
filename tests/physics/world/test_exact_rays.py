"""Rays among polygons with whole coordinates, against fractions; rays that end on a surface."""

import math
from fractions import Fraction

import numpy as np
import pytest
from arkanoid.physics import Body, Convex, HalfPlane, Particle, Rectangle, World
from helpers.grounds import Rng

Corner = tuple[int, int]
ROUNDING = 2.0**-50


def hull(points: list[Corner]) -> list[Corner]:
    """Return the corners of the convex hull, counterclockwise; fewer than 3 if it is flat."""
    chains: list[list[Corner]] = []
    for ordered in (sorted(set(points)), sorted(set(points), reverse=True)):
        chain: list[Corner] = []
        for point in ordered:
            while len(chain) > 1 and side_of(chain[-2], chain[-1], point) <= 0:
                chain.pop()
            chain.append(point)
        chains.append(chain[:-1])
    return chains[0] + chains[1]


def side_of(start: Corner, end: Corner, point: Corner) -> int:
    """Return a positive number for a point to the left of a line."""
    along, away = np.subtract(end, start), np.subtract(point, start)
    return int(along[0] * away[1] - along[1] * away[0])


def entry(polygon: list[Corner], start: Corner, end: Corner) -> Fraction | None:
    """Return the fraction of a ray at which it comes into the open polygon, or would, if at 1."""
    enters, leaves = Fraction(-(10**9)), Fraction(10**9)
    for corner, following in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        before = side_of(corner, following, start)
        gain = side_of(corner, following, end) - before
        if gain == 0 and before <= 0:
            return None
        if gain > 0:
            enters = max(enters, Fraction(-before, gain))
        elif gain < 0:
            leaves = min(leaves, Fraction(-before, gain))
    inside = enters < leaves and leaves > 0 and enters <= 1
    return max(enters, Fraction(0)) if inside else None


def rounding(polygon: list[Corner], start: Corner, end: Corner, at: Fraction) -> float:
    """Return by how much rounding may change the fraction at which a ray meets a polygon.

    Places are known to their last digits; the flatter a ray meets a side, the more these matter.
    """
    reach = sum(abs(number) for corner in (start, end, *polygon) for number in corner)
    slowest = math.inf
    for corner, following in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        before = side_of(corner, following, start)
        gain = side_of(corner, following, end) - before
        if gain > 0 and Fraction(-before, gain) == at:
            slowest = min(slowest, gain / math.dist(corner, following))
    return ROUNDING * (1 + reach / slowest)


def runs_along(polygon: list[Corner], start: Corner, end: Corner) -> bool:
    """Return whether a side lies on the line of a ray."""
    sides = [side_of(start, end, corner) for corner in polygon]
    return sides.count(0) > 1 and (min(sides) == 0 or max(sides) == 0)


def random_corner(rng: Rng, reach: int) -> Corner:
    x, y = rng.integers(-reach, reach + 1, 2).tolist()
    return x, y


def check_polygons(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        polygons = []
        for _ in range(int(rng.integers(1, 6))):
            x, y = random_corner(rng, 10)
            corners = hull([random_corner(rng, 4) for _ in range(int(rng.integers(3, 8)))])
            if len(corners) > 2:
                polygons.append([(x + right, y + up) for right, up in corners])
        everything = [corner for polygon in polygons for corner in polygon]
        world = World([Body(Convex(polygon)) for polygon in polygons])
        for _ in range(20 if polygons else 0):
            # Some rays begin, end, or go on at a corner.
            start, end = random_corner(rng, 20), random_corner(rng, 20)
            aim = everything[rng.integers(len(everything))]
            if rng.random() < 0.1:
                start = aim
            elif rng.random() < 0.5:
                times = int(rng.integers(1, 4))
                end = (
                    start[0] + times * (aim[0] - start[0]),
                    start[1] + times * (aim[1] - start[1]),
                )
            # A ray along sides of two polygons may be in the seam between them, which is solid.
            along = sum(runs_along(polygon, start, end) for polygon in polygons)
            if start == end or along > 1:
                continue
            entries = [entry(polygon, start, end) for polygon in polygons]
            first = min((at for at in entries if at is not None), default=None)
            hit = world.query_ray(start, end)
            assert (hit is None) == (first is None), (polygons, start, end)
            if hit is not None and first is not None:
                assert entries[hit.body] == first
                slack = rounding(polygons[hit.body], start, end, first)
                assert hit.fraction == pytest.approx(float(first), abs=slack)
                assert math.hypot(*hit.normal) == pytest.approx(1, abs=ROUNDING)


def test_rays_among_polygons_agree_with_fractions() -> None:
    """Of 30 000 rays, 88 missed the corner at their end, and 120 met one that they only grazed.

    Another body that covered the place beside a grazed corner was taken for the rest of a wall.
    """
    check_polygons(1, 100)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10, 14))
def test_rays_among_polygons_agree_with_fractions_at_length(seed: int) -> None:
    check_polygons(seed, 3000)


def test_a_ray_that_ends_on_a_surface_meets_it_there() -> None:
    """A third of them ended before it, by a rounding of the end: a look at a corner saw nothing."""
    rng = np.random.default_rng(2)
    for _ in range(400):
        x, y = np.round(rng.uniform(-9, 9, 2), 1) + rng.choice([0, 100, 1e6])
        angle = float(rng.uniform(-3, 3))
        inward = np.array([math.cos(angle), math.sin(angle)])
        across = np.array([-inward[1], inward[0]])
        slope = float(rng.uniform(-0.5, 0.5))
        # A disc, a half-plane and two corners, all of which begin at (x, y).
        colliders = (
            (Particle(1.3), (x, y) + 1.3 * inward),
            (HalfPlane((-inward[0], -inward[1])), (x, y)),
            (Rectangle(1, 1, angle + math.pi / 4), (x, y) + 0.5**0.5 * inward),
            (Convex([(0, 0), tuple(inward - across), tuple(inward + across)]), (x, y)),
        )
        start = (x, y) - rng.choice([0.1, 3, 1e4]) * (inward + slope * across)
        for collider, place in colliders:
            world = World([Body(collider, place)])
            for hit in (
                world.query_ray(start, (x, y)),
                world.query_ray(start, (x, y), radius=0.01),
            ):
                assert hit is not None
                assert 0 < hit.fraction <= 1
                assert (hit.point - start) @ inward > 0
            hit = world.query_ray(start, (x, y))
            assert hit is not None
            assert hit.point == pytest.approx((x, y), abs=ROUNDING * (1e4 + abs(x) + abs(y)))
        # A thousandth of a margin is not a gap, a visible gap is one.
        floor = World([Body(HalfPlane((0, 1)), (0, y))])
        assert floor.query_ray((x, y + 2), (x, y + 1e-16 * abs(y))) is not None
        assert floor.query_ray((x, y + 2), (x, y + 1e-11 * (1 + abs(y)))) is None
