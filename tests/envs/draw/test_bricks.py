"""Bricks in a picture: each fills its cell, and each kind is told from the others."""

import hashlib
import itertools

import numpy as np
import pytest
from arkanoid.envs.draw.palette import BRICK_BODY, CAPSULE_BODY, LUMA, PALETTE
from arkanoid.envs.draw.view import make_view
from arkanoid.envs.rules import (
    BRICK_HEIGHT,
    BRICK_WIDTH,
    CAPSULES,
    COLOURS,
    COLUMNS,
    GOLD,
    LATTICE_TOP,
    ROWS,
    SILVER,
    UNBREAKABLE,
)
from helpers.pictures import (
    PROPERTY,
    SIZES,
    changed,
    new_game,
    picture,
    to_pixels,
)
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray


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
    left, top = to_pixels(*size, column * BRICK_WIDTH, LATTICE_TOP - row * BRICK_HEIGHT)
    scale = make_view(*size)[0].scale
    # Cells begin at whole pixels, at most half a pixel from the exact place.
    assert columns.min() >= left - 0.5
    assert columns.max() + 1 <= left + BRICK_WIDTH * scale + 0.5
    assert rows.min() >= top - 0.5
    assert rows.max() + 1 <= top + BRICK_HEIGHT * scale + 0.5
    # The whole brick is gone; only the mortar around it was empty before.
    assert len(rows) >= 0.8 * BRICK_WIDTH * BRICK_HEIGHT * scale**2 - 2 * (scale + 1)


def brick_pictures(height: int, width: int) -> list[NDArray[np.int64]]:
    """The grey pixels of one cell with a brick of each kind."""
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
def test_all_kinds_of_bricks_differ_in_grey(size: tuple[int, int]) -> None:
    pictures = brick_pictures(*size)
    for index, one in enumerate(pictures):
        for other in pictures[index + 1 :]:
            # The colours differ by 20 in brightness, and by 0.82 times that at the lower edge.
            assert np.abs(one - other).max() >= 16


def test_kinds_of_bricks_differ_in_small_grey_pictures() -> None:
    """At 84 x 84, gold, orange and silver looked alike: their means were 3 and 9 of 255 apart."""
    pictures = brick_pictures(84, 84)
    means = np.sort([each.mean() for each in pictures])
    assert np.diff(means).min() >= 10
    metals, orange = pictures[SILVER - 1 :], pictures[1]
    for one, other in itertools.combinations([*metals, orange], 2):
        assert abs(one.mean() - other.mean()) >= 50


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
    # Damage has three steps, all of which are seen if the brick needs enough hits.
    assert len(set(looks[1:])) == min(needed - 1, 3)
    batch.worlds["kind"] = GOLD
    world.brick_hits[:] = UNBREAKABLE
    assert hashlib.sha256(picture(batch, *size)).hexdigest() not in looks


@pytest.mark.parametrize(
    ("first", "count"),
    [(BRICK_BODY, COLOURS), (CAPSULE_BODY, CAPSULES)],
    ids=["bricks", "capsules"],
)
def test_colours_differ_in_brightness(first: int, count: int) -> None:
    colours = PALETTE[first + 1 : first + 1 + count]
    assert np.diff(np.sort(colours @ LUMA)).min() >= 20
