"""What a batch refuses: a step where a reset is needed."""

import numpy as np
from gymnasium.error import ResetNeeded

from ..state import Worlds


def why_refused(worlds: Worlds) -> ResetNeeded:
    """Return the error for a step of worlds of which one was never reset, or is over."""
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
