"""What the JSON of a replay must hold: files may come from anyone."""

from collections.abc import Callable
from typing import Any

from ..levels.generator import MAX_SEED
from ..levels.starts import MAX_ROUND
from ..ranges import OUTCOME_RANGES, WORLD_RANGES
from ..state import REPEATED_SEED

Check = Callable[[Any], bool]
# A check, or a table with exactly these keys.
Form = Check | dict[str, "Form"]

_FURTHEST = 1e300  # of a sum of rewards


def check_header(head: Any) -> None:
    """Raise a ValueError unless each value of a replay's JSON has its type and range.

    How values go together is checked elsewhere, and so are the version and the game's keywords.
    """
    _check(head, _HEADER, "")


def _check(value: Any, form: Form, path: str) -> None:
    if isinstance(form, dict):
        if type(value) is not dict or value.keys() != form.keys():
            raise ValueError(f"the replay is corrupt: {path or 'it'} has not its keys")
        for key, inner in form.items():
            _check(value[key], inner, f"{path}.{key}" if path else key)
    elif not form(value):
        raise ValueError(f"the replay is corrupt: {path} can't be {value!r:.60}")


# Types are compared exactly: Python takes True for 1, and 1.0 == 1.


def _is_text(value: Any) -> bool:
    return type(value) is str


def _is_flag(value: Any) -> bool:
    return type(value) is bool


def _is_number(low: float, high: float) -> Check:
    return lambda value: type(value) in (int, float) and low <= value <= high  # not NaN


def _is_integer(low: float, high: float) -> Check:
    return lambda value: type(value) is int and low <= value <= high


def _is_list(item: Check) -> Check:
    return lambda value: type(value) is list and all(map(item, value))


def _is_pair(item: Check) -> Check:
    return lambda value: type(value) is list and len(value) == 2 and all(map(item, value))


def _is_difficulty(value: Any) -> bool:
    """Tell whether a value is a difficulty, or -1: as configured."""
    return type(value) in (int, float) and (0.0 <= value <= 1.0 or value == -1.0)


def _is_palette(value: Any) -> bool:
    """Tell whether a value holds pairs of numbers, or is None; not whether they are commands."""
    return value is None or _is_list(_is_pair(lambda number: type(number) in (int, float)))(value)


def _is_anything(value: Any) -> bool:
    return True


_HEADER: Form = {
    "version": _is_text,
    "rules": _is_anything,
    "config": _is_anything,
    "levels": {
        "names": _is_list(_is_text),
        "bricks": _is_list(_is_text),
        "boss": _is_list(_is_flag),
        "seeds": _is_pair(_is_integer(0, MAX_SEED + 1)),
        "endless": _is_flag,
        "first_difficulty": _is_number(0.0, 1.0),
    },
    "start": {
        "random": _is_integer(*WORLD_RANGES["random"]),
        "fields": {
            "start": _is_integer(0, REPEATED_SEED),
            "start_round": _is_integer(1, MAX_ROUND),
            "start_seed": _is_integer(0, MAX_SEED),
            "start_difficulty": _is_difficulty,
            "start_boss": _is_integer(0, 1),
        },
        "layout": _is_text,
    },
    "result": {
        "decisions": _is_integer(0, 1 << 62),
        "reward": _is_number(-_FURTHEST, _FURTHEST),
        "score": _is_integer(*OUTCOME_RANGES["score"]),
        "lives": _is_integer(*OUTCOME_RANGES["lives"]),
        "round": _is_integer(*OUTCOME_RANGES["round_number"]),
        "terminated": _is_flag,
        "truncation": _is_integer(*OUTCOME_RANGES["truncation"]),
    },
    "checksums": _is_list(_is_integer(0, (1 << 32) - 1)),
    "palette": _is_palette,
}
