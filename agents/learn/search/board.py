"""What the user sees of a search: a line for each trial, and one progress bar."""

import math
import os
from typing import Any

from ...experiment.errors import SettingsError
from ...measure.progress import make_count_bar

_ENDED = ("complete", "pruned")


class Board:
    """Shows the trials of a search, in one process only, so that lines are whole.

    Args:
        ended: trials that have ended before.
        total: trials of the search.
    """

    def __init__(self, ended: int, total: int) -> None:
        self._running: dict[int, float] = {}
        self._best = -math.inf
        self._bar: Any = make_count_bar(total, "trials", ended)

    def progress(self, number: int, part: float, latest: float) -> None:
        """Show that a trial has spent a part of its time."""
        self._running[number] = part
        self._redraw()

    def end(self, number: int, state: str, value: float | None, words: str) -> None:
        """Show how a trial has ended: complete, pruned or fail."""
        self._running.pop(number, None)
        measured = "" if value is None else f"{value:.4f} "
        self._bar.write(f"trial {number}: {state} {measured}{words}")
        if state == "complete" and value is not None:
            self._best = max(self._best, value)
        if state in _ENDED:
            self._bar.update()
        self._redraw()

    def fail(self, message: str) -> None:
        """Raise `SettingsError` with what a trial's process says."""
        raise SettingsError(message)

    def close(self) -> None:
        """End the line of the bar."""
        self._bar.close()

    def _redraw(self) -> None:
        parts = [f"{number}: {part:.0%}" for number, part in sorted(self._running.items())]
        best = [f"best {self._best:.4f}"] if self._best > -math.inf else []
        self._bar.set_postfix_str(", ".join(best + parts), refresh=os.isatty(2))
