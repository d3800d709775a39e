"""What a world refuses; each message says which value is wrong and why."""

import math
from copy import deepcopy
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    Body,
    HalfPlane,
    HitLimitWarning,
    InseparableError,
    NoBodyError,
    World,
    WorldBatch,
)
from helpers.bodies import DISC, FLOOR, Fog

NAN, INF = math.nan, math.inf
HUGE = 10**5000


TWO = [FLOOR, Body(DISC, (0, 2), (0, 1), mass=1)]
WRONG: list[tuple[str, Any, type[Exception], str]] = [
    ("no body", lambda w: w.add(3), TypeError, "needs a collider and a position; 3 lacks one"),
    ("no collider", lambda w: w.add(Fog("disc", (0, 0))), TypeError, "collider.*not 'disc'"),
    ("place", lambda w: w.add(Fog(DISC, (0, NAN))), ValueError, r"position\[1\].*finite.*nan"),
    ("place 3", lambda w: w.add(Fog(DISC, (0, 1, 2))), ValueError, "position.*two.*has 3"),
    ("category", lambda w: w.add(FLOOR, category=1.0), TypeError, "category.*integer.*1.0"),
    ("category", lambda w: w.add(FLOOR, category=1 << 64), ValueError, "category.*64 bits"),
    ("mask", lambda w: w.add(FLOOR, mask=-(1 << 63) - 1), ValueError, "mask.*64 bits.*-9223"),
    ("mask", lambda w: w.add(FLOOR, mask="all"), TypeError, "mask.*integer.*'all'"),
    ("max_hits", lambda _: World(max_hits=0), ValueError, "max_hits must be at least 1.*0"),
    ("rest_speed", lambda _: World(rest_speed=-0.1), ValueError, "rest_speed.*negative.*-0.1"),
    ("rest_speed", lambda _: World(rest_speed=math.nan), ValueError, "rest_speed.*finite.*nan"),
    ("rest_speed", lambda _: World(rest_speed=math.inf), ValueError, "rest_speed.*finite.*inf"),
    ("rest_speed", lambda _: World(rest_speed="1"), TypeError, "rest_speed.*'1'"),
    ("max_hits", lambda _: World(max_hits=1.5), TypeError, "max_hits.*integer.*1.5"),
    ("bodies", lambda _: World([DISC]), TypeError, "collider and a position"),
    ("remove", lambda w: w.remove(2), NoBodyError, "no body 2, and there never was"),
    ("remove", lambda w: w.remove(-1), NoBodyError, "no body -1, and there never was"),
    ("remove", lambda w: w.remove(0.0), TypeError, "body.*integer.*0.0"),
    ("body", lambda w: w.body(2), NoBodyError, "no body 2, and there never was"),
    ("place", lambda w: w.place(5, (0, 0)), NoBodyError, "no body 5"),
    ("place", lambda w: w.place(1, (0, INF)), ValueError, r"position\[1\].*finite.*inf"),
    ("place", lambda w: w.place(1, 3), TypeError, "position must be two numbers.*3"),
    ("place", lambda w: w.place(0, None, (NAN, 0)), ValueError, r"velocity\[0\].*finite.*nan"),
    ("pair", lambda w: w.set_restitution(1, 1, 0.5), ValueError, "two bodies, but both are 1"),
    ("pair", lambda w: w.set_restitution(0, 1, -0.5), ValueError, "restitution.*negative.*-0.5"),
    ("pair", lambda w: w.set_restitution(0, 2, 0.5), NoBodyError, "no body 2"),
    ("place", lambda w: w.place(1, (0, HUGE)), ValueError, r"position\[1\] is too large"),
    ("place", lambda w: w.place(1, (1e150, 0)), ValueError, r"position must be at most 1e\+140"),
    ("place", lambda w: w.place(1, velocity=(0, 1e150)), ValueError, "velocity must be at most"),
    ("mass", lambda w: w.add(Fog(DISC, (-HUGE, 0))), ValueError, r"position\[0\] is too large"),
    ("pair", lambda w: w.set_restitution(0, 1, HUGE), ValueError, "restitution is too large"),
    ("ray", lambda w: w.query_ray((0, 0), (0, HUGE)), ValueError, r"end\[1\] is too large"),
    ("dt", lambda w: w.step(HUGE), ValueError, "dt is too large for a float"),
    ("steps", lambda w: w.step(1.0, HUGE), ValueError, "steps must fit into 64 bits"),
    ("max_hits", lambda _: World(max_hits=HUGE), ValueError, "max_hits must fit into 64 bits"),
    ("dt", lambda w: w.step(-0.1), ValueError, "dt must not be negative.*-0.1"),
    ("dt", lambda w: w.step(NAN), ValueError, "dt must be finite.*nan"),
    ("dt", lambda w: w.step(INF), ValueError, "dt must be finite.*inf"),
    ("dt", lambda w: w.step("1"), TypeError, "dt must be a number.*'1'"),
    ("dt", lambda w: w.step(None), TypeError, "dt must be a number.*None"),
    ("steps", lambda w: w.step(1.0, 0), ValueError, "steps must be at least 1.*0"),
    ("steps", lambda w: w.step(1.0, 2.0), TypeError, "steps.*integer.*2.0"),
    ("steps", lambda w: w.step(1.0, True), TypeError, "steps.*integer.*True"),
    ("batch", lambda w: WorldBatch(w, 0), ValueError, "num_worlds must be at least 1"),
    ("batch", lambda w: WorldBatch(w, 2, threads=0), ValueError, "threads must be at least 1"),
    ("batch", lambda w: WorldBatch(w, "2"), TypeError, "num_worlds.*integer.*'2'"),
    ("copy", lambda w: deepcopy(WorldBatch(w, 2)), TypeError, "Batch cannot be.*a snapshot"),
]


