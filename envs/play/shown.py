"""How environments show themselves in a console and in a notebook."""

from math import ceil, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..config import Config
from ..state import SharedRules, Worlds

_MOST_WORLDS = 16  # in the picture of a vector environment
_SHEET_HEIGHT = 512  # pixels of that picture, at most, without gaps
_GAP = 8  # pixels between two worlds
_FIELDS = (("round", "round_number"), ("score", "score"), ("lives", "lives"))


def differences(config: Config) -> list[str]:
    """Return the keywords that are not as `Config` has them: ``["lives=5"]``."""
    return [
        f"{name}={value!r}"
        for name, value in vars(config).items()
        if value != getattr(type(config), name)
    ]


def progress(worlds: Worlds) -> str:
    """Return how far games are, with the smallest and largest values: ``"round 1 to 2, ..."``."""
    if not _all_reset(worlds):
        return "not reset yet"
    return ", ".join(f"{name} {_span(worlds[field])}" for name, field in _FIELDS)


def pictures_png(worlds: Worlds, rules: SharedRules, size: tuple[int, ...] = ()) -> bytes | None:
    """Return a PNG file with the pictures of games, for a notebook; None before their reset.

    Several games, sixteen at most, stand in rows, the first at the top left.

    Args:
        worlds: `World` records [n].
        rules: `Rules` [1].
        size: of the picture of a game that is alone: its height, or its height and width.
    """
    if not _all_reset(worlds):
        return None
    # Imported on demand: playing without pictures needs none of the drawing kernels.
    from ..draw.picture import draw_world
    from ..draw.png import png_bytes

    # A copy, for a kernel is compiled again for records that are read-only.
    shown = worlds[:_MOST_WORLDS].copy()
    if len(shown) == 1:
        return png_bytes(draw_world(shown, rules, 0, *size))
    columns = ceil(sqrt(len(shown)))
    height = _SHEET_HEIGHT // ceil(len(shown) / columns)
    pictures = [draw_world(shown, rules, index, height) for index in range(len(shown))]
    return png_bytes(_sheet(pictures, columns))


def _all_reset(worlds: Worlds) -> bool:
    return bool((worlds["round_number"] > 0).all())


def _span(values: NDArray[Any]) -> str:
    least, most = int(values.min()), int(values.max())
    return f"{least}" if least == most else f"{least} to {most}"


def _sheet(pictures: list[NDArray[np.uint8]], columns: int) -> NDArray[np.uint8]:
    """Return pictures of one size in rows, with white gaps."""
    height, width, channels = pictures[0].shape
    rows = ceil(len(pictures) / columns)
    down, right = height + _GAP, width + _GAP
    sheet = np.full((rows * down - _GAP, columns * right - _GAP, channels), 255, np.uint8)
    for index, picture in enumerate(pictures):
        top, left = down * (index // columns), right * (index % columns)
        sheet[top : top + height, left : left + width] = picture
    return sheet
