"""Progress bars that fit any terminal."""

import os
from typing import Any

from tqdm import tqdm  # type: ignore[import-untyped]
from tqdm.utils import disp_len  # type: ignore[import-untyped]

# Where the terminal is too narrow, what stands last is left out first.
_FORM = ("{percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}", ", {remaining} left", ", {rate_fmt}")
# Of games nobody knows when the last one ends.
_COUNT_FORM = ("{percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}", " UNIT", ", {elapsed}")
_POSTFIX = "{postfix}"
_LEAST = 4  # letters of the bar itself


def make_bar(total: int, done: int = 0) -> Any:
    """Return a bar of decisions, on standard error."""
    return _bar(initial=done, total=total, unit="", unit_scale=True, bar_format=_joined(_FORM))


def make_count_bar(total: int, unit: str, done: int = 0) -> Any:
    """Return a bar of things that are counted one by one, on standard error."""
    form = _joined(_COUNT_FORM).replace("UNIT", unit)
    return _bar(initial=done, total=total, bar_format=form)


class GamesBar:
    """A bar of games that are played; use it in a ``with`` statement.

    Args:
        total: how many will be played.
        unit: what they are, if not games.
    """

    def __init__(self, total: int, unit: str = "games") -> None:
        self._bar: Any = make_count_bar(total, unit)

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


class _Bar(tqdm):  # type: ignore[misc]
    """tqdm's bar; its form has parts, one a line, of which it shows as many as fit."""

    @staticmethod
    def format_meter(  # pyright: ignore[reportIncompatibleMethodOverride]
        n: float,
        total: float,
        elapsed: float,
        ncols: int | None = None,
        bar_format: str = "",
        **others: Any,
    ) -> str:
        """Return the bar as a text of at most ``ncols`` letters."""
        parts = bar_format.splitlines()

        def shown(form: str) -> str:
            meter = tqdm.format_meter
            return str(meter(n, total, elapsed, ncols=ncols, bar_format=form, **others))

        while len(parts) > 1 and ncols is not None:
            if disp_len(shown("".join(parts).replace("{bar}", ""))) + _LEAST <= ncols:
                break
            parts.pop()
        return shown("".join(parts))


def _joined(parts: tuple[str, ...]) -> str:
    return "\n".join([*parts, _POSTFIX])


def _bar(**arguments: Any) -> Any:
    # A terminal redraws the bar; a file gets few lines. With `miniters` the clock goes on, too.
    interval = 0.2 if os.isatty(2) else 10.0
    return _Bar(mininterval=interval, miniters=0, dynamic_ncols=True, **arguments)