@pytest.mark.parametrize("is_built", [False, True])
@pytest.mark.parametrize(
    ("call", "error", "message"), [row[1:] for row in WRONG], ids=[row[0] for row in WRONG]
)
def test_invalid_arguments_are_refused_and_change_nothing(
    call: Any, error: type[Exception], message: str, is_built: bool
) -> None:
    world = World(TWO)
    if is_built:
        world.step(1.0)
    before = world.positions, world.velocities, world.time, len(world)
    with pytest.raises(error, match=message):
        call(world)
    assert world.positions.tobytes() == before[0].tobytes()
    assert world.velocities.tobytes() == before[1].tobytes()
    assert (world.time, len(world)) == before[2:]


def test_a_position_too_large_for_a_number_is_an_error_at_once() -> None:
    """It was an error one step later, or never: infinity equals itself, so the plans still held."""
    fast = World([Body(DISC, (0, 0), (1e139, 0), mass=1)])
    before = fast.snapshot()
    for _ in range(2):
        with pytest.raises(ValueError, match=r"too large"):
            fast.step(1e10)
    fast.restore(before)
    fast.step(1.0)
    assert np.isfinite(fast.positions).all()


def test_a_ball_that_is_faster_after_each_hit_is_stopped() -> None:
    """Between two walls with restitution above 1, hits come faster and faster, up to one time."""
    room = World([FLOOR, Body(AxisAlignedHalfPlane("-y"), (0, 3))])
    room.add(Body(DISC, (0, 1), (0, 1), mass=1, restitution=1.5))
    with pytest.warns(HitLimitWarning):
        room.step(1e10)
    assert room.capped == 1
    assert room.velocities[-1].tolist() == [0, 0]
    assert np.isfinite(room.positions).all()


def test_inseparable_bodies_are_named() -> None:
    """For two half-planes at an angle, the error says which, and the world can be corrected."""
    ramp = Body(HalfPlane((1, 2)), (3, 4), mass=1)
    world = World([Body(DISC), FLOOR, ramp])
    with pytest.raises(InseparableError, match="no finite translation separates") as caught:
        world.step(1.0)
    assert {repr(caught.value.a), repr(caught.value.b)} == {repr(FLOOR), repr(ramp)}
    for part in (repr(FLOOR), repr(ramp)):
        assert part in str(caught.value)
    assert len(world) == 3
    world.remove(1)
    assert world.step(1.0).shape == (0,)


@pytest.mark.parametrize("how", ["static", "masked", "sensor", "kinematic", "back to back"])
def test_only_bodies_that_must_be_separated_are_inseparable(how: str) -> None:
    world = World([FLOOR])
    if how == "back to back":
        world.add(Body(AxisAlignedHalfPlane("-y"), (0, 1), mass=1))
    elif how == "kinematic":
        world.add(Body(HalfPlane((1, 2)), (0, 0), velocity=(1, 0)))
    else:
        mass = None if how == "static" else 1.0
        mask = 2 if how == "masked" else -1
        world.add(Body(HalfPlane((1, 2)), mass=mass), mask=mask, sensor=how == "sensor")
    world.step(1.0)
    assert np.isfinite(world.positions).all()
