"""Learning curves: a file with one JSON line per measurement, which a resumed run continues."""

import json
from pathlib import Path
from typing import Any

from ..experiment.files import write_atomically

STEP = "timesteps"


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
        numbers = {key: float(value) for key, value in key_values.items() if _is_number(value)}
        self._file.write(_line({STEP: int(step), **dict(sorted(numbers.items()))}))
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def read_curve(path: Path) -> list[dict[str, Any]]:
    """Return the lines of a curve's file, without a last one that a kill cut short."""
    rows = []
    for line in path.read_text(encoding="utf-8").splitlines() if path.is_file() else []:
        try:
            rows.append(json.loads(line))
        except json.JSONDecodeError:
            break
    return rows


def _line(row: dict[str, Any]) -> str:
    return json.dumps(row) + "\n"


def _is_number(value: Any) -> bool:
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return True
