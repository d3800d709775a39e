"""Platforms of tiles that move with one velocity: one ground, as if they stood."""

import math
from itertools import product
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import AxisAlignedRectangle, Body, Collider, Rectangle, World
from helpers.grounds import (
    CORNERS,
    FORMS,
    KINDS,
    LANDINGS,
    decimal,
    drop,
    random_frame,
    random_mover,
    run_edited,
)

UNIT_ROUNDOFF = 2.0**-53
TILE = AxisAlignedRectangle(2, 2)
SPIKE = Rectangle(1, 1, math.pi / 4)
DRIFT = (0.5, 0.25)


@pytest.mark.parametrize(("shape", "reach"), CORNERS)
@pytest.mark.parametrize("drift", [(0.3, 0.2), (0, 0.5), (1.7, 0)])
def test_a_corner_that_lands_on_a_seam_of_a_platform_meets_the_ground(
    shape: Collider, reach: float, drift: tuple[float, float]
) -> None:
    """Of 648 landings 260 went aside, or fell through: each tile was an end of the ground."""
    rng = np.random.default_rng(8)
    for vx, vy, high, restitution in product((0, 0.1, -1, 3), (1e-6, 0.1, 1, 2), (0, 0.3), (0, 1)):
        offset = float(rng.choice([-1, 0, 1])) * 10 ** rng.uniform(-17, -9)
        time = high / vy
        if abs(vx) * (time + 0.5) > 3:
            continue
        row = [Body(AxisAlignedRectangle(1, 0.2), (i, 0.1), drift) for i in range(-4, 5)]
        place = (0.5 + offset - vx * time, 0.2 + reach + high)
        tiles = [row[i] for i in rng.permutation(len(row))]
        world = World([*tiles, Body(shape, place, np.add((vx, -vy), drift), 1, restitution)])
        (hit,) = world.step(time + 0.5)
        assert hit["normal"].tolist() == [0, 1]
        expected = np.add((vx, restitution * vy), drift)
        assert world.velocities[-1] == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize(("shape", "reach"), CORNERS)
def test_a_platform_that_has_stopped_beside_the_floor_goes_on_in_it(
    shape: Collider, reach: float
) -> None:
    """It is kinematic and at rest, and the floor static: they meet at x = 1/2."""
    for vx, moves_left in product((0, 0.1, -1, 3), (True, False)):
        tiles = [
            Body(AxisAlignedRectangle(1, 0.2), (i, 0.1), (0, float((i <= 0) == moves_left)))
            for i in range(-4, 5)
        ]
        place = (0.5 - vx * 0.3, 0.5 + reach)
        world = World([*tiles, Body(shape, place, (vx, -1), mass=1)])
        for handle in range(len(tiles)):
            world.place(handle, velocity=(0, 0))
        (hit,) = world.step(0.8)
        assert hit["normal"].tolist() == [0, 1]
        assert world.velocities[-1].tolist() == [vx, 1]


@pytest.mark.parametrize("kind", KINDS)
def test_what_lands_on_a_platform_bounces_as_off_one_body(kind: str) -> None:
    """Turned as a whole, and often met at a seam or almost along it."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        frame, form = random_frame(rng, rng.random() < 0.5), str(rng.choice(FORMS))
        width, height = decimal(rng, 0.3, 2), decimal(rng, 0.2, 1)
        x, y = decimal(rng, -20, 20), decimal(rng, -20, 20)
        shape, speed = random_mover(rng, kind, frame.angle), decimal(rng, 0.5, 5)
        slope = 10 ** rng.uniform(-12, 0.3)
        gap = float(rng.choice([0.0, 10 ** rng.uniform(-16, 0)]))
        start = rng.uniform(2, 4) * width
        if rng.random() < 0.3 and gap / slope < width:
            start = 2.5 * width - gap / slope + float(rng.choice([0, 1e-9, -1e-9, 1e-12, -1e-12]))
        drift = rng.uniform(-2, 2, 2)
        place = frame.turn(x + start, y + height / 2 + drop(shape, frame) + gap)
        body = Body(shape, place, drift + frame.turn(speed, -speed * slope), 1)
        row = [frame.block(form, x + i * width, y, width, height) for i in range(12)]
        for block in row:
            block.velocity = drift
        wall = frame.block(form, x + 5.5 * width, y, 12 * width, height)
        tiles, whole = World([*row, body]), World([Body(wall.collider, wall.position, drift), body])
        for world in (tiles, whole):
            world.step(4 * width / speed)
        turn = math.dist(tiles.velocities[-1], whole.velocities[-1]) / speed
        assert turn <= 64 * UNIT_ROUNDOFF * (abs(x) + abs(y) + 12 * width) / width


@pytest.mark.parametrize("others", [0, 20])
@pytest.mark.parametrize(("shape", "place", "velocity"), LANDINGS)
def test_a_tile_of_a_platform_that_comes_or_goes_makes_or_ends_a_seam(
    shape: Collider, place: Any, velocity: Any, others: int
) -> None:
    """Nobody plans to meet the next tile; yet a plan to meet the first one depends on it."""
    tile, next_tile = Body(TILE, (0, 0), DRIFT), Body(TILE, (2, 0), DRIFT)
    later_tile = Body(TILE, (2 + 0.5 * DRIFT[0], 0.5 * DRIFT[1]), DRIFT)
    stays = Body(TILE, (2, 0), (0.5, 0.5))
    body = Body(shape, place, np.add(velocity, DRIFT), 1)
    level = run_edited([tile, body, next_tile], lambda world: None, others)
    corner = run_edited([tile, body], lambda world: None, others)
    assert level["normal"].tolist() in ([[0, 1]], [[0, -1]])
    assert level["normal"].tolist() != corner["normal"].tolist()
    assert len(run_edited([tile, body, stays], lambda world: None, others)) >= len(corner)
    come = run_edited([tile, body], lambda world: world.add(later_tile), others)
    joined = run_edited(
        [tile, body, Body(TILE, (2, 50), DRIFT)],
        lambda world: world.place(2, later_tile.position),
        others,
    )
    for edited in (come, joined):
        assert edited.tobytes() == level.tobytes()
    edits = (
        lambda world: world.remove(2),
        lambda world: world.change(2, active=False),
        lambda world: world.place(2, (50, 50)),
        lambda world: world.place(2, velocity=(0.5, -50)),
        lambda world: world.change(2, mask=0),
        lambda world: world.change(2, sensor=True),
    )
    for edit in edits:
        edited = run_edited([tile, body, next_tile], edit, others)
        assert edited.tobytes() == corner.tobytes()
