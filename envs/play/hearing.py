"""What of a tick can be heard."""

from typing import Any

from ...physics.kernels import kernel
from ..rules import MAX_BALLS, PADDLE_TOP
from ..state import FLYING
from .sound import Tone

# A ball that turns upward so near above the paddle was hit by it: all bricks are higher.
_PADDLE_REACH = PADDLE_TOP + 1.0
# The loudest one first. Each is a bit of what `hear` returns, the first one the lowest.
TONES = (
    *(Tone.LIFE_LOST, Tone.CLEARED, Tone.LIFE_WON, Tone.CAPSULE, Tone.ENEMY, Tone.BRICK),
    *(Tone.PADDLE, Tone.WALL),
)
_LIFE_LOST, _CLEARED, _LIFE_WON, _CAPSULE, _ENEMY, _BRICK, _PADDLE, _WALL = (
    1 << place for place in range(len(TONES))
)


def tones_of(before: Any, after: Any, outcome: Any) -> list[Tone]:
    """Return the tones of a tick, the loudest event first.

    Args:
        before, after: `World` records.
        outcome: the tick's `Outcome`.
    """
    heard = hear(before, after, outcome)
    return [tone for place, tone in enumerate(TONES) if heard >> place & 1]


@kernel
def hear(before: Any, after: Any, outcome: Any) -> int:
    """Return the tones of a tick, see `tones_of`, as bits."""
    heard = _LIFE_LOST if outcome.lives_lost > 0 else 0
    heard |= _CLEARED if outcome.rounds_cleared > 0 else 0
    heard |= _LIFE_WON if outcome.lives_gained > 0 else 0
    heard |= _CAPSULE if outcome.capsules_caught > 0 else 0
    heard |= _ENEMY if outcome.enemies_destroyed > 0 else 0
    heard |= _BRICK if outcome.hits > 0 else 0
    turned = _turns(before, after)
    if turned == _PADDLE or heard == 0:
        heard |= turned
    return heard


@kernel
def _turns(before: Any, after: Any) -> int:
    """Return what a ball that has turned was hit by; 0 if none has."""
    turned = 0
    for ball in range(MAX_BALLS):
        if before.ball_state[ball] != FLYING or after.ball_state[ball] != FLYING:
            continue
        upward = _sign(before.ball_vy[ball]) != _sign(after.ball_vy[ball])
        sideways = _sign(before.ball_vx[ball]) != _sign(after.ball_vx[ball])
        if upward and after.ball_y[ball] < _PADDLE_REACH and after.ball_vy[ball] > 0.0:
            return _PADDLE
        if upward or sideways:
            turned = _WALL
    return turned


@kernel
def _sign(x: float) -> int:
    return int(x > 0.0) - int(x < 0.0)
