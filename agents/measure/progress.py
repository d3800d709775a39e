"""Progress bars that fit a terminal of 80 columns."""

import os
from typing import Any

from tqdm import tqdm  # type: ignore[import-untyped]

_FORM = "{percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}, {remaining} left, {rate_fmt}{postfix}"
# Of games nobody knows when the last one ends.
_COUNT_FORM = "{percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt} UNIT, {elapsed}{postfix}"


def make_bar(total: int, done: int = 0) -> Any:
    """Return a bar of decisions, on standard error."""
    return _bar(initial=done, total=total, unit="", unit_scale=True, bar_format=_FORM)


class GamesBar:
    """A bar of games that are played; use it in a ``with`` statement.

    Args:
        total: how many will be played.
        unit: what they are, if not games.
    """

    def __init__(self, total: int, unit: str = "games") -> None:
        form = _COUNT_FORM.replace("UNIT", unit)
        self._bar: Any = _bar(total=total, bar_format=form)

    def __enter__(self) -> "GamesBar":
        return self

    def __exit__(self, *error: object) -> None:
        self._bar.close()

    def name(self, what: str) -> None:
        """Show who plays."""
        self._bar.set_postfix_str(what)

    def ended(self, games: int) -> None:
        """Count games that have ended, maybe none: the clock goes on."""
        self._bar.update(games)


def _bar(**arguments: Any) -> Any:
    # A terminal redraws the bar; a file gets few lines. With `miniters` the clock goes on, too.
    interval = 0.2 if os.isatty(2) else 10.0
    return tqdm(mininterval=interval, miniters=0, dynamic_ncols=True, **arguments)
