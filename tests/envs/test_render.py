"""Pictures of a world: every thing is where the rules say, and nothing else is touched."""

import hashlib
import os
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.palette import BRICK, LUMA, PALETTE
from arkanoid.envs.render import draw_world
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BRICK_HEIGHT,
    BRICK_WIDTH,
    COLOURS,
    COLUMNS,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GOLD,
    LATTICE_TOP,
    PADDLE_Y,
    ROWS,
    SILVER,
    UNBREAKABLE,
)
from arkanoid.envs.shapes import paddle_collider
from arkanoid.envs.state import ABSENT, FLYING
from arkanoid.envs.view import FULL_HEIGHT, FULL_WIDTH, HEADER_SCALE, make_view
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely import Point, Polygon, area, box, intersection

# The first example of a size draws its background and may compile kernels.
PROPERTY = settings(deadline=None, max_examples=40)
SIZES = [(84, 84), (210, 160), (512, 384)]


def new_game(**keywords: Any) -> Batch:
    batch = Batch(1, Config(**keywords))
    batch.seed(0, 1)
    batch.reset(np.ones(1, np.bool_))
    return batch


def picture(batch: Batch, height: int = 512, width: int | None = None) -> NDArray[np.uint8]:
    return draw_world(batch.worlds, batch.rules, 0, height, width)


def changed(one: NDArray[np.uint8], other: NDArray[np.uint8]) -> NDArray[np.bool_]:
    return (one != other).any(axis=2)


def pixel_areas(region: Any, height: int, width: int) -> NDArray[np.float64]:
    """The area of a Shapely region within each pixel."""
    areas = np.zeros((height, width))
    left, top, right, bottom = (int(bound) for bound in region.bounds)
    columns, rows = np.meshgrid(
        np.arange(max(left - 1, 0), min(right + 2, width)),
        np.arange(max(top - 1, 0), min(bottom + 2, height)),
    )
    areas[rows, columns] = area(intersection(box(columns, rows, columns + 1, rows + 1), region))
    return areas


def place(height: int, width: int, x: float, y: float) -> tuple[float, float]:
    view = make_view(height, width)[0]
    return view.left + x * view.scale, view.bottom - y * view.scale


def test_the_default_picture_has_32_pixels_a_brick() -> None:
    frame = picture(new_game())
    assert frame.shape == (512, 384, 3)
    assert frame.dtype == np.uint8
    assert make_view(512, 384)[0].scale == 32.0
    assert place(512, 384, 0.0, 0.0) == (16.0, 512.0)


@PROPERTY
@given(height=st.integers(1, 400), width=st.integers(1, 400))
def test_the_field_fits_any_size_and_is_centred(height: int, width: int) -> None:
    view = make_view(height, width)[0]
    left, right = place(height, width, 0.0, 0.0)[0], place(height, width, FIELD_WIDTH, 0.0)[0]
    bottom, top = place(height, width, 0.0, 0.0)[1], place(height, width, 0.0, FIELD_HEIGHT)[1]
    # Its place is rounded to whole pixels.
    assert -0.5 <= top < bottom <= height + 0.5
    assert abs(left - (width - right)) <= 1.0
    shown = FULL_HEIGHT if view.header else FIELD_HEIGHT
    assert view.scale == min(height / shown, width / FULL_WIDTH)
    assert bool(view.header) == (min(height / FULL_HEIGHT, width / FULL_WIDTH) >= HEADER_SCALE)
    assert (np.diff(view.columns) >= 0).all()
    assert (np.diff(view.rows) >= 0).all()


@pytest.mark.parametrize("size", [(1, 1), (1, 300), (300, 1), (13, 7), (40, 40), (97, 101)])
def test_any_size_can_be_drawn(size: tuple[int, int]) -> None:
    assert picture(new_game(), *size).shape == (*size, 3)


def test_illegal_sizes_are_refused() -> None:
    batch = new_game()
    for size in (0, -3, 10**6):
        with pytest.raises(ValueError, match=f"height must be between 1 and .* got {size}"):
            picture(batch, size)
    with pytest.raises(TypeError, match="width must be an integer"):
        picture(batch, 84, 84.0)  # type: ignore[arg-type]


