"""The named parts of an observation: each part's name, length and meaning are data."""

from collections.abc import Sequence
from typing import NamedTuple


class Part(NamedTuple):
    """A part of an observation.

    Attributes:
        name: the key of its slice in `layout`.
        length: how many numbers, or planes, it has.
        meaning: what they mean, for the documentation.
    """

    name: str
    length: int
    meaning: str


def slices(parts: Sequence[Part], start: int = 0) -> dict[str, slice]:
    """Return the slices of parts on an observation's first axis, one after the other."""
    layout = {}
    for part in parts:
        layout[part.name] = slice(start, start + part.length)
        start += part.length
    return layout
