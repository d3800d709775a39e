"""Paddle, balls, capsules, enemies, boss and gates: each is drawn where it is."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.draw.palette import CAPSULE_BODY, DIMMING, LUMA, PALETTE
from arkanoid.envs.draw.view import make_view
from arkanoid.envs.game.shapes import (
    boss_collider,
    enemy_colliders,
    paddle_collider,
    shard_collider,
)
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BEAM_HEIGHT,
    BEAM_WIDTH,
    BOSS_HITS,
    BOSS_X,
    BOSS_Y,
    CAPSULE_HEIGHT,
    CAPSULE_WIDTH,
    CAPSULES,
    CATCH,
    ENEMY_KINDS,
    ENLARGE,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GATE_TICKS,
    GATE_X,
    LASER,
    NO_CAPSULE,
    PADDLE_Y,
)
from arkanoid.envs.state import ABSENT, ENTERING, FLYING
from helpers.pictures import (
    PROPERTY,
    SIZES,
    changed,
    empty_game,
    new_game,
    outline,
    picture,
    pixel_areas,
    put_beam,
    put_beaten_boss,
    put_boss,
    put_capsule,
    put_enemy,
    put_long_paddle,
    put_paddle,
    put_power,
    put_shard,
    random_scene,
    region_in_pixels,
    to_pixels,
    upright,
)
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely import Point, Polygon


@PROPERTY
@given(
    size=st.sampled_from(SIZES),
    x=st.floats(0.2, FIELD_WIDTH - 0.2),
    y=st.floats(1.2, FIELD_HEIGHT - 0.2),
)
def test_a_ball_appears_where_it_is_and_nowhere_else(
    size: tuple[int, int], x: float, y: float
) -> None:
    batch = new_game()
    world = batch.worlds[0]
    world.brick_hits[:] = 0
    world.paddle_x = -9.0  # out of the picture
    world.ball_state[0] = ABSENT
    without = picture(batch, *size)
    world.ball_state[2] = FLYING
    world.ball_x[2], world.ball_y[2] = x, y
    with_ball = picture(batch, *size)
    mask = changed(with_ball, without)
    centre = Point(*to_pixels(*size, x, y))
    radius = BALL_RADIUS * make_view(*size)[0].scale
    assert not mask[pixel_areas(centre.buffer(radius + 0.01), *size) == 0.0].any()
    # The disc's coverage may be wrong by 1 / 8; the ball is bright on the dark field.
    assert mask[pixel_areas(centre.buffer(radius), *size) > 0.2].all()


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("size", [(84, 84), (60, 60), (42, 42), (84, 70), (120, 90)])
def test_the_ball_is_the_brightest_thing_in_small_pictures(
    size: tuple[int, int], channels: int
) -> None:
    """In grey and in each colour, wherever it is; it was the dimmest thing at 84 x 84."""
    batch, random = new_game(), np.random.default_rng(size)
    world, brightest = batch.worlds[0], 0
    for _ in range(200):
        random_scene(batch, random)
        world.ball_state[:] = ABSENT
        brightest = max(brightest, int(picture(batch, *size, channels).max()))
        world.ball_state[1] = FLYING
        world.ball_x[1] = random.uniform(BALL_RADIUS, FIELD_WIDTH - BALL_RADIUS)
        world.ball_y[1] = random.uniform(1.2, FIELD_HEIGHT - BALL_RADIUS)
        x, y = to_pixels(*size, world.ball_x[1], world.ball_y[1])
        shown = picture(batch, *size, channels)[max(0, int(y) - 1) : int(y) + 2]
        assert shown[:, max(0, int(x) - 1) : int(x) + 2].max(axis=(0, 1)).min() == 255
    assert brightest <= 225


# For each name: what puts the thing into a world, its region, and its x and y (None: any).
THINGS: dict[str, tuple[Any, Polygon, float | None, float | None]] = {
    "paddle": (put_paddle, outline(paddle_collider(2.0)), None, PADDLE_Y),
    "long paddle": (put_long_paddle, outline(paddle_collider(3.0)), None, PADDLE_Y),
    "boss": (put_boss, outline(boss_collider()), BOSS_X, BOSS_Y),
    "beaten boss": (put_beaten_boss, outline(boss_collider()), BOSS_X, BOSS_Y),
    "shard": (put_shard, outline(shard_collider()), None, None),
    "beam": (put_beam, upright(BEAM_WIDTH, BEAM_HEIGHT), None, None),
} | {
    f"enemy {kind}": (put_enemy(kind), outline(collider), None, None)
    for kind, collider in enumerate(enemy_colliders())
}


CAPSULE_REGION = upright(CAPSULE_WIDTH, CAPSULE_HEIGHT)


@cache
def own_colours(name: str, channels: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The darkest and the brightest [channels] of what a thing shows.

    A pixel at its edge mixes some of its colours, and so lies between the two.
    """
    put, region, fixed_x, fixed_y = THINGS[name]
    size, x, y = (1024, 1024), fixed_x or 5.0, fixed_y or 5.0
    batch = empty_game()
    put(batch.worlds[0], x, y)
    covered = pixel_areas(region_in_pixels(region, *size, x, y), *size)
    shown = picture(batch, *size, channels)[covered > 0.999].astype(np.int64)
    return shown.min(axis=0), shown.max(axis=0)


