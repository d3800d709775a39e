"""Two bodies in a browser: the bits of the processor, and the answers of the engine's functions."""

import base64
import json
import math
from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.browser.manifest import make_manifest
from arkanoid.envs.browser.shipped import game_module
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
    contact,
    detect,
    relax,
    time_of_impact,
)
from arkanoid.physics.scenes.meeting import meet_figures
from arkanoid.physics.scenes.patterns import POLYGONS, make_patterns, make_turns
from arkanoid.physics.scenes.records import MAX_EDGES, Meeting
from arkanoid.physics.shapes.boundary import BoundaryEdge
from arkanoid.physics.shapes.records import Edge, Shape
from arkanoid.physics.shapes.table import shape_table
from helpers.node import run_jobs
from helpers.repository import ROOT

SOURCES = ROOT / "envs" / "browser"
COLLIDERS = (
    *("Particle", "HalfPlane", "AxisAlignedHalfPlane", "AxisAlignedRectangle", "Rectangle"),
    "Convex",
)
ROUNDS = 40  # of all 36 pairs
DIRECTIONS = ("+y", "-x", "-y", "+x")  # of the half-plane at each quarter turn


def random_figure(collider: str, luck: np.random.Generator, odd: bool) -> dict[str, Any]:
    """Return a body; every number of odd ones has all its digits, others are often special."""

    def number(low: float, high: float) -> float:
        drawn = luck.uniform(low, high)
        return float(drawn) if odd else round(2 * float(drawn)) / 2

    polygon = str(luck.choice(list(POLYGONS)))
    count = len(POLYGONS[polygon])
    missing = luck.choice(count, luck.integers(count), replace=False) if luck.random() < 0.5 else []
    return {
        "collider": collider,
        "polygon": polygon,
        "open": "".join(map(str, sorted(missing))),
        "width": max(0.25, number(0.0, 3.0)),
        "height": max(0.25, number(0.0, 3.0)),
        "turn": int(luck.integers(360)) if odd else 45 * int(luck.integers(8)),
        "x": number(-3.0, 3.0),
        "y": number(-3.0, 3.0),
        "vx": number(-2.0, 2.0),
        "vy": number(-2.0, 2.0),
        "mass": max(0.0, number(-1.0, 4.0)),
        "restitution": max(0.0, number(-0.2, 1.0)),
    }


@cache
def pairs() -> list[tuple[dict, dict]]:
    luck = np.random.default_rng(16)
    return [
        (random_figure(a, luck, odd=bool(number % 4)), random_figure(b, luck, odd=bool(number % 4)))
        for number in range(ROUNDS)
        for a in COLLIDERS
        for b in COLLIDERS
    ]


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> list[dict]:
    """Return what the module of browsers says of all pairs."""
    folder: Path = tmp_path_factory.mktemp("meetings")
    (folder / "module.wasm").write_bytes(game_module())
    (folder / "manifest.json").write_text(json.dumps(make_manifest({})), encoding="utf-8")
    files = folder / "module.wasm", folder / "manifest.json"
    return run_jobs(Path(__file__).with_name("meet.mjs"), folder, pairs(), SOURCES, *files)


@cache
def meetings() -> np.ndarray:
    """Return what the processor says of all pairs, `Meeting` records.

    One record is used again and again, as in the browser: bytes that a pair does not need stay.
    """
    patterns = make_patterns()
    rows = {name: row for row, name in enumerate(patterns)}
    shapes, edges = shape_table(patterns.values())
    turns = make_turns()
    records = np.zeros(len(pairs()), Meeting)
    record = np.zeros(1, Meeting)
    for index, figures in enumerate(pairs()):
        for table, name in ((shapes, "patterns"), (edges, "pattern_edges"), (turns, "turns")):
            record[name] = table.ctypes.data
        record["number_of_patterns"], record["number_of_edges"] = len(shapes), len(edges)
        for side, figure in zip("ab", figures, strict=True):
            name = figure["collider"]
            if name == "Convex":
                name = f"Convex {figure['polygon']} {figure['open']}".rstrip()
            record[side]["pattern"] = rows[name]
            for field in ("turn", "width", "height", "x", "y", "vx", "vy", "mass", "restitution"):
                record[side][field] = figure[field]
        meet_figures(record.ctypes.data, record[0])
        records[index] = record[0]
    return records


def test_the_bits_of_the_processor(answers: list[dict]) -> None:
    """Every byte, except for the addresses of tables."""
    decoded = b"".join(base64.b64decode(answer["bytes"]) for answer in answers)
    there, here = np.frombuffer(decoded, Meeting).copy(), meetings().copy()
    for records in (there, here):
        for name in ("patterns", "pattern_edges", "turns"):
            records[name] = 0
    assert there.tobytes() == here.tobytes()


def test_the_algorithms(answers: list[dict]) -> None:
    """All six of them served."""
    named = Counter(answer["algorithm"] for answer in answers)
    assert set(named) == {
        *("disc-disc", "disc-half-plane", "disc-box", "disc-convex"),
        *("box-box", "convex-convex"),
    }


