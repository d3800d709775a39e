"""Learning curves: a file with one JSON line per measurement, which a resumed run continues."""

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...envs.atomic import write_atomically
from ...envs.reading import read_limited
from ..experiment.errors import SettingsError
from ..experiment.files import cause

STEP = "timesteps"
# The curves that are drawn: each key, and its heading.
SHOWN = {
    "rollout/ep_rew_mean": "return, training",
    "rollout/ep_hits_mean": "brick hits, training",
    "rollout/ep_rounds_cleared_mean": "rounds cleared, training",
    "validation/cleared": "cleared rate, validation",
    "validation/return": "return, validation",
    "validation/score": "score, validation",
}
# Some five hundred bytes a line, and a line for each rollout.
_LARGEST = 2**28
# Beyond what a network computes in single precision; sums and squares of such numbers are finite.
_FURTHEST = 1e39


class CurveWriter:
    """Writes stable-baselines3's log values as lines; one of its "key-value writers".

    Args:
        path: of the file; lines of steps after ``resumed_at`` are dropped, because the resumed run
            writes them again.
        resumed_at: the step at which a run resumes; 0 begins a new file.
    """

    def __init__(self, path: Path, resumed_at: int = 0) -> None:
        kept = [row for row in read_curve(path) if row[STEP] <= resumed_at] if resumed_at else []
        write_atomically(path, "".join(map(_line, kept)).encode())
        self._file = path.open("a", encoding="utf-8")

    def write(
        self, key_values: dict[str, Any], key_excluded: dict[str, Any], step: int = 0
    ) -> None:
        """Append the numbers among the values, with their step."""
        self._file.write(_line({STEP: int(step), **numbers_of(key_values)}))
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def read_curve(path: Path) -> list[dict[str, Any]]:
    """Return the lines of a curve's file; without a last one that a kill cut short.

    Raises `SettingsError` if the file cannot be read or another line is damaged.
    """
    try:
        content = read_limited(path, _LARGEST) if path.exists() else b""
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read: {cause(error)}") from None
    except ValueError as error:
        raise SettingsError(f"{path}: {error}: not a learning curve") from None
    rows = []
    lines = content.split(b"\n")
    for number, line in enumerate(lines[:-1], 1):
        try:
            rows.append(_row(line))
        except (ValueError, RecursionError):
            # After a power cut the last line can be complete and wrong.
            if number < len(lines) - 1:
                raise SettingsError(
                    f"{path}: line {number} is damaged: remove it to use the other lines"
                ) from None
    return rows


def measured(curve: Sequence[Mapping[str, Any]], key: str) -> NDArray[np.float64]:
    """Return the decisions and the values of all finite measurements, [n, 2]."""
    points = [(row[STEP], row[key]) for row in curve if math.isfinite(row.get(key, math.nan))]
    return np.array(points, np.float64).reshape(-1, 2)


def _row(line: bytes) -> dict[str, Any]:
    """Return a line's numbers; raise ValueError if it has something else."""
    row = json.loads(line)
    if not isinstance(row, dict) or type(row.get(STEP)) is not int or row[STEP] < 0:
        raise ValueError
    if not all(is_number(value) for value in row.values()):
        raise ValueError
    return row


def is_number(value: Any) -> bool:
    """Tell whether a value that was read is a number that a training can have logged.

    It can be infinite or NaN: so a training that diverges says.
    """
    if type(value) is int:
        return -(2**63) <= value < 2**63
    return type(value) is float and (not math.isfinite(value) or abs(value) <= _FURTHEST)


def _line(row: dict[str, Any]) -> str:
    return json.dumps(row) + "\n"


def numbers_of(values: dict[str, Any]) -> dict[str, float]:
    """Return the numbers among logged values, in the order of their names."""
    return {key: float(value) for key, value in sorted(values.items()) if _has_number(value)}


def _has_number(value: Any) -> bool:
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return True
