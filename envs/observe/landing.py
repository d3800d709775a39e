"""What a `vector` observation shows with ``landing=True``: where each ball will come down."""

from typing import Any

from ...physics.kernels import kernel
from ..game.flight import find_landing
from ..rules import FIELD_WIDTH, MAX_BALLS
from ..state import SharedRules, Worlds
from .layout import Part, slices

# So many ticks until a landing are shown as 1, and more, too.
LANDING_TICKS = 600

LANDING_PARTS = (
    Part("landing_x", MAX_BALLS, "x where each ball comes down to the paddle's height"),
    Part("landing_ticks", MAX_BALLS, f"ticks until it is there / {LANDING_TICKS}, at most 1"),
    Part("landing_known", MAX_BALLS, "1 for each ball of which this is known; else both are 0"),
)
_LAYOUT = slices(LANDING_PARTS)
LANDING_LENGTH = _LAYOUT["landing_known"].stop
_X = _LAYOUT["landing_x"].start
_TICKS = _LAYOUT["landing_ticks"].start
_KNOWN = _LAYOUT["landing_known"].start


@kernel
def observe_landings(
    worlds: Worlds, rules: SharedRules, rows: Any, first: int, scratch: Worlds, mask: Any
) -> None:
    """Observe where the balls of the worlds of a mask will land.

    Args:
        rows: float32 [n, k]; first: where in a row the parts begin; scratch: `World` [1], to be
            overwritten; mask: bool [n].
    """
    for index in range(worlds.shape[0]):
        if not mask[index]:
            continue
        row = rows[index]
        for ball in range(MAX_BALLS):
            found, x, ticks = find_landing(worlds[index], rules[0], ball, scratch)
            row[first + _X + ball] = x * (2.0 / FIELD_WIDTH) - 1.0 if found else 0.0
            row[first + _TICKS + ball] = min(1.0, ticks * (1.0 / LANDING_TICKS)) if found else 0.0
            row[first + _KNOWN + ball] = 1.0 if found else 0.0
