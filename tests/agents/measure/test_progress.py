"""The progress bars, in terminals of any width."""

import re
from typing import Any

import pytest
from arkanoid.agents.measure.progress import make_bar, make_count_bar

BARS = {
    "decisions": lambda: make_bar(4_000_000, 1_000_000),
    "games": lambda: make_count_bar(400, "games", 123),
}
WHOLE = r" \d+%\|[^|]+\| [\d.M]+/[\d.M]+"


def shown(bar: Any, columns: int | None) -> str:
    """Return a bar as a terminal of so many columns shows it."""
    bar.set_postfix_str("games: landing-follower", refresh=False)
    facts = {**bar.format_dict, "ncols": columns, "elapsed": 3723.0}
    bar.close()
    return str(bar.format_meter(**facts))


@pytest.mark.parametrize("kind", BARS)
@pytest.mark.parametrize("columns", [30, 40, 60, 80, 200])
def test_a_bar_fits_the_terminal_and_loses_no_letters(kind: str, columns: int) -> None:
    """At 40 columns its end was cut, in the middle of a number."""
    text = shown(BARS[kind](), columns)
    assert len(text) <= columns
    begin = re.match(WHOLE, text)
    assert begin, text
    # What follows are whole parts of what a file gets, which has no width.
    rest = shown(BARS[kind](), None)
    end = text[begin.end() :]
    assert re.fullmatch(r"( games)?(, [^,]+)*", end), text
    if columns == 200:
        assert end.endswith("games: landing-follower")
    assert end in rest
