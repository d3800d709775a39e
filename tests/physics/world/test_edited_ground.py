"""Edits of what a plan relies on besides its two bodies: the ground beside a tile, and numbers."""

import math
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import AxisAlignedRectangle, Body, Collider, Rectangle, World
from helpers.bodies import DISC
from helpers.grounds import LANDINGS, run_edited

TILE = Body(AxisAlignedRectangle(2, 2))
NEXT_TILE = Body(TILE.collider, (2, 0))
SPIKE = Rectangle(1, 1, math.pi / 4)


@pytest.mark.parametrize("others", [0, 20])
@pytest.mark.parametrize(("shape", "place", "velocity"), LANDINGS)
def test_a_tile_that_comes_or_goes_makes_or_ends_a_seam(
    shape: Collider, place: Any, velocity: Any, others: int
) -> None:
    """What lands where a tile ends meets its corner, or the ground if there is a next tile.

    Nobody plans to meet that next tile; yet the plan depends on it.
    """
    body = Body(shape, place, velocity, 1)
    level = run_edited([TILE, body, NEXT_TILE], lambda world: None, others)
    corner = run_edited([TILE, body], lambda world: None, others)
    assert level["normal"].tolist() in ([[0, 1]], [[0, -1]])
    assert level["normal"].tolist() != corner["normal"].tolist()
    come = run_edited([TILE, body], lambda world: world.add(NEXT_TILE), others)
    gone = run_edited([TILE, body, NEXT_TILE], lambda world: world.remove(2), others)
    off = run_edited([TILE, body, NEXT_TILE], lambda world: world.change(2, active=False), others)
    away = run_edited([TILE, body, NEXT_TILE], lambda world: world.place(2, (50, 50)), others)
    masked = run_edited([TILE, body, NEXT_TILE], lambda world: world.change(2, mask=0), others)
    sensor = run_edited([TILE, body, NEXT_TILE], lambda world: world.change(2, sensor=True), others)
    assert come.tobytes() == level.tobytes()
    for edited in (gone, off, away, masked, sensor):
        assert edited.tobytes() == corner.tobytes()


def test_a_body_that_is_added_changes_no_plan_to_meet_together() -> None:
    """The number of a planned pair depended on how many bodies there were.

    After an `add`, the plans from before named other bodies, or none at all: memory was read that
    belongs to nobody.
    """
    bodies = [
        Body(DISC, (-50, 0)),  # of a pair with body 0 the number was always right
        Body(DISC, (0, 0), (1, 0), 1),
        Body(DISC, (4, 0.6), (0, 0), 1),
        Body(DISC, (4, -0.6), (0, 0), 1),
    ]
    expected = World(bodies)
    world = World(bodies)
    for each in (expected, world):
        assert len(each.step(0.5)) == 0
    for index in range(3):  # so few that no larger table is needed, which makes all plans anew
        world.add(Body(DISC, (100 + 3 * index, 0)))
    hits, right = world.step(4.0), expected.step(4.0)
    assert len(right) == 2
    assert hits.tobytes() == right.tobytes()
    assert np.array_equal(world.velocities[:4], expected.velocities)