@pytest.mark.parametrize("name", THINGS)
@settings(deadline=None, max_examples=12)
@given(
    size=st.sampled_from(SIZES),
    channels=st.sampled_from([1, 3]),
    x=st.floats(1.5, FIELD_WIDTH - 1.5),
    y=st.floats(1.5, FIELD_HEIGHT - 1.5),
)
@example(size=(512, 384), channels=1, x=2.0, y=2.0)
@example(size=(512, 384), channels=1, x=1.7734375, y=7.75)
def test_a_thing_covers_the_pixels_of_its_collider_and_no_other(
    name: str, size: tuple[int, int], channels: int, x: float, y: float
) -> None:
    """The picture shows the whole collider, and nothing beside it.

    The examples: in grey, a speck of the field's pattern was as bright as an enemy's rim, or as a
    mixture of its rim and what is inside, and this test missed the rim there. A pixel changes by
    its coverage times the difference of the colours.
    """
    put, region, fixed_x, fixed_y = THINGS[name]
    batch = empty_game()
    without = picture(batch, *size, channels)
    x, y = fixed_x or x, fixed_y or y
    put(batch.worlds[0], x, y)
    mask = changed(without, picture(batch, *size, channels))
    covered = pixel_areas(region_in_pixels(region, *size, x, y), *size)
    assert not mask[covered <= 1e-9].any()
    # Further inside there may be dark eyes.
    inner = pixel_areas(region_in_pixels(region.buffer(-0.05), *size, x, y), *size)
    edge = (covered > 0.1) & (inner < 0.5)
    darkest, brightest = own_colours(name, channels)
    if size == (84, 84):
        darkest, brightest = DIMMING * darkest, DIMMING * brightest
    before = without.reshape(*size, channels).astype(np.int64)
    differ = np.maximum(darkest - before, before - brightest).max(axis=2)
    assert mask[edge & (covered * differ >= 2)].all()
    assert mask[covered > 0.1].mean() > 0.8


@PROPERTY
@given(
    size=st.sampled_from(SIZES),
    kind=st.integers(1, CAPSULES),
    x=st.floats(1.5, FIELD_WIDTH - 1.5),
    y=st.floats(1.5, FIELD_HEIGHT - 1.5),
)
def test_a_capsule_covers_its_collider_except_rounded_corners(
    size: tuple[int, int], kind: int, x: float, y: float
) -> None:
    batch = empty_game()
    without = picture(batch, *size)
    put_capsule(kind)(batch.worlds[0], x, y)
    mask = changed(without, picture(batch, *size))
    covered = pixel_areas(region_in_pixels(CAPSULE_REGION, *size, x, y), *size)
    rounded = CAPSULE_REGION.buffer(-0.1).buffer(0.1)
    within = pixel_areas(region_in_pixels(rounded, *size, x, y), *size)
    assert not mask[covered <= 1e-9].any()
    # The corners' coverage may be wrong by 1 / 8.
    assert mask[within > 0.25].all()


def thing_pictures(size: tuple[int, int], puts: list[Any]) -> list[NDArray[np.int64]]:
    """Grey pictures of things in the same place of an empty field."""
    pictures = []
    for put in puts:
        batch = empty_game()
        put(batch.worlds[0], 5.4, 6.1)
        pictures.append(picture(batch, *size, 1).astype(np.int64))
    return pictures


@pytest.mark.parametrize("size", [*SIZES, (84, 70)])
@pytest.mark.parametrize(
    "puts",
    [
        [put_capsule(kind) for kind in range(CAPSULES + 1)],
        [put_power(power) for power in (0, CATCH, ENLARGE, LASER)],
        [put_enemy(kind) for kind in range(ENEMY_KINDS)],
    ],
    ids=["capsules", "powers", "enemies"],
)
def test_kinds_of_things_differ_in_grey(size: tuple[int, int], puts: list[Any]) -> None:
    pictures = thing_pictures(size, puts)
    for index, one in enumerate(pictures):
        for other in pictures[index + 1 :]:
            # The smallest difference is between two capsules, whose bodies differ by 20.
            assert np.abs(one - other).max() >= 16


