"""Text over a picture of the game: titles and short messages to the player."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .font import GLYPHS, draw_text, encode, text_step
from .palette import PALETTE, VALUE, WALL_LIT
from .view import FULL_HEIGHT, FULL_WIDTH

# Heights in brick widths.
MIDDLE = 11.7  # of the text, from the picture's upper edge: between most bricks and the paddle
TITLE_HEIGHT = 0.72
TEXT_HEIGHT = 0.3
LINE_SPACE = 0.22  # between lines
BAND_SPACE = 0.35  # between the text and the edges of the dark band
WIDEST = 10.8  # longer lines are drawn smaller
MARGIN = 0.3  # right of a line that begins elsewhere than in the middle
DIMMING = 4  # the band's pixels are divided by this


def draw_overlay(
    picture: NDArray[np.uint8], title: str, lines: Sequence[str], band: bool = True
) -> None:
    """Draw a title and lines below it into a picture, centred.

    Args:
        picture: uint8 [height, width, 3].
        title: drawn in large letters, unless it is empty; lines: drawn in small letters. Without
            either, nothing is drawn. Characters that the font lacks become question marks.
        band: whether a band of the picture behind the text is dimmed.
    """
    if not title and not lines:
        return
    scale = min(picture.shape[0] / FULL_HEIGHT, picture.shape[1] / FULL_WIDTH)
    texts = [(title, TITLE_HEIGHT, VALUE)] if title else []
    texts += [(line, TEXT_HEIGHT, WALL_LIT) for line in lines]
    needed = sum(height + LINE_SPACE for _, height, _ in texts) - LINE_SPACE
    top = MIDDLE - needed / 2
    if band:
        upper, lower = (top - BAND_SPACE) * scale, (top + needed + BAND_SPACE) * scale
        picture[max(0, round(upper)) : round(lower)] //= DIMMING
    for text, height, colour in texts:
        write_line(picture, text, top, height, colour)
        top += height + LINE_SPACE


def write_line(
    picture: NDArray[np.uint8],
    text: str,
    top: float,
    height: float,
    colour: int,
    left: float | None = None,
) -> None:
    """Draw a line of text; one that is too long for the picture is drawn smaller.

    Args:
        picture: uint8 [height, width, 3].
        text: characters that the font lacks become question marks.
        top, height: of its letters, in brick widths, from the picture's upper edge.
        colour: a row of the palette.
        left: where it begins, in brick widths from the left edge; None: it is centred.
    """
    scale = min(picture.shape[0] / FULL_HEIGHT, picture.shape[1] / FULL_WIDTH)
    codes = encode("".join(letter if letter in GLYPHS else "?" for letter in text.upper()))
    room = WIDEST if left is None else FULL_WIDTH - MARGIN - left
    height = min(height, room / max(1.0, len(codes) * text_step(1.0)))
    if left is None:
        begin = picture.shape[1] / 2 - len(codes) * text_step(height) * scale / 2
    else:
        begin = left * scale
    draw_text(picture, codes, begin, top * scale, height * scale, PALETTE[colour])
