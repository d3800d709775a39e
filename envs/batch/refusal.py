"""What a batch refuses: a step where a reset is needed, and a second thread."""

from threading import get_ident

import numpy as np
from gymnasium.error import ResetNeeded

from ..state import Worlds


class OneThread:
    """A context that only one thread at a time can be in.

    Attributes:
        owner: the thread that is in it, or 0. A thread that Ctrl-C kept from leaving may enter
            again.
    """

    def __init__(self) -> None:
        self.owner = 0

    def __enter__(self) -> None:
        self.enter()

    def __exit__(self, *_: object) -> None:
        self.owner = 0

    def enter(self) -> None:
        """Note that this thread is in it; raise a RuntimeError if another one is."""
        thread = get_ident()
        if self.owner not in (0, thread):
            raise RuntimeError(
                "another thread is using this environment: it belongs to one thread at a time"
            )
        self.owner = thread


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
