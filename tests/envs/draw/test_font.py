"""The font: glyphs differ from each other and stay in their boxes."""

import itertools

import numpy as np
import pytest
from arkanoid.envs.draw.font import (
    GLYPHS,
    count_digits,
    draw_glyph,
    draw_number,
    draw_text,
    encode,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

WHITE = np.full(1, 255.0)
# The first example may compile kernels.
PROPERTY = settings(deadline=None, max_examples=50)


def picture(character: str, height: float) -> NDArray[np.int64]:
    image = np.zeros((40, 40, 1), np.uint8)
    draw_glyph(image, ord(character), 4.0, 4.0, height, WHITE)
    return image[:, :, 0].astype(np.int64)


@pytest.mark.parametrize("height", [7.0, 12.0, 30.0])
def test_no_two_glyphs_look_alike(height: float) -> None:
    """Even at the smallest size of a number; O, which looks like 0, excepted."""
    pictures = {character: picture(character, height) for character in GLYPHS if character != "O"}
    for one, other in itertools.combinations(pictures, 2):
        assert np.abs(pictures[one] - pictures[other]).max() > 100, (one, other)


@pytest.mark.parametrize("character", GLYPHS)
@PROPERTY
@given(height=st.floats(1.0, 30.0))
def test_a_glyphs_ink_lies_in_its_box(character: str, height: float) -> None:
    """Apart from a pixel of smoothing."""
    rows, columns = np.nonzero(picture(character, height))
    if len(rows):
        assert rows.min() >= 3
        assert rows.max() <= 4 + height + 1
        assert columns.min() >= 3
        assert columns.max() <= 4 + height * 4.95 / 6.95 + 1


@PROPERTY
@given(value=st.integers(0, 10**18), height=st.floats(4.0, 20.0))
def test_a_number_is_drawn_as_its_text(value: int, height: float) -> None:
    number, text = np.zeros((2, 24, 300, 3), np.uint8)
    draw_number(number, value, 1.5, 2.0, height, np.full(3, 200.0))
    draw_text(text, encode(str(value)), 1.5, 2.0, height, np.full(3, 200.0))
    np.testing.assert_array_equal(number, text)
    assert count_digits(value) == len(str(value))


def test_the_glyphs_of_a_text_stand_apart() -> None:
    image = np.zeros((34, 200, 1), np.uint8)
    draw_text(image, encode("HHHH"), 0.0, 2.0, 27.8, WHITE)
    inked = image[:, :, 0].any(axis=0).astype(int)
    assert (np.diff(inked) == -1).sum() == 4


def test_small_letters_are_capitals_and_unknown_characters_are_refused() -> None:
    np.testing.assert_array_equal(encode("Round 1"), [ord(c) for c in "ROUND 1"])
    with pytest.raises(ValueError, match="no 'É' \\(of 'né'\\)"):
        encode("né")
