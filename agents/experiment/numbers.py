"""Numbers as people type them."""

import math
import re

# `1e6` is a floating-point number to TOML and Python; here it is a million.
_WHOLE = re.compile(r"[+-]?\d+(?:_\d+)*(?:[eE]\+?\d+)?")
_MOST_DIGITS = 400


def parse_whole(text: str) -> int | None:
    """Return the integer in a text like ``1000``, ``1_000`` or ``1e3``; None if there is none."""
    if len(text) > _MOST_DIGITS or not _WHOLE.fullmatch(text):
        return None
    digits, _, exponent = text.lower().partition("e")
    power = int(exponent or 0)
    return None if power > _MOST_DIGITS else int(digits) * 10**power


def as_whole(value: object) -> object:
    """Return a float without a fraction as an integer, and anything else as it is."""
    if type(value) is float and math.isfinite(value) and value.is_integer():
        return int(value)
    return value