@pytest.mark.parametrize("size", SIZES)
def test_the_same_world_gives_the_same_bits_in_a_fresh_array(size: tuple[int, int]) -> None:
    batch = new_game()
    before = batch.worlds.copy()
    first = picture(batch, *size)
    kept = first.copy()
    first[:] = 7  # a caller may do as he likes with it
    second = picture(batch, *size)
    np.testing.assert_array_equal(second, kept)
    np.testing.assert_array_equal(batch.worlds, before)


SCRIPT = """
import hashlib, numpy as np
from arkanoid.envs.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.render import draw_world
batch = Batch(1, Config())
batch.seed(0, 1)
batch.reset(np.ones(1, np.bool_))
world = batch.worlds[0]
world.ball_x[0], world.ball_y[0], world.paddle_x, world.score = 3.21, 4.56, 7.89, 9870
for size in ((84, 84), (130, 100)):
    frame = draw_world(batch.worlds, batch.rules, 0, *size)
    print(hashlib.sha256(frame.tobytes()).hexdigest())
"""


def test_interpreted_kernels_draw_the_same_bits() -> None:
    printed = [
        subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env=os.environ | {"NUMBA_DISABLE_JIT": disabled},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for disabled in ("0", "1")
    ]
    assert len(printed[0].split()) == 2
    assert printed[0] == printed[1]


