"""What the single and the vector environment share: action space, metadata and checks."""

from difflib import get_close_matches
from typing import Any

import numpy as np
from gymnasium import spaces

from .actions import COMMANDS
from .config import Config
from .levels.starts import START_OPTIONS
from .rules import TICKS_PER_SECOND

RENDER_MODES = ("rgb_array", "human")
METADATA: dict[str, Any] = {
    "render_modes": list(RENDER_MODES),
    # At the default frame skip of 4; an instance has its own, see `instance_metadata`.
    "render_fps": TICKS_PER_SECOND // 4,
}


def action_space(config: Config) -> spaces.Space[Any]:
    """Return the space of one action."""
    if config.actions in COMMANDS:
        return spaces.Discrete(len(COMMANDS[config.actions]))
    # Whether Box is generic depends on Gymnasium's version.
    space: Any = spaces.Box(-1.0, 1.0, (2,), np.float32)
    return space  # type: ignore[no-any-return]


def instance_metadata(config: Config) -> dict[str, Any]:
    """Return an environment's metadata; frames per second follow from its frame skip."""
    return METADATA | {"render_fps": max(1, TICKS_PER_SECOND // config.frame_skip)}


def check_render_mode(render_mode: str | None, legal: tuple[str, ...]) -> None:
    """Raise a ValueError if a render mode is unknown."""
    if render_mode is not None and render_mode not in legal:
        raise ValueError(f"render_mode must be None or one of {legal}; got {render_mode!r}")


def check_options(options: dict[str, Any] | None) -> None:
    """Raise a ValueError if a reset option is unknown."""
    known = (*START_OPTIONS, "reset_mask")
    unknown = sorted(map(str, set(options or {}) - set(known)))
    if unknown:
        near = get_close_matches(unknown[0], known, 1)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"
        raise ValueError(f"unknown reset option {unknown[0]!r}; {hint}")
