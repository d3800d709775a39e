"""The score line above the field."""

import numpy as np
import pytest
from arkanoid.envs.rules import (
    CATCH,
    ENLARGE,
    FIELD_HEIGHT,
    LASER,
)
from helpers.pictures import changed, empty_game, new_game, picture, to_pixels


@pytest.mark.parametrize("power", [CATCH, ENLARGE, LASER])
def test_the_score_line_shows_the_power(power: int) -> None:
    batch = empty_game()
    without = picture(batch)
    batch.worlds[0].power = power
    rows, columns = np.nonzero(changed(without, picture(batch)))
    assert rows.max() < to_pixels(512, 384, 0.0, FIELD_HEIGHT + 0.5)[1]
    assert columns.min() > to_pixels(512, 384, 9.9, 0.0)[0]


@pytest.mark.parametrize(
    ("name", "value"), [("score", 1234567), ("round_number", 42), ("lives", 2)]
)
def test_the_score_line_shows_numbers_above_the_field(name: str, value: int) -> None:
    batch = new_game()
    before = picture(batch)
    batch.worlds[0][name] = value
    rows = np.nonzero(changed(before, picture(batch)))[0]
    assert len(rows) > 0
    assert rows.max() < to_pixels(512, 384, 0.0, FIELD_HEIGHT + 0.5)[1]


@pytest.mark.parametrize("lives", range(6))
def test_each_life_is_a_small_paddle(lives: int) -> None:
    batch = new_game()
    batch.worlds[0].lives = 0
    none = picture(batch)
    batch.worlds[0].lives = lives
    columns = changed(none, picture(batch)).any(axis=0).astype(int)
    assert (np.diff(columns) == 1).sum() == lives


@pytest.mark.parametrize("score", [10**15, 2**63 - 1])
def test_a_huge_score_does_not_touch_the_rounds_number(score: int) -> None:
    batch = new_game()
    before = picture(batch)
    batch.worlds[0].score = score
    columns = np.nonzero(changed(before, picture(batch)))[1]
    assert columns.max() < to_pixels(512, 384, 4.6, 0.0)[0]
