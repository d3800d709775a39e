"""What a snapshot may hold: all that no step or edit leaves is refused before a kernel sees it."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ...tolerances import FARTHEST
from ..editing.edits import LAST_HANDLE
from ..lookup.tree import NO_ONE
from ..state.records import (
    END,
    GROUND_GONE,
    INDEX_MASK,
    OFF,
    OLD,
    ON,
    UNPLANNED,
    UNUSED,
)
from .setup import have_bounds

_MANY = 1 << 60  # of what is counted


def corrupt(part: str) -> ValueError:
    """Return the error that says which part is corrupt."""
    return ValueError(f"the snapshot is corrupt: no world can have such {part}")


def is_near(values: npt.NDArray[Any]) -> Any:
    """Return which numbers are finite, and such that the engine may take their squares."""
    return np.abs(values) <= FARTHEST


def _demand(part: str, *conditions: Any) -> None:
    """Raise a ValueError unless all conditions hold, each a bool or an array of them."""
    if not all(np.all(condition) for condition in conditions):
        raise corrupt(part)


def check_clocks(clocks: npt.NDArray[Any]) -> None:
    """Raise a ValueError unless clocks are sums of two numbers, and their counts are possible."""
    _demand(
        "a clock",
        np.isfinite(clocks["time"]) & (clocks["time"] + clocks["time_low"] == clocks["time"]),
        (clocks["capped"] >= 0) & (clocks["capped"] < _MANY),
        clocks["planned"] == UNPLANNED,
        (clocks["fresh"] >= OLD) & (clocks["fresh"] <= GROUND_GONE),
    )


def check_motions(kept: npt.NDArray[Any], clock: Any) -> None:
    """Raise a ValueError unless motions are not too large, and began before now."""
    for part in ("shown", "shown_after_step", "motions"):
        _demand("motions", *(is_near(kept[part][name]) for name in ("x", "y", "vx", "vy")))
    courses = kept["motions"]
    _demand("speeds", (courses["speed"] >= 0.0) & np.isfinite(courses["speed"]))
    at, low, now, now_low = courses["at"], courses["at_low"], clock["time"], clock["time_low"]
    _demand(
        "courses",
        (at < now) | ((at == now) & (low <= now_low)),
        at + low == at,
        (courses["fresh"] == 0) | (courses["fresh"] == 1),
    )


def check_pairs(
    pairs: npt.NDArray[np.int64], traits: npt.NDArray[Any], entries: npt.NDArray[Any]
) -> None:
    """Raise a ValueError unless bodies are inside sensors, in order, and each once."""
    part = "bodies inside sensors"
    sensor, body, moved = pairs.T
    for index in (sensor, body):
        _demand(part, index >= 0, index < len(traits))
        _demand(part, entries["state"][index] == ON)
    ordered = (np.diff(body) > 0) | ((np.diff(body) == 0) & (np.diff(sensor) > 0))
    is_sensor = traits["sensor"] >= 0
    _demand(part, ordered, is_sensor[sensor], ~is_sensor[body], (moved == 0) | (moved == 1))


def check_ends(ends: npt.NDArray[Any]) -> None:
    """Raise a ValueError unless these are ends."""
    numbers = (ends["time"], ends["normal"], ends["point"], ends["impulse"])
    _demand("events", ends["kind"] == END, *(np.isfinite(part) for part in numbers))
    _demand("events", ends["a"] >= 0, ends["b"] >= 0)


def check_bodies(
    head: Any,
    traits: npt.NDArray[Any],
    entries: npt.NDArray[Any],
    overrides: npt.NDArray[Any],
    shapes: npt.NDArray[Any],
) -> None:
    """Raise a ValueError unless a world can have these bodies and handles."""
    part, state = "bodies", entries["state"]
    _demand(part, (state == UNUSED) | (state == ON) | (state == OFF))
    _demand(part, traits["collider"] >= 0, traits["collider"] < len(shapes))
    _demand(part, traits["boundless"] == ~have_bounds(shapes)[traits["collider"]])
    numbers = (traits["home_x"], traits["home_y"], entries["vx"], entries["vy"])
    _demand(part, *(is_near(values) for values in numbers))
    restitution, mass = traits["restitution"], entries["mass"]
    _demand(part, np.isfinite(restitution), restitution >= 0.0, mass > 0.0)
    with np.errstate(over="ignore"):
        _demand(part, traits["inverse_mass"] == 1.0 / mass, np.isfinite(traits["inverse_mass"]))
    is_sensor = traits["sensor"] == 0
    _demand(part, is_sensor | (traits["sensor"] == NO_ONE))
    flags = (head["sensors"], head["inelastic"], head["continuous"])
    _demand(part, *(flag in (0, 1) for flag in flags))
    is_inelastic = (restitution == 0.0) & (state != UNUSED)
    _demand(part, head["sensors"] or not (is_sensor & (state != UNUSED)).any())
    _demand(part, head["inelastic"] or not is_inelastic.any())
    _check_slots(int(head["movers"]), traits, entries)
    _check_handles(int(head["free"]), entries)
    _check_overrides(head, overrides, entries)


def _check_slots(movers: int, traits: npt.NDArray[Any], entries: npt.NDArray[Any]) -> None:
    """Raise a ValueError unless those that move, and no others, have one slot each."""
    has_slot = traits["slot"] != NO_ONE
    is_on, is_moved = entries["state"] == ON, traits["inverse_mass"] > 0.0
    flies = (entries["vx"] != 0.0) | (entries["vy"] != 0.0)
    slots = np.sort(traits["slot"][has_slot])
    _demand("slots", is_on | ~has_slot, has_slot | ~(is_on & is_moved))
    _demand("slots", has_slot | ~(is_on & flies), len(slots) == movers)
    _demand("slots", slots == np.arange(len(slots)))


def _check_handles(free: int, entries: npt.NDArray[Any]) -> None:
    """Raise a ValueError unless handles fit their indices, and all unused ones are in one list."""
    handles, state, following = entries["handle"], entries["state"], entries["next_free"]
    _demand("handles", handles >= 0, (handles & INDEX_MASK) == np.arange(len(handles)))
    waiting = set(np.flatnonzero((state == UNUSED) & (handles < LAST_HANDLE)).tolist())
    retired = set(np.flatnonzero((state == UNUSED) & (handles >= LAST_HANDLE)).tolist())
    while free != NO_ONE:
        if free not in waiting and free not in retired:
            raise corrupt("handles")
        waiting.discard(free)
        retired.discard(free)
        free = int(following[free])
    _demand("handles", not waiting)


def _check_overrides(head: Any, overrides: npt.NDArray[Any], entries: npt.NDArray[Any]) -> None:
    """Raise a ValueError unless pairs of living bodies, each once, have a restitution."""
    part, restitution = "restitutions of pairs", overrides["restitution"]
    one, other = overrides["a"], overrides["b"]
    for handles in (one, other):
        index = handles & INDEX_MASK
        _demand(part, handles >= 0, index < len(entries))
        _demand(part, entries["handle"][index] == handles, entries["state"][index] != UNUSED)
    ordered = (np.diff(one) > 0) | ((np.diff(one) == 0) & (np.diff(other) > 0))
    _demand(part, one < other, ordered, np.isfinite(restitution), restitution >= 0.0)
    _demand(part, head["inelastic"] or not (restitution == 0.0).any())
