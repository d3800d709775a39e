"""What of a tick can be heard."""

from typing import Any

import numpy as np

from ..rules import PADDLE_TOP
from ..state import FLYING
from .sound import Tone

# A ball that turns upward so near above the paddle was hit by it: all bricks are higher.
PADDLE_REACH = PADDLE_TOP + 1.0
COUNTED = {
    "lives_lost": Tone.LIFE_LOST,
    "rounds_cleared": Tone.CLEARED,
    "lives_gained": Tone.LIFE_WON,
    "capsules_caught": Tone.CAPSULE,
    "enemies_destroyed": Tone.ENEMY,
    "hits": Tone.BRICK,
}


def tones_of(before: Any, after: Any, outcome: Any) -> list[Tone]:
    """Return the tones of a tick, the loudest event first.

    Args:
        before, after: `World` records.
        outcome: the tick's `Outcome`.
    """
    tones = [tone for field, tone in COUNTED.items() if outcome[field] > 0]
    flying = (before["ball_state"] == FLYING) & (after["ball_state"] == FLYING)
    turned_x = np.sign(before["ball_vx"]) != np.sign(after["ball_vx"])
    turned_y = np.sign(before["ball_vy"]) != np.sign(after["ball_vy"])
    low = (after["ball_y"] < PADDLE_REACH) & (after["ball_vy"] > 0.0)
    if (flying & turned_y & low).any():
        tones.append(Tone.PADDLE)
    elif not tones and (flying & (turned_x | turned_y)).any():
        tones.append(Tone.WALL)
    return tones
