"""What the notes of a run, ``run.json``, may hold: files may come from anyone."""

from collections.abc import Callable, Mapping
from typing import Any

from .files import shown

# Beyond any number of decisions, and still within what arrays and floats hold.
_MOST = 2**62
_LONGEST = 1000  # letters


def known_notes(notes: Any) -> dict[str, Any]:
    """Return what is known of notes; what else they hold is left out.

    Raises ValueError if something has not its type and range.
    """
    known = _known(notes, _NOTES)
    if "sessions" in known:
        known["sessions"] = [_known(session, _SESSION) for session in known["sessions"]]
        if not all(session.keys() == _SESSION.keys() for session in known["sessions"]):
            raise ValueError("a session lacks a part")
    return known


# Types are compared exactly: Python takes `true` for an integer.


def _is_text(value: Any) -> bool:
    return type(value) is str and len(value) <= _LONGEST


def _is_count(value: Any) -> bool:
    return type(value) is int and 0 <= value <= _MOST


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and -_MOST <= value <= _MOST  # not NaN


def _is_optional_text(value: Any) -> bool:
    return value is None or _is_text(value)


def _is_fact(value: Any) -> bool:
    return value is None or type(value) is bool or _is_text(value) or _is_number(value)


def _is_list(value: Any) -> bool:
    return type(value) is list


def _are_texts(value: Any) -> bool:
    return type(value) is list and all(map(_is_text, value))


def _are_facts(value: Any) -> bool:
    """Tell whether a value is a table of facts, or None where there are none."""
    if value is None:
        return True
    return type(value) is dict and all(map(_is_text, value)) and all(map(_is_fact, value.values()))


def _is_lineage(value: Any) -> bool:
    """Tell whether a value says what a run began with, as `lineage` describes it."""
    if value is None:
        return True
    if not _are_facts(value):
        return False
    texts, count = ("kind", "name", "weights"), value.get("decisions")
    return all(_is_text(value.get(name)) for name in texts) and _is_count(count)


# What is read, and whether a value can be that. A clock that was set back makes seconds negative.
_NOTES: dict[str, Callable[[Any], bool]] = {
    "outcome": _is_optional_text,
    "weights": _is_optional_text,
    "seed": _is_count,
    "timesteps": _is_count,
    "sessions": _is_list,
    "warnings": _are_texts,
    "versions": _are_facts,
    "git": _are_facts,
    "hardware": _are_facts,
    "lineage": _is_lineage,
    "trackers": _are_facts,
}
_SESSION: dict[str, Callable[[Any], bool]] = {
    "started": _is_text,
    "seconds": _is_number,
    "from": _is_count,
    "to": _is_count,
}


def _known(table: Any, allowed: Mapping[str, Callable[[Any], bool]]) -> dict[str, Any]:
    """Return the known values of a table; raise ValueError if one cannot be what its key says."""
    if type(table) is not dict:
        raise ValueError("not a table")
    for key, fits in allowed.items():
        if key in table and not fits(table[key]):
            raise ValueError(f"{key!r} is {shown(table[key])}")
    return {key: value for key, value in table.items() if key in allowed}