def collider_of(figure: dict) -> Collider:
    """Return the collider that a user of Python would write."""
    width, height, turn = figure["width"], figure["height"], figure["turn"]
    angle = math.radians(turn)
    name = figure["collider"]
    if name == "Convex":
        vertices = [(width * x, width * y) for x, y in POLYGONS[figure["polygon"]]]
        return Convex(vertices, map(int, figure["open"]), angle)
    return {
        "Particle": Particle(width),
        "HalfPlane": HalfPlane((-math.sin(angle), math.cos(angle))),
        "AxisAlignedHalfPlane": AxisAlignedHalfPlane(DIRECTIONS[turn // 90]),
        "AxisAlignedRectangle": AxisAlignedRectangle(width, height),
        "Rectangle": Rectangle(width, height, angle),
    }[name]


class Placed(Collider):
    """A collider with the very edges of a record."""

    def __init__(self, shape: Any, edges: np.ndarray) -> None:
        own = edges[shape["first"] : shape["first"] + shape["count"]]
        self.kind = int(shape["kind"])
        self._edges = tuple(BoundaryEdge(*edge.tolist()) for edge in own)
        self._rounding = float(shape["radius"])

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        return self._edges

    @property
    def rounding(self) -> float:
        return self._rounding


def placed(record: Any) -> tuple[Placed, Placed]:
    shapes = np.frombuffer(record["shapes"].tobytes(), Shape)
    edges = np.frombuffer(record["edges"].tobytes(), Edge)
    assert len(edges) == 2 * MAX_EDGES
    return Placed(shapes[0], edges), Placed(shapes[1], edges)


def test_the_shapes_are_the_colliders() -> None:
    """Edges of a polygon may begin elsewhere; all numbers agree to their last digits."""
    for figures, record in zip(pairs(), meetings(), strict=True):
        for figure, shape in zip(figures, placed(record), strict=True):
            expected = collider_of(figure)
            assert shape.kind == expected.kind
            assert shape.rounding == expected.rounding
            left = sorted(map(tuple, shape.edges), key=lambda edge: math.atan2(edge[1], edge[0]))
            right = sorted(map(tuple, expected.edges), key=lambda e: math.atan2(e[1], e[0]))
            assert len(left) == len(right)
            if left:
                turned = min(
                    np.abs(np.roll(left, by, axis=0) - np.array(right)).max()
                    for by in range(len(left))
                )
                assert turned < 1e-13, figure


def body_of(figure: dict, collider: Collider) -> Body:
    place, velocity = (figure["x"], figure["y"]), (figure["vx"], figure["vy"])
    return Body(collider, place, velocity, figure["mass"] or None, figure["restitution"])


def test_the_answers_are_those_of_the_functions() -> None:
    """Bit for bit; a bounce in Python makes its normal a unit vector once more."""
    seen: Counter[str] = Counter()
    for figures, record in zip(pairs(), meetings(), strict=True):
        a, b = map(body_of, figures, placed(record))
        found, impact = contact(a, b), time_of_impact(a, b)
        assert record["overlap"] == detect(a, b) == (found is not None)
        if found is not None:
            seen["overlap"] += 1
            said = [
                record[name] for name in ("normal_x", "normal_y", "depth", "point_x", "point_y")
            ]
            assert said == [*found.normal, found.depth, *found.point]
        assert record["time"] == (math.inf if impact is None else impact.time)
        if impact is not None:
            seen["impact"] += impact.time > 0
            assert record["touching"] or impact.time > 0
            assert (record["impact_normal_x"], record["impact_normal_y"]) == tuple(impact.normal)
            if impact.normal.any():
                assert record["impulse"] == pytest.approx(bounce(a, b, impact.normal), abs=1e-14)
                seen["bounce"] += record["impulse"] != 0
        for side, body in (("a", a), ("b", b)):
            bounced = [record[side]["bounced_vx"], record[side]["bounced_vy"]]
            assert bounced == pytest.approx(body.velocity, abs=1e-14)
        if found is not None and found.depth < math.inf:
            relax(a, b, found)
            seen["relaxation"] += 1
        for side, body in (("a", a), ("b", b)):
            assert [record[side]["relaxed_x"], record[side]["relaxed_y"]] == body.position.tolist()
    assert min(seen[name] for name in ("overlap", "impact", "bounce", "relaxation")) > 100, seen


def test_outlines_are_the_corners() -> None:
    """What is closed is drawn from corner to corner."""
    for record in meetings():
        for side, shape in zip("ab", placed(record), strict=True):
            corners = record[side]["outline"].reshape(-1, 2)[: record[side]["corners"]]
            ends = [(edge.start_x, edge.start_y) for edge in shape.edges if edge.has_start]
            if shape.edges:
                for end in ends:
                    assert np.abs(corners - end).max(axis=1).min() < 1e-9
                assert len(corners) >= max(3, len(ends))
            else:
                assert len(corners) == 0
