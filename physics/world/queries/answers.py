"""What a ray meets, as users get it; and rays as kernels cast them."""

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ...body import FloatArray
from ..state.records import Ray

# The inverse of a way, and how short a way may be for one: 0 has none that is a number.
LARGEST = 1e300
LEAST = 1e-300


class RayHit(NamedTuple):
    """What a ray meets first.

    Attributes:
        body: its handle.
        fraction: of the ray, from 0 at its start (also if it starts inside the body) to 1.
        point: where the ray, or the centre of the disc that is cast, is then.
        normal: unit vector out of the body.
    """

    body: int
    fraction: float
    point: FloatArray
    normal: FloatArray


class RayHits(NamedTuple):
    """What many rays meet first, see `RayHit`.

    Attributes:
        bodies: their handles, int64 [n]; -1 for a ray that meets none, whose other values are inf
            and nan.
        fractions: float64 [n].
        points: float64 [n, 2].
        normals: float64 [n, 2].
    """

    bodies: npt.NDArray[np.int64]
    fractions: FloatArray
    points: FloatArray
    normals: FloatArray


def new_ray(x: float, y: float, end_x: float, end_y: float) -> npt.NDArray[Any]:
    """Return a ray, `Ray` [1]."""
    ray = np.zeros(1, Ray)
    way_x, way_y = end_x - x, end_y - y
    inverses = [1.0 / way if abs(way) > LEAST else LARGEST for way in (way_x, way_y)]
    ray[0] = (x, y, way_x, way_y, *inverses, 0.0, 0, 0.0, 0.0, 0.0)
    return ray


def new_rays(starts: FloatArray, ends: FloatArray) -> npt.NDArray[Any]:
    """Return rays, `Ray` [n], between points, float64 [n, 2]."""
    if starts.shape != ends.shape:
        raise ValueError(f"there are {len(starts)} starts, but {len(ends)} ends")
    rays = np.zeros(len(starts), Ray)
    rays["x"], rays["y"] = starts.T
    ways = ends - starts
    rays["way_x"], rays["way_y"] = ways.T
    inverses = np.divide(1.0, ways, np.full_like(ways, LARGEST), where=abs(ways) > LEAST)
    rays["inverse_x"], rays["inverse_y"] = inverses.T
    return rays


def answer_of(ray: npt.NDArray[Any]) -> RayHit | None:
    """Return what a ray, `Ray` [1], has met."""
    x, y, way_x, way_y, _, _, _, body, fraction, normal_x, normal_y = ray.item()
    if body < 0:
        return None
    point = np.array((x + fraction * way_x, y + fraction * way_y))
    return RayHit(body, fraction, point, np.array((-normal_x, -normal_y)))


def answers_of(rays: npt.NDArray[Any]) -> RayHits:
    """Return what rays, `Ray` [n], have met."""
    missed = rays["body"] < 0
    along = np.where(missed, math.nan, rays["fraction"])
    points = np.stack(
        [rays["x"] + along * rays["way_x"], rays["y"] + along * rays["way_y"]], axis=1
    )
    normals = -np.stack([rays["normal_x"], rays["normal_y"]], axis=1)
    normals[missed] = math.nan
    return RayHits(rays["body"].copy(), rays["fraction"].copy(), points, normals)
