"""Why a batch refuses to play on."""

import numpy as np
from gymnasium.error import ResetNeeded

from ..state import Worlds


def why_refused(worlds: Worlds, busy: bool) -> Exception:
    """Return the error for a call that a batch refuses.

    Args:
        worlds: the states; one of them was never reset or is over, if no thread is busy.
        busy: whether a thread is changing them.
    """
    if busy:
        return RuntimeError(
            "another thread is stepping this environment: it belongs to one thread at a time"
        )
    never = np.flatnonzero(worlds["round_number"] == 0)[:8].tolist()
    if len(worlds) == 1:
        if never:
            return ResetNeeded("call reset() before the first step()")
        return ResetNeeded("the episode is over: call reset() before the next step()")
    if never:
        return ResetNeeded(f"call reset() before the first step(): worlds {never} had none")
    over = np.flatnonzero(worlds["done"])[:8].tolist()
    return ResetNeeded(
        f"the episodes of worlds {over} are over: before the next step() call "
        "reset(options={'reset_mask': ...}), or use another autoreset_mode"
    )
