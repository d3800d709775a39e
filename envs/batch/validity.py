"""States that come from outside, checked before a kernel sees them: anyone can write a snapshot.

The ranges of single fields are in `ranges`; how they depend on each other and on the rules is in
`relations`.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...physics.kernels import inner, kernel
from ...physics.kernels.borrowed import borrowed
from ...physics.kernels.layouts import record_dtype
from ..ranges import OUTCOME_RANGES, WORLD_RANGES, Range
from ..state import Outcome, SharedRules, World, Worlds
from .relations import RELATED, find_fault

# A field of a record, and its range. In 64 bits of a float64 each bound is exact enough: the
# largest ones are powers of two.
_FieldRange = record_dtype(
    [
        ("kind", np.int64),  # index in `_KINDS`
        ("first", np.int64),  # the first of its numbers, in numbers of this kind
        ("count", np.int64),
        ("low", np.float64),
        ("high", np.float64),
    ]
)
_F8, _I8, _U8 = np.dtype(np.float64), np.dtype(np.int64), np.dtype(np.uint64)
_I4, _I2, _I1, _U1 = (np.dtype(kind) for kind in (np.int32, np.int16, np.int8, np.uint8))
_KINDS = (_F8, _I8, _U8, _I4, _I2, _I1, _U1)


def _field_ranges(record: "np.dtype[Any]", ranges: Mapping[str, Range]) -> Any:
    """Return the ranges of a record's fields as `_FieldRange` [fields], in the record's order."""
    table = np.zeros(len(ranges), _FieldRange)
    for place, name in enumerate(record.names or ()):
        field, offset = record.fields[name][:2]  # type: ignore[index]
        # The byte of a bool may be any number.
        base = _U1 if field.base == np.bool_ else field.base
        numbers = offset // base.itemsize, math.prod(field.shape)
        table[place] = (_KINDS.index(base), *numbers, *ranges[name])
    return table


_WORLD_FIELDS = _field_ranges(World, WORLD_RANGES)
_OUTCOME_FIELDS = _field_ranges(Outcome, OUTCOME_RANGES)


def check_worlds(worlds: Worlds, rules: SharedRules, episodic_life: bool) -> None:
    """Raise a ValueError, which names the field, if no play leads to one of these worlds.

    Args:
        worlds: `World` [n], aligned, each of them seeded.
        rules: of the batch that is to play them.
        episodic_life: whether a lost life ends an episode there.
    """
    _check_ranges(worlds, _WORLD_FIELDS, "world")
    fault = find_fault(worlds, rules, episodic_life)
    if fault:
        index, place = divmod(fault, len(RELATED))
        name = RELATED[place]
        raise ValueError(
            f"world {index} can't be: {name} is {worlds[name][index].tolist()}, which does not go "
            "with its other fields and the rules"
        )


def check_outcomes(outcomes: Any) -> None:
    """Raise a ValueError, which names the field, if no decision leads to one of these outcomes.

    Args:
        outcomes: `Outcome` [n], aligned.
    """
    _check_ranges(outcomes, _OUTCOME_FIELDS, "the outcome of world")


def _check_ranges(records: Any, fields: Any, what: str) -> None:
    """Raise a ValueError if a number of records [n] is out of its range, or NaN."""
    fault = find_outside(records.view(np.uint8).reshape(len(records), -1), fields)
    if fault >= 0:
        index, place = divmod(fault, len(fields))
        name, low, high = records.dtype.names[place], fields["low"][place], fields["high"][place]
        raise ValueError(
            f"{what} {index} can't be: {name} is {records[name][index].tolist()}, which is not "
            f"between {low:g} and {high:g}"
        )


@kernel
def find_outside(records: Any, fields: Any) -> int:
    """Return record * fields + field of the first number out of its range; -1 if there is none.

    Args:
        records: uint8 [n, bytes]; fields: `_FieldRange` [fields].
    """
    size = records.shape[1]
    for index in range(records.shape[0]):
        block = records[index]
        for place in range(fields.shape[0]):
            field = fields[place]
            if field.kind == 0:
                legal = _are_within(borrowed(block, 0, size // 8, _F8), field)
            elif field.kind == 1:
                legal = _are_within(borrowed(block, 0, size // 8, _I8), field)
            elif field.kind == 2:
                legal = _are_within(borrowed(block, 0, size // 8, _U8), field)
            elif field.kind == 3:
                legal = _are_within(borrowed(block, 0, size // 4, _I4), field)
            elif field.kind == 4:
                legal = _are_within(borrowed(block, 0, size // 2, _I2), field)
            elif field.kind == 5:
                legal = _are_within(borrowed(block, 0, size, _I1), field)
            else:
                legal = _are_within(borrowed(block, 0, size, _U1), field)
            if not legal:
                return int(index * fields.shape[0] + place)
    return -1


@inner
def _are_within(numbers: Any, field: Any) -> bool:
    """Tell whether the numbers of a field are within its range; NaN is not."""
    for place in range(field.first, field.first + field.count):
        if not field.low <= float(numbers[place]) <= field.high:
            return False
    return True
