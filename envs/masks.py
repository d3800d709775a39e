"""Which discrete actions do something, for algorithms that mask the others (`MaskablePPO`)."""

import numpy as np
from numpy.typing import NDArray

from .actions import COMMANDS
from .config import Config
from .rules import CATCH, FIELD_WIDTH, LASER
from .state import HELD, Worlds


def action_masks(config: Config, worlds: Worlds) -> NDArray[np.bool_]:
    """Return which actions do something in each world, bool [n, actions]; no-op always does.

    Moving to a wall that the paddle touches does nothing, unless a gate is open there. Fire does
    nothing where no ball lies on the paddle or may stick to it, and no laser can shoot. Where one
    part of an action does nothing, the action is masked: the same without that part is not.

    Args:
        config: of the worlds.
        worlds: their states.

    Raises:
        ValueError: the actions are continuous.
    """
    table = COMMANDS.get(config.actions)
    if table is None:
        raise ValueError(
            f"actions={config.actions!r} are continuous and have no masks: use 'discrete6'"
        )
    x, half = worlds["paddle_x"], worlds["paddle_half"]
    left = x > half
    right = (x < FIELD_WIDTH - half) | (worlds["exit_open"] == 1)
    shoots = (worlds["power"] == LASER) & (worlds["beam_wait"] <= config.frame_skip)
    fire = (worlds["ball_state"] == HELD).any(axis=1) | (worlds["power"] == CATCH) | shoots
    masks = np.ones((len(worlds), len(table)), np.bool_)
    masks[:, table[:, 0] < 0.0] &= left[:, np.newaxis]
    masks[:, table[:, 0] > 0.0] &= right[:, np.newaxis]
    masks[:, table[:, 1] > 0.0] &= fire[:, np.newaxis]
    return masks