@pytest.mark.parametrize("size", SIZES)
def test_each_hit_on_the_boss_is_seen(size: tuple[int, int]) -> None:
    batch = empty_game()
    looks = set()
    for hits in range(BOSS_HITS + 1):
        batch.worlds[0].boss_hits = hits
        batch.worlds[0].shard_wait = 90
        looks.add(picture(batch, *size).tobytes())
    assert len(looks) == BOSS_HITS + 1


def test_the_bosss_mouth_glows_before_it_throws() -> None:
    batch = empty_game()
    batch.worlds[0].boss_hits = BOSS_HITS
    reds = []
    for wait in (90, 40, 20, 10, 0):
        batch.worlds[0].shard_wait = wait
        reds.append(int(picture(batch)[:, :, 0].sum()))
    assert reds[0] == reds[1] < reds[2] < reds[3] < reds[4]


@pytest.mark.parametrize("size", SIZES)
def test_gates_open_before_an_enemy_comes_in(size: tuple[int, int]) -> None:
    """They stay open for it, in the ceiling or, in small pictures, just below."""
    for gate, gate_x in enumerate(GATE_X):
        batch = empty_game()
        world = batch.worlds[0]
        closed = picture(batch, *size)
        world.enemy_gate = gate
        widths = []
        for wait in (GATE_TICKS, GATE_TICKS // 2, 0):
            world.enemy_wait = wait
            rows, columns = np.nonzero(changed(closed, picture(batch, *size)))
            widths.append(np.ptp(columns) + 1 if len(columns) else 0)
        assert widths[0] == 0 < widths[1] < widths[2]
        left, low = to_pixels(*size, gate_x - 0.5, FIELD_HEIGHT - 0.2)
        right, high = to_pixels(*size, gate_x + 0.5, FIELD_HEIGHT + 0.5)
        assert left - 1 < columns.min() <= columns.max() < right
        assert high - 1 < rows.min() <= rows.max() < low
        opened = picture(batch, *size)
        put_enemy(0)(world, gate_x, FIELD_HEIGHT + 0.9)  # still hidden
        world.enemy_state[1] = ENTERING
        world.enemy_wait, world.enemy_gate = 300, 1 - gate
        np.testing.assert_array_equal(opened, picture(batch, *size))


@pytest.mark.parametrize("size", SIZES)
def test_the_open_exit_is_seen_in_the_right_wall_beside_the_paddle(size: tuple[int, int]) -> None:
    batch = empty_game()
    closed = picture(batch, *size)
    batch.worlds[0].exit_open = 1
    rows, columns = np.nonzero(changed(closed, picture(batch, *size)))
    assert columns.min() >= int(to_pixels(*size, FIELD_WIDTH, 0.0)[0])
    assert columns.max() < to_pixels(*size, FIELD_WIDTH + 0.5, 0.0)[0]
    assert rows.min() < to_pixels(*size, 0.0, PADDLE_Y)[1] < rows.max()


def test_a_falling_capsule_is_drawn_with_its_letter() -> None:
    """The pixels that differ clearly from the body form the letter: another one for each kind."""
    batch = empty_game()
    assert batch.worlds[0].capsule == NO_CAPSULE
    inks = []
    for kind in range(1, CAPSULES + 1):
        put_capsule(kind)(batch.worlds[0], 5.5, 6.0)
        frame = picture(batch, 1024)
        left, top = (int(value) for value in to_pixels(1024, 768, 5.5 - 0.2, 6.0 + 0.14))
        body = PALETTE[CAPSULE_BODY + kind] @ LUMA
        inks.append(np.abs(frame[top : top + 18, left : left + 26] @ LUMA - body) > 60)
    for index, one in enumerate(inks):
        assert one.any()
        for other in inks[index + 1 :]:
            assert (one != other).sum() > 10


def test_a_paddle_that_the_rules_make_wide_is_drawn_wide() -> None:
    widths = []
    for factor in (1.0, 1.5):
        batch = new_game(paddle=factor)
        batch.worlds[0].ball_state[0] = ABSENT
        here = picture(batch)
        batch.worlds[0].paddle_x = -9.0
        columns = np.nonzero(changed(here, picture(batch)))[1]
        widths.append(columns.max() + 1 - columns.min())
    assert widths == [64, 96]