@PROPERTY
@given(
    size=st.sampled_from(SIZES),
    x=st.floats(0.2, FIELD_WIDTH - 0.2),
    y=st.floats(0.2, FIELD_HEIGHT - 0.2),
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
    centre = Point(*place(*size, x, y))
    radius = BALL_RADIUS * make_view(*size)[0].scale
    assert not mask[pixel_areas(centre.buffer(radius + 0.01), *size) == 0.0].any()
    # The disc's coverage may be wrong by 1 / 8, and what is left is bright on the dark field.
    assert mask[pixel_areas(centre.buffer(radius), *size) > 0.2].all()


@PROPERTY
@given(size=st.sampled_from(SIZES), x=st.floats(1.0, FIELD_WIDTH - 1.0))
def test_the_paddle_covers_the_pixels_of_its_collider(size: tuple[int, int], x: float) -> None:
    """The picture shows what collides: where the collider is, all of it, and nothing beside it."""
    batch = new_game()
    batch.worlds[0].ball_state[0] = ABSENT
    batch.worlds[0].paddle_x = x
    here = picture(batch, *size)
    batch.worlds[0].paddle_x = -9.0  # out of the picture
    gone = picture(batch, *size)
    points = np.array(paddle_collider(2.0).vertices)
    corners = [place(*size, x + point[0], PADDLE_Y + point[1]) for point in points]
    covered = pixel_areas(Polygon(corners), *size)
    mask = changed(here, gone)
    assert not mask[covered == 0.0].any()
    # Its colours differ by more than 50 from the field's: a 20th part of that is seen.
    assert mask[covered > 0.05].all()


@PROPERTY
@given(
    size=st.sampled_from([*SIZES, (100, 100), (333, 251)]),
    row=st.integers(0, ROWS - 1),
    column=st.integers(0, COLUMNS - 1),
)
def test_removing_a_brick_changes_its_cell_and_no_other_pixel(
    size: tuple[int, int], row: int, column: int
) -> None:
    batch = new_game()
    batch.worlds["kind"] = 1 + (np.arange(ROWS * COLUMNS) % GOLD)
    batch.worlds[0].brick_hits[:] = 1
    full = picture(batch, *size)
    batch.worlds[0].brick_hits[row * COLUMNS + column] = 0
    rows, columns = np.nonzero(changed(full, picture(batch, *size)))
    left, top = place(*size, column * BRICK_WIDTH, LATTICE_TOP - row * BRICK_HEIGHT)
    scale = make_view(*size)[0].scale
    # Cells begin at whole pixels, at most half a pixel from their place.
    assert columns.min() >= left - 0.5
    assert columns.max() + 1 <= left + BRICK_WIDTH * scale + 0.5
    assert rows.min() >= top - 0.5
    assert rows.max() + 1 <= top + BRICK_HEIGHT * scale + 0.5
    # All of the brick is gone, but for the mortar around it.
    assert len(rows) >= 0.8 * BRICK_WIDTH * BRICK_HEIGHT * scale**2 - 2 * (scale + 1)


def brick_pictures(height: int, width: int) -> list[NDArray[np.int64]]:
    """The greyscale pixels of the same cell with a brick of each kind."""
    batch = new_game()
    pictures = []
    view = make_view(height, width)[0]
    batch.worlds[0].brick_hits[:] = 0
    for kind in range(1, GOLD + 1):
        batch.worlds["kind"] = kind
        batch.worlds[0].brick_hits[60] = UNBREAKABLE if kind == GOLD else 2
        grey = picture(batch, height, width) @ LUMA
        rows, columns = view.rows[5:7], view.columns[5:7]
        pictures.append(grey[rows[0] : rows[1], columns[0] : columns[1]].astype(np.int64))
    return pictures


@pytest.mark.parametrize("size", SIZES)
def test_all_kinds_of_bricks_differ_in_greyscale(size: tuple[int, int]) -> None:
    pictures = brick_pictures(*size)
    for index, one in enumerate(pictures):
        for other in pictures[index + 1 :]:
            # The bodies of the colours are 20 apart, and 0.82 times that at their feet.
            assert np.abs(one - other).max() >= 16


def test_the_brick_colours_are_steps_of_one_ladder_of_brightness() -> None:
    colours = PALETTE[BRICK + 1 : BRICK + 1 + COLOURS]
    assert np.diff(np.sort(colours @ LUMA)).min() >= 20


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("round_number", [1, 9, 17, 2000])
def test_silver_shows_its_damage_and_gold_has_none(
    size: tuple[int, int], round_number: int
) -> None:
    batch = new_game()
    world = batch.worlds[0]
    world.round_number = round_number
    batch.worlds["kind"] = SILVER
    needed = min(2 + (round_number - 1) // 8, UNBREAKABLE - 1)
    looks = []
    for hits in range(needed, 0, -1):
        world.brick_hits[:] = hits
        looks.append(hashlib.sha256(picture(batch, *size)).hexdigest())
    assert looks[0] not in looks[1:]
    # Damage is shown in three steps, each of which is seen once there are so many hits.
    assert len(set(looks[1:])) == min(needed - 1, 3)
    batch.worlds["kind"] = GOLD
    world.brick_hits[:] = UNBREAKABLE
    assert hashlib.sha256(picture(batch, *size)).hexdigest() not in looks


@pytest.mark.parametrize(
    ("name", "value"), [("score", 1234567), ("round_number", 42), ("lives", 2)]
)
def test_the_score_line_shows_numbers_above_the_field_only(name: str, value: int) -> None:
    batch = new_game()
    before = picture(batch)
    batch.worlds[0][name] = value
    rows = np.nonzero(changed(before, picture(batch)))[0]
    assert len(rows) > 0
    assert rows.max() < place(512, 384, 0.0, FIELD_HEIGHT + 0.5)[1]


@pytest.mark.parametrize("lives", range(6))
def test_lives_are_counted_in_small_paddles(lives: int) -> None:
    batch = new_game()
    batch.worlds[0].lives = 0
    none = picture(batch)
    batch.worlds[0].lives = lives
    columns = changed(none, picture(batch)).any(axis=0).astype(int)
    assert (np.diff(columns) == 1).sum() == lives


@pytest.mark.parametrize("score", [10**15, 2**63 - 1])
def test_a_huge_score_stays_off_the_rounds_number(score: int) -> None:
    batch = new_game()
    before = picture(batch)
    batch.worlds[0].score = score
    columns = np.nonzero(changed(before, picture(batch)))[1]
    assert columns.max() < place(512, 384, 4.6, 0.0)[0]


def test_a_wide_paddle_of_the_rules_is_drawn_wide() -> None:
    widths = []
    for factor in (1.0, 1.5):
        batch = new_game(paddle=factor)
        batch.worlds[0].ball_state[0] = ABSENT
        here = picture(batch)
        batch.worlds[0].paddle_x = -9.0
        columns = np.nonzero(changed(here, picture(batch)))[1]
        widths.append(columns.max() + 1 - columns.min())
    assert widths == [64, 96]
