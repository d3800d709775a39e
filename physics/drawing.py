"""Bodies drawn as SVG, for whoever debugs or teaches."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .shapes.colliders import AxisAlignedHalfPlane, Collider, Convex, HalfPlane

FloatArray = npt.NDArray[np.float64]

_MARGIN = 0.08  # around the bodies, as a share of the larger side
_STYLES = {
    "static": 'fill="#7d8894" fill-opacity=".3" stroke="#7d8894"',
    "dynamic": 'fill="#2f6fb0" fill-opacity=".3" stroke="#2f6fb0"',
    "sensor": 'fill="none" stroke="#e08a2c" stroke-dasharray="4 3"',
}
_WAY = 'fill="none" stroke="#2f6fb0" stroke-opacity=".6"'
_NORMAL = 'stroke="#b3262f" stroke-width="1.5"'
_NORMAL_LENGTH = 0.06  # as a share of the larger side


def draw_scene(
    colliders: Sequence[Collider],
    positions: FloatArray,
    looks: Sequence[str],
    hits: Iterable[Any],
    paths: Any,
    width: int,
) -> str:
    """Return a picture of bodies as SVG, y upward.

    Args:
        colliders: of the bodies.
        positions: float64 [n, 2].
        looks: of each body: "static", "dynamic" or "sensor".
        hits: `Hit` records, whose points and normals are drawn.
        paths: positions at several times, [times, n, 2].
        width: of the picture, in pixels.
    """
    ways = np.asarray(paths, np.float64)
    ways = ways if ways.ndim == 3 else np.zeros((0, len(colliders), 2))
    low, high = _bounds(colliders, positions, ways)
    across, up = (high - low).tolist()
    side = max(across, up)
    parts = [
        _shape(collider, position, low, high, _STYLES[look])
        for collider, position, look in zip(colliders, positions, looks, strict=True)
    ]
    moved = [body for body in range(len(colliders)) if len(ways) and np.ptp(ways[:, body], 0).any()]
    parts += [f'<polyline points="{_points(ways[:, body])}" {_WAY} {_THIN}/>' for body in moved]
    for hit in hits:
        (x, y), (end_x, end_y) = hit["point"], hit["point"] + _NORMAL_LENGTH * side * hit["normal"]
        parts.append(
            f'<line x1="{x:g}" y1="{y:g}" x2="{end_x:g}" y2="{end_y:g}" {_NORMAL} {_THIN}/>'
            f'<circle cx="{x:g}" cy="{y:g}" r="{side / 150:g}" fill="#b3262f"/>'
        )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" '
        f'height="{max(1, round(width * up / across))}" '
        f'viewBox="{low[0]:g} {-high[1]:g} {across:g} {up:g}">'
        f'<g transform="scale(1 -1)">{"".join(parts)}</g></svg>'
    )


# Lines have the same width at every scale.
_THIN = 'vector-effect="non-scaling-stroke"'


def _bounds(
    colliders: Sequence[Collider], positions: FloatArray, ways: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the lower left and the upper right corner of what is shown."""
    corners = [np.zeros((0, 2)), ways.reshape(-1, 2)]
    for collider, position in zip(colliders, positions, strict=True):
        ends = [(edge.start_x, edge.start_y) for edge in collider.edges if edge.has_start]
        ends += [(edge.end_x, edge.end_y) for edge in collider.edges if edge.has_end]
        # A half-plane has no corner: the foot of its position is shown.
        if not ends:
            ends = [(edge.start_x, edge.start_y) for edge in collider.edges] or [(0.0, 0.0)]
        reach = collider.rounding
        corners += [np.add(position, ends) - reach, np.add(position, ends) + reach]
    every = np.concatenate(corners)
    if not len(every):
        every = np.zeros((1, 2))
    low, high = every.min(axis=0), every.max(axis=0)
    margin = _MARGIN * float((high - low).max()) or 1.0
    return low - margin, high + margin


def _shape(
    collider: Collider, position: FloatArray, low: FloatArray, high: FloatArray, style: str
) -> str:
    """Return a body; what is open is cut off at the picture's edges."""
    x, y = position.tolist()
    if not collider.edges:
        radius = collider.rounding
        return f'<circle cx="{x:g}" cy="{y:g}" r="{radius:g}" {style} {_THIN}/>'
    if all(edge.has_start and edge.has_end for edge in collider.edges):
        corners = [(x + edge.start_x, y + edge.start_y) for edge in collider.edges]
    else:
        corners = _cut(collider, position, low, high)
    return f'<polygon points="{_points(corners)}" {style} {_THIN}/>' if corners else ""


def _cut(
    collider: Collider, position: FloatArray, low: FloatArray, high: FloatArray
) -> list[tuple[float, float]]:
    """Return the corners of the part of an open region that is shown; none if there is none."""
    sides = [
        HalfPlane(
            (edge.normal_x, edge.normal_y),
            edge.offset + edge.normal_x * position[0] + edge.normal_y * position[1],
        )
        for edge in collider.edges
    ]
    window = [
        AxisAlignedHalfPlane("-x", -low[0]),
        AxisAlignedHalfPlane("+x", high[0]),
        AxisAlignedHalfPlane("-y", -low[1]),
        AxisAlignedHalfPlane("+y", high[1]),
    ]
    try:
        return list(Convex.from_half_planes(*sides, *window).vertices)
    except ValueError:  # nothing of it is within the window
        return []


def _points(corners: Iterable[Iterable[float]]) -> str:
    return " ".join(f"{x:g},{y:g}" for x, y in corners)
