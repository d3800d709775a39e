"""Text over a picture."""

import numpy as np
from arkanoid.envs.draw.overlay import draw_overlay


def test_text_is_drawn_over_a_dimmed_band_or_over_the_picture_itself() -> None:
    grey = np.full((256, 192, 3), 100, np.uint8)
    plain, with_band = grey.copy(), grey.copy()
    draw_overlay(plain, "", ())
    assert (plain == grey).all()
    draw_overlay(plain, "Hello", ("WORLD",), band=False)
    draw_overlay(with_band, "Hello", ("WORLD",))
    changed = np.nonzero((plain != grey).any(axis=2))
    assert 0 < len(changed[0]) < 0.1 * 256 * 192
    # It is centred.
    assert abs(changed[1].min() - (191 - changed[1].max())) <= 3
    rows = np.flatnonzero((with_band != grey).any(axis=(1, 2)))
    assert (np.diff(rows) == 1).all()
    assert rows.min() < changed[0].min() <= changed[0].max() < rows.max()
    assert (with_band[rows, 0] == 25).all()


def test_long_lines_stay_within_the_picture() -> None:
    for text in ("W" * 90, "W" * 300):
        picture = np.zeros((256, 192, 3), np.uint8)
        draw_overlay(picture, text, (text,))
        columns = np.flatnonzero(picture.any(axis=(0, 2)))
        assert columns.min() > 0
        assert columns.max() < 191
