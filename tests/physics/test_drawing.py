"""Worlds as text and as SVG pictures."""

from xml.etree import ElementTree

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    Body,
    HalfPlane,
    Particle,
    Rectangle,
    World,
    WorldBatch,
)

SVG = "{http://www.w3.org/2000/svg}"


def room() -> World:
    world = World(
        [
            Body(AxisAlignedHalfPlane("+x"), (0, 0)),
            Body(HalfPlane((-1, 0)), (4, 0)),
            Body(Rectangle(1, 2, 0.3), (2, 3)),
            Body(Particle(0.5), (1, 1), (3, 0), mass=1.0),
        ]
    )
    world.add(Body(Particle(0.25), (2, 1)), sensor=True)
    return world


def numbers(text: str) -> np.ndarray:
    return np.array(text.replace(",", " ").split(), float).reshape(-1, 2)


def test_a_world_says_what_is_in_it() -> None:
    world = room()
    world.step(0.5)
    assert repr(world) == "<World of 5 bodies (1 dynamic, 1 sensors) at time 0.5>"


def test_a_batch_says_how_many_worlds_it_has_and_where_they_are_in_time() -> None:
    batch = WorldBatch(room(), 3)
    batch.step(0.5)
    assert repr(batch) == "<WorldBatch of 3 (moving bodies in each: 1) at time 0.5>"


def test_bodies_normals_and_paths_are_where_the_engine_has_them() -> None:
    world = room()
    places = [world.positions]
    hits = []
    for _ in range(20):
        hits += list(world.step(0.1))
        places.append(world.positions)
    picture = ElementTree.fromstring(world.draw(hits, places))
    discs = [
        [float(disc.get(key, "")) for key in ("cx", "cy", "r")]
        for disc in picture.iter(SVG + "circle")
    ]
    np.testing.assert_allclose(discs[0], [*world.positions[3], 0.5], rtol=1e-5)
    np.testing.assert_allclose(discs[1], [2, 1, 0.25])
    lines = list(picture.iter(SVG + "line"))
    assert len(lines) == len(hits) > 2
    for line, hit in zip(lines, hits, strict=True):
        x1, y1, x2, y2 = (float(line.get(key, "")) for key in ("x1", "y1", "x2", "y2"))
        np.testing.assert_allclose((x1, y1), hit["point"], rtol=1e-4, atol=1e-9)
        along = np.array((x2 - x1, y2 - y1))
        np.testing.assert_allclose(along / np.hypot(*along), hit["normal"], atol=1e-3)
    (way,) = picture.iter(SVG + "polyline")
    expected = [place[3] for place in places]
    np.testing.assert_allclose(numbers(way.get("points", "")), expected, rtol=1e-4, atol=1e-9)


def test_half_planes_are_cut_off_at_the_edges_of_the_picture() -> None:
    picture = ElementTree.fromstring(room()._repr_svg_())
    left, top, width, height = map(float, picture.get("viewBox", "").split())
    walls = [numbers(wall.get("points", "")) for wall in picture.iter(SVG + "polygon")][:2]
    for wall, inner, outer in zip(walls, (0, 4), (left, left + width), strict=True):
        low, high = wall.min(axis=0), wall.max(axis=0)
        assert sorted((low[0], high[0])) == pytest.approx(sorted((inner, outer)), rel=1e-4)
        assert (low[1], high[1]) == pytest.approx((-top - height, -top), rel=1e-4)


def test_an_empty_world_and_one_point_have_a_picture() -> None:
    for world in (World(), World([Body(Particle(0.0), (1, 2))])):
        assert ElementTree.fromstring(world.draw()).get("width") == "480"
